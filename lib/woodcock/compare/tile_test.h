// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "woodcock/compare/picture.h"

namespace woodcock {

// Welch's test of means, tile by tile: is the mean of b - a over a tile further from zero than
// noise makes it?
//
// Where both images know the standard error of each pixel, that is the noise, with degrees of
// freedom by Welch and Satterthwaite. Where one does not, the scatter of b - a over the tile's
// pixels is taken for the noise of both: right where pixels are independent. A true difference that
// varies inside the tile then counts as noise too, which makes the test less sharp and never adds
// false alarms. Noise that neighbouring pixels share (wide pixel filters, denoisers) does.

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
    double allowance = 0;  ///< what the numbers do not resolve
    std::size_t pixels = 0;

    /// Chance of as much under equal expectations; 1 where there is nothing to compare.
    double chance() const;
};

/// Of one channel, for each tile.
std::vector<MeanDifference> tileDifferences(const Picture& a, const ComparedPlane& planeA,
                                            const Picture& b, const ComparedPlane& planeB,
                                            const Tiles& tiles, double factor = 1);

/// Of all pixels, from their tiles.
MeanDifference overall(const std::vector<MeanDifference>& tiles);

/// The same with standard errors at least as large as the mean noise of a tile and its eight
/// neighbours makes them. Rare bright samples raise a tile's mean and its noise together, so that a
/// tile which missed them looks dark and certain: its neighbours know better. Where noise is normal
/// and even, this changes little.
std::vector<MeanDifference> cautious(const std::vector<MeanDifference>& differences,
                                     const Tiles& tiles);

/// Which of these chances are too small to be chance: Holm's procedure with Sidak's bounds, so that
/// under equal expectations any is found with probability `rate` at most.
std::vector<bool> tooSmall(const std::vector<double>& chances, double rate);

}  // namespace woodcock
