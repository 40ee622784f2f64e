// SPDX-License-Identifier: Apache-2.0
#include "woodcock/light/sky_model.h"

#include <algorithm>
#include <cmath>

#include "woodcock/base/error.h"
#include "woodcock/light/hosek_wilkie_table.h"

namespace woodcock::light {
namespace {

namespace table = hosek_wilkie;

/// A turbidity between two of the table.
struct Haze {
    explicit Haze(double turbidity)
        : index(std::min(static_cast<std::size_t>(turbidity) - 1, std::size_t{8})),
          share(turbidity - 1 - static_cast<double>(index)) {}

    std::size_t index;
    double share;  ///< of the next
};

/// The part of the way from the horizon to the zenith in which the tables are even.
double heightOf(double elevation) { return std::cbrt(elevation / 90); }

/// Bernstein's polynomials of degree 5.
std::array<double, 6> bernstein(double t) {
    std::array<double, 6> weights;
    constexpr std::array<double, 6> choose{1, 5, 10, 10, 5, 1};
    for (std::size_t k = 0; k < 6; ++k)
        weights[k] = choose[k] * std::pow(t, static_cast<double>(k)) *
                     std::pow(1 - t, static_cast<double>(5 - k));
    return weights;
}

/// Hosek and Wilkie 2012, section 4.3: quintic in the cube root of the sun's elevation, linear in
/// the turbidity and in the ground's albedo. value(albedo, turbidity, control point).
template <class Value>
double interpolate(const Haze& haze, double albedo, const std::array<double, 6>& weights,
                   Value value) {
    double sum = 0;
    for (std::size_t k = 0; k < weights.size(); ++k) {
        const auto at = [&](std::size_t a) {
            return (1 - haze.share) * double{value(a, haze.index, k)} +
                   haze.share * double{value(a, haze.index + 1, k)};
        };
        sum += weights[k] * ((1 - albedo) * at(0) + albedo * at(1));
    }
    return sum;
}

/// Catmull and Rom's cubic through the table's knots; quadratic before the first and after the
/// last.
double sunIrradiance(std::size_t turbidity, double height, std::size_t channel) {
    constexpr int last = table::sunKnots - 1;
    const double at = height * last;
    const int i = std::min(static_cast<int>(at), last - 1);
    const auto known = [&](int k) {
        return double{table::sunIrradiance[turbidity][static_cast<std::size_t>(k)][channel]};
    };
    const auto knot = [&](int k) {
        if (k < 0) return 3 * known(0) - 3 * known(1) + known(2);
        if (k > last) return 3 * known(last) - 3 * known(last - 1) + known(last - 2);
        return known(k);
    };
    const double f = at - i, a = knot(i - 1), b = knot(i), c = knot(i + 1), d = knot(i + 2);
    const double cubic = 3 * (b - c) + d - a, square = 2 * a - 5 * b + 4 * c - d;
    return std::max(0.0, b + f * (c - a + f * (square + f * cubic)) / 2);
}

void check(const SkyModel::Conditions& c) {
    if (!(c.sunElevation >= 0 && c.sunElevation <= 90))
        throw usageError("the sun's elevation is {} degrees; the sky model holds from 0 to 90",
                         c.sunElevation);
    if (!(c.turbidity >= SkyModel::lowestTurbidity && c.turbidity <= SkyModel::highestTurbidity))
        throw usageError("the turbidity is {}; the sky model holds from {} to {}", c.turbidity,
                         SkyModel::lowestTurbidity, SkyModel::highestTurbidity);
    if (!(c.groundAlbedo.minimum() >= 0 && c.groundAlbedo.maximum() <= 1 &&
          c.groundAlbedo.isFinite()))
        throw usageError("the ground's albedo is [{}, {}, {}]; it must lie between 0 and 1",
                         c.groundAlbedo[0], c.groundAlbedo[1], c.groundAlbedo[2]);
}

/// By midpoints, even in the angles.
Rgb levelIrradiance(const SkyModel& sky) {
    constexpr int rings = 128, sectors = 128;  // of a half: the sky is symmetric
    std::array<double, 3> sum{};
    for (int i = 0; i < rings; ++i) {
        const double zenith = pi / 2 * (i + 0.5) / rings;
        const double sine = std::sin(zenith), cosine = std::cos(zenith);
        for (int j = 0; j < sectors; ++j) {
            const double phi = pi * (j + 0.5) / sectors;
            const Rgb l = sky.radiance({sine * std::sin(phi), cosine, -sine * std::cos(phi)});
            for (int c = 0; c < 3; ++c)
                sum[static_cast<std::size_t>(c)] += sine * cosine * double{l[c]};
        }
    }
    constexpr double cell = pi / 2 / rings * 2 * pi / sectors;
    return Rgb::map(
        [&](int c) { return static_cast<float>(cell * sum[static_cast<std::size_t>(c)]); });
}

}  // namespace

SkyModel::SkyModel(const Conditions& conditions) {
    check(conditions);
    const double elevation = conditions.sunElevation * pi / 180;
    towardsSun_ = {0, std::sin(elevation), -std::cos(elevation)};
    const Haze haze(conditions.turbidity);
    const double height = heightOf(conditions.sunElevation);
    const auto weights = bernstein(height);
    for (std::size_t c = 0; c < 3; ++c) {
        const double albedo = double{conditions.groundAlbedo[static_cast<int>(c)]};
        const auto parameter = [&](std::size_t i) {
            return interpolate(haze, albedo, weights,
                               [&](std::size_t a, std::size_t t, std::size_t k) {
                                   return table::parameters[c][a][t][k][i];
                               });
        };
        channels_[c] = {
            parameter(0),
            parameter(1),
            parameter(2),
            parameter(3),
            parameter(4),
            parameter(5),
            parameter(6),
            parameter(7),
            parameter(8),
            interpolate(haze, albedo, weights, [&](std::size_t a, std::size_t t, std::size_t k) {
                return table::radiances[c][a][t][k];
            })};
        sunIrradiance_[static_cast<int>(c)] =
            static_cast<float>((1 - haze.share) * light::sunIrradiance(haze.index, height, c) +
                               haze.share * light::sunIrradiance(haze.index + 1, height, c));
    }
    skyIrradiance_ = levelIrradiance(*this);
}

// Hosek and Wilkie 2012, eq. 8, with eq. 9 as `glow`.
Rgb SkyModel::radiance(Vec3d direction) const {
    const double cosZenith = direction.y;
    if (cosZenith < 0) return {};
    const double cosSun = std::clamp(dot(direction, towardsSun_), -1.0, 1.0);
    const double angle = std::acos(cosSun), square = cosSun * cosSun, root = std::sqrt(cosZenith);
    return Rgb::map([&](int i) {
        const Channel& c = channels_[static_cast<std::size_t>(i)];
        const double distance = 1 + c.H * c.H - 2 * c.H * cosSun;
        const double glow = (1 + square) / (distance * std::sqrt(distance));
        const double l =
            (1 + c.A * std::exp(c.B / (cosZenith + 0.01))) *
            (c.C + c.D * std::exp(c.E * angle) + c.F * square + c.G * glow + c.I * root);
        return static_cast<float>(std::max(0.0, c.scale * l));
    });
}

std::vector<float> skyImage(const SkyModel& sky, Rgb ground, int width) {
    const int height = width / 2;
    std::vector<float> pixels;
    pixels.reserve(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * 3);
    for (int y = 0; y < height; ++y) {
        const double theta = pi * (y + 0.5) / height;
        for (int x = 0; x < width; ++x) {
            const double phi = 2 * pi * ((x + 0.5) / width - 0.5);
            const Rgb l = 2 * y < height
                              ? sky.radiance({std::sin(theta) * std::sin(phi), std::cos(theta),
                                              -std::sin(theta) * std::cos(phi)})
                              : ground;
            pixels.insert(pixels.end(), l.c.begin(), l.c.end());
        }
    }
    return pixels;
}

Rgb groundRadiance(const SkyModel& sky, Rgb albedo, double sun) {
    const auto level = static_cast<float>(sun * sky.towardsSun().y);
    return albedo * (sky.skyIrradiance() + sky.sunIrradiance() * level) *
           static_cast<float>(1 / pi);
}

}  // namespace woodcock::light
