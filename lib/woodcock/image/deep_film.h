// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "woodcock/image/film.h"
#include "woodcock/image/stopped_light.h"

namespace woodcock::image {

/// One sample of a deep pixel, as EXR has it: colour is multiplied by the sample's own alpha, and
/// within [near, far) light falls exponentially. near = far: a point.
struct DeepSample {
    float near, far;
    Rgb colour;
    float alpha;
};

/// For each pixel, the light that media stop between the edges of its bins, the light that arrives
/// from there, and both of surfaces by depth: sums over samples, in double, beside a Film, which
/// counts the samples. Depths are planar.
///
/// Surfaces become points. Hits on one surface whose depths agree within the relative `error` are
/// one point, at their mean depth. What lies in no bin becomes points too. A pixel holds at most
/// `mostPoints`; beyond that, the nearest points become one.
class DeepFilm {
public:
    static constexpr std::size_t mostPoints = 8;

    /// The edges of each pixel's bins, in order, row by row over the crop; none, or two and more.
    /// Throws Error{Failure} where they do not fit into memory.
    DeepFilm(Film::Window crop, double error, const std::vector<std::vector<float>>& edges);

    const Film::Window& crop() const { return crop_; }
    double error() const { return error_; }
    double meanBins() const;  ///< per pixel

    void add(int x, int y, const StoppedLight& ray);

    /// The pixel's samples in order, none over another. Over each other, front to back, they make
    /// the film's pixel without its background, and its alpha. `film` has the same samples.
    std::vector<DeepSample> samples(int x, int y, const Film& film) const;

private:
    struct Bin {
        double stopped = 0, radiance[3] = {};
    };
    struct Point {
        std::uint32_t owner;
        double depths = 0, hits = 0;
        double stopped = 0, caught = 0, radiance[3] = {};
        double depth() const { return depths / hits; }
    };
    struct Piece;
    static constexpr std::uint32_t strayMedium = StoppedLight::lamp - 1;

    static std::vector<DeepSample> composed(const std::vector<Piece>& pieces);
    std::size_t pixelOf(int x, int y) const;
    Bin* binAt(std::size_t pixel, double depth);
    Point& pointAt(std::size_t pixel, std::uint32_t owner, double depth);
    void addStop(std::size_t pixel, const StoppedLight::Stop& stop);

    Film::Window crop_;
    double error_;
    std::vector<std::size_t> firstEdge_;  // by pixel, and one more
    std::vector<float> edges_;
    std::vector<Bin> bins_;  // bin i lies between edges i and i + 1; each pixel's last is unused
    std::vector<std::vector<Point>> points_;
};

}  // namespace woodcock::image
