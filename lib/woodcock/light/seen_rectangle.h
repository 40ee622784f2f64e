// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

namespace woodcock::light {

/// An axis-aligned rectangle in the plane z = 0, seen from the point (0, 0, height). Its points are
/// drawn uniformly in solid angle, or, where it is so small that directions into it would lose
/// digits, uniformly by area.
class SeenRectangle {
public:
    /// `height` > 0. Nothing is seen of a rectangle that is empty: x0 >= x1 or y0 >= y1.
    SeenRectangle(double x0, double x1, double y0, double y1, double height);

    bool empty() const { return !(x0_ < x1_ && y0_ < y1_); }
    double area() const { return (x1_ - x0_) * (y1_ - y0_); }
    std::array<double, 2> middle() const { return {(x0_ + x1_) / 2, (y0_ + y1_) / 2}; }
    double solidAngle() const { return solidAngle_; }  ///< 0 to 2 pi

    std::array<double, 2> sample(double u0, double u1) const;  ///< x, y; by u in [0, 1)^2
    /// Density of sample(), per steradian, at a point of the rectangle.
    double pdf(double x, double y) const;

private:
    double x0_, x1_, y0_, y1_, height_;
    double solidAngle_ = 0;
    double below_ = 0;  // 2 pi - the two angles at x0
};

}  // namespace woodcock::light
