// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
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

/// All numbers of a DeepFilm, pixel by pixel.
struct DeepSums {
    struct Bin {
        double stopped = 0, radiance[3] = {};
    };
    struct Point {
        std::uint32_t owner;
        double depths = 0, hits = 0;
        double stopped = 0, caught = 0, radiance[3] = {};
        double depth() const { return depths / hits; }
    };
    std::vector<std::size_t> firstEdge;  ///< by pixel, and one more
    std::vector<float> edges;
    /// Bin i lies between edges i and i + 1; each pixel's last is unused, and so are those after
    /// the last edge, which make them as many for each pixel: DeepState relies on it.
    std::vector<Bin> bins;
    std::vector<std::vector<Point>> points;
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
    /// Throws Error{Failure} where so many `copies` of them do not fit into memory.
    DeepFilm(Film::Window crop, double error, const std::vector<std::vector<float>>& edges,
             int copies = 1);
    /// A film that was kept.
    DeepFilm(Film::Window crop, double error, DeepSums sums);
    /// The films of parts of a picture, each with the edges of the others: see mismatch().
    DeepFilm(Film::Window crop, std::span<const DeepFilm> parts);

    const Film::Window& crop() const { return crop_; }
    double error() const { return error_; }
    double meanBins() const;  ///< per pixel
    const DeepSums& sums() const { return sums_; }

    void add(int x, int y, const StoppedLight& ray);
    /// The first pixel of both crops where bins have other edges.
    std::optional<std::array<int, 2>> mismatch(const DeepFilm& other) const;
    /// Adds the sums of a film whose crop lies within this one's, with the same edges there. Points
    /// become one as hits do, so they may be others than if all hits had come one by one.
    void add(const DeepFilm& part);

    /// The pixel's samples in order, none over another. Over each other, front to back, they make
    /// the film's pixel without its background, and its alpha. `film` has the same samples.
    std::vector<DeepSample> samples(int x, int y, const Film& film) const;

private:
    using Bin = DeepSums::Bin;
    using Point = DeepSums::Point;
    struct Piece;
    static constexpr std::uint32_t strayMedium = StoppedLight::lamp - 1;

    static std::vector<DeepSample> composed(const std::vector<Piece>& pieces);
    std::size_t pixelOf(int x, int y) const;
    void makeBins();
    std::span<const float> edgesOf(std::size_t pixel) const;
    Bin* binAt(std::size_t pixel, double depth);
    Point& pointNear(std::size_t pixel, std::uint32_t owner, double depth);
    Point& pointAt(std::size_t pixel, std::uint32_t owner, double depth);
    void addStop(std::size_t pixel, const StoppedLight::Stop& stop);

    Film::Window crop_;
    double error_;
    DeepSums sums_;
};

}  // namespace woodcock::image
