// SPDX-License-Identifier: Apache-2.0
#include "woodcock/light/seen_rectangle.h"

#include <algorithm>
#include <cmath>

#include "woodcock/base/vec.h"

namespace woodcock::light {

namespace {

/// The solid angle is a difference of angles: a smaller one is left to sampling by area.
constexpr double smallestAngle = 1e-5;

}  // namespace

// Urena, Fajardo and King 2013, "An Area-Preserving Parametrization for Spherical Rectangles", sec.
// 3. The angle of the spherical quadrilateral at a corner (x, y) is acos of a product of two
// cosines; as atan2 it keeps its digits where the angle comes close to 0 or pi.
SeenRectangle::SeenRectangle(double x0, double x1, double y0, double y1, double height)
    : x0_(x0), x1_(x1), y0_(y0), y1_(y1), height_(height) {
    if (empty()) return;
    const auto corner = [&](double x, double y, double sign) {
        return std::atan2(height * std::sqrt(x * x + y * y + height * height), sign * x * y);
    };
    below_ = 2 * pi - corner(x0, y0, -1) - corner(x0, y1, 1);
    solidAngle_ = std::max(0.0, corner(x1, y0, 1) + corner(x1, y1, -1) - below_);
}

std::array<double, 2> SeenRectangle::sample(double u0, double u1) const {
    if (solidAngle_ < smallestAngle) return {x0_ + u0 * (x1_ - x0_), y0_ + u1 * (y1_ - y0_)};
    // Sec. 4: first the x at which the plane through the y axis cuts off u0 of the solid angle,
    const double b0 = -y0_ / std::hypot(height_, y0_), b1 = y1_ / std::hypot(height_, y1_);
    const double angle = u0 * solidAngle_ + below_;
    const double f = (std::cos(angle) * b0 - b1) / std::sin(angle);
    const double c = std::clamp(std::copysign(1.0, f) / std::hypot(f, b0), -1.0, 1.0);
    const double x =
        std::clamp(c * height_ / std::sqrt(std::max(0.0, (1 - c) * (1 + c))), x0_, x1_);
    // then the place on the arc there.
    const double d = std::hypot(x, height_);
    const double h0 = y0_ / std::hypot(d, y0_), h1 = y1_ / std::hypot(d, y1_);
    const double h = h0 + u1 * (h1 - h0), rest = (1 - h) * (1 + h);
    const double y = rest > 0 ? h * d / std::sqrt(rest) : h > 0 ? y1_ : y0_;
    return {x, std::clamp(y, y0_, y1_)};
}

double SeenRectangle::pdf(double x, double y) const {
    if (empty()) return 0;
    if (solidAngle_ >= smallestAngle) return 1 / solidAngle_;
    const double distance = std::sqrt(x * x + y * y + height_ * height_);
    return distance * distance * distance / (area() * height_);  // distance^2 / (area cosine)
}

}  // namespace woodcock::light
