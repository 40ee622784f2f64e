// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "woodcock/compare/picture.h"

namespace woodcock::compare {

// Welch's test of means, tile by tile: is the mean of b - a over a tile further from zero than
// noise explains?
//
// Where both images know the standard error of each pixel, that is the noise, with degrees of
// freedom by Welch and Satterthwaite. Where one does not, the scatter of b - a over the tile's
// pixels is taken for the noise of both: right where pixels are independent. A true difference that
// varies inside the tile then counts as noise too. That makes the test less sensitive, but does not
// add false alarms. Noise that neighbouring pixels share (wide pixel filters, denoisers) adds false
// alarms.

/// The tiles' grid: at least `side` pixels wide and high each, or the whole image.
class Tiles {
public:
    Tiles(int width, int height, int side);
    struct Tile {
        int x0, y0, x1, y1;
    };
    int columns() const { return columns_; }
    int rows() const { return rows_; }
    std::size_t count() const { return static_cast<std::size_t>(columns_ * rows_); }
    Tile tile(std::size_t index) const;

private:
    int width_, height_, columns_, rows_;
};

/// Mean of b - factor * a over some pixels that are finite in both.
struct MeanDifference {
    double value = 0;
    double error = 0;      ///< standard error
    double degrees = 0;    ///< of freedom, of that error
    double allowance = 0;  ///< the resolution of the numbers
    std::size_t pixels = 0;

    /// Probability of such a difference under equal expectations; 1 where there is nothing to
    /// compare.
    double chance() const;
};

/// The differences of one channel, for each tile.
std::vector<MeanDifference> tileDifferences(const Picture& a, const ComparedPlane& planeA,
                                            const Picture& b, const ComparedPlane& planeB,
                                            const Tiles& tiles, double factor = 1);

/// The difference over all pixels, from their tiles.
MeanDifference overall(const std::vector<MeanDifference>& tiles);

/// The same differences, with standard errors at least as large as by the mean noise of a tile and
/// its eight neighbours. Rare bright samples raise a tile's mean and its noise together, so a tile
/// that missed them is dark and seems certain. Where noise is normal and uniform, this changes
/// little.
std::vector<MeanDifference> cautious(const std::vector<MeanDifference>& differences,
                                     const Tiles& tiles);

/// Which of these probabilities are significant, by Holm's procedure with Sidak's bounds: under
/// equal expectations, any is found with probability `rate` at most.
std::vector<bool> tooSmall(const std::vector<double>& chances, double rate);

}  // namespace woodcock::compare
