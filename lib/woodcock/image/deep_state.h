// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "woodcock/image/deep_film.h"
#include "woodcock/image/film_state.h"

namespace woodcock::image {

/// The sums of a DeepFilm as planes for files. Pixels have as many bins and points as they need. So
/// those of all pixels are lists, one pixel's after the other's, and every pixel of a plane holds
/// an equal share of a list, whosever it is. Zeros fill up the last shares.
class DeepState {
public:
    /// Of a film that has to stay: its bins are not copied.
    explicit DeepState(const DeepFilm& film);
    /// For the numbers that a file tells of. Throws Error{Input} where memory cannot hold them.
    explicit DeepState(const StateFile& file);

    StateFacts facts() const;
    std::vector<Film::ConstPlane> planes() const;
    /// To be filled from the file; then film() is what was kept. Throws Error{Input} where the
    /// numbers are of no film.
    std::vector<Film::Plane> planes();
    DeepFilm film(const StateFile& file);

    static bool isIn(const StateFile& file);

private:
    struct Point {
        double owner = 0, depths = 0, hits = 0, stopped = 0, caught = 0, radiance[3] = {};
    };
    template <typename Plane, typename Self, typename Bin>
    static std::vector<Plane> planesOf(Self& state, Bin* bins);
    std::size_t pixels() const { return edgeCounts_.size(); }

    Film::Window crop_;
    double error_;
    std::size_t edgeShare_ = 0, pointShare_ = 0;           // of each pixel
    std::vector<std::uint64_t> edgeCounts_, pointCounts_;  // by pixel
    std::vector<double> edges_;
    std::vector<Point> points_;
    std::vector<DeepSums::Bin> bins_;  // of a file
    const DeepSums::Bin* binsOfFilm_ = nullptr;
};

}  // namespace woodcock::image
