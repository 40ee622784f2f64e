// SPDX-License-Identifier: Apache-2.0
#include "woodcock/medium/blackbody.h"

#include <vector>

#include "woodcock/base/vec.h"

namespace woodcock::medium {
namespace {

/// The CIE's colour matching functions of 1931, from 380 nm in steps of 10 nm.
constexpr double observer[][3]{
    {0.001368, 0.000039, 0.006450}, {0.004243, 0.000120, 0.020050}, {0.014310, 0.000396, 0.067850},
    {0.043510, 0.001210, 0.207400}, {0.134380, 0.004000, 0.645600}, {0.283900, 0.011600, 1.385600},
    {0.348280, 0.023000, 1.747060}, {0.336200, 0.038000, 1.772110}, {0.290800, 0.060000, 1.669200},
    {0.195360, 0.090980, 1.287640}, {0.095640, 0.139020, 0.812950}, {0.032010, 0.208020, 0.465180},
    {0.004900, 0.323000, 0.272000}, {0.009300, 0.503000, 0.158200}, {0.063270, 0.710000, 0.078250},
    {0.165500, 0.862000, 0.042160}, {0.290400, 0.954000, 0.020300}, {0.433450, 0.994950, 0.008750},
    {0.594500, 0.995000, 0.003900}, {0.762100, 0.952000, 0.002100}, {0.916300, 0.870000, 0.001650},
    {1.026300, 0.757000, 0.001100}, {1.062200, 0.631000, 0.000800}, {1.002600, 0.503000, 0.000340},
    {0.854450, 0.381000, 0.000190}, {0.642400, 0.265000, 0.000050}, {0.447900, 0.175000, 0.000020},
    {0.283500, 0.107000, 0.000000}, {0.164900, 0.061000, 0.000000}, {0.087400, 0.032000, 0.000000},
    {0.046770, 0.017000, 0.000000}, {0.022700, 0.008210, 0.000000}, {0.011359, 0.004102, 0.000000},
    {0.005790, 0.002091, 0.000000}, {0.002899, 0.001047, 0.000000}, {0.001440, 0.000520, 0.000000},
    {0.000690, 0.000249, 0.000000}, {0.000332, 0.000120, 0.000000}, {0.000166, 0.000060, 0.000000},
    {0.000083, 0.000030, 0.000000}, {0.000042, 0.000015, 0.000000}};

constexpr double coldest = 500;

/// The colour for `inverse` = 1 / T, in 1 / K.
Vec3d exactColour(double inverse) {
    constexpr double c2 = 1.438776877e-2;  // h c / k, in m K
    inverse = std::max(inverse, 1e-9);     // the limit of very high temperatures
    Vec3d xyz;
    double nm = 380;
    for (const auto& seen : observer) {
        const double planck = std::pow(nm / 560, -5) / std::expm1(c2 / (nm * 1e-9) * inverse);
        xyz += Vec3d{seen[0], seen[1], seen[2]} * planck;
        nm += 10;
    }
    xyz = xyz / xyz.y;
    return {3.2409699419 * xyz.x - 1.5373831776 * xyz.y - 0.4986107603 * xyz.z,
            -0.9692436363 * xyz.x + 1.8759675015 * xyz.y + 0.0415550574 * xyz.z,
            0.0556300797 * xyz.x - 0.2039769589 * xyz.y + 1.0569715142 * xyz.z};
}

}  // namespace

Rgb blackbodyColour(double kelvin) {
    // Even in 1 / T, in which the colour changes evenly: linear between entries to 1e-6.
    constexpr int steps = 2048;
    static const std::vector<Vec3d> table = [] {
        std::vector<Vec3d> colours;
        for (int i = 0; i <= steps; ++i) colours.push_back(exactColour(i / (steps * coldest)));
        return colours;
    }();
    const double at = steps * coldest / std::max(kelvin, coldest);
    const auto i = static_cast<std::size_t>(std::min(at, steps - 1.0));
    const Vec3d c = table[i] + (table[i + 1] - table[i]) * (at - static_cast<double>(i));
    return Rgb::map([&](int k) { return static_cast<float>(c[k]); });
}

Rgb blackbodyRadiance(double kelvin) {
    if (!(kelvin > 0)) return Rgb(0.0f);
    constexpr double stefanBoltzmann = 5.670374419e-8;  // W / (m^2 K^4)
    const double square = kelvin * kelvin;
    return blackbodyColour(kelvin) *
           static_cast<float>(1e-6 * stefanBoltzmann / pi * square * square);
}

grid::FieldSource blackbodySource(grid::FieldSource temperatures, double scale, double offset) {
    const auto radiance = [scale, offset, cold = temperatures.background[0]](float value) {
        return value == cold ? Rgb(0.0f) : blackbodyRadiance(scale * double{value} + offset);
    };
    grid::FieldSource glow;
    glow.channels = 3;
    glow.leafOrigins = std::move(temperatures.leafOrigins);
    glow.tiles = std::move(temperatures.tiles);
    for (grid::FieldTile& tile : glow.tiles) tile.value = radiance(tile.value[0]).c;
    glow.copyLeaf = [radiance, copy = std::move(temperatures.copyLeaf)](std::size_t i,
                                                                        std::span<float> values) {
        std::array<float, 512> kelvins;
        copy(i, kelvins);
        for (std::size_t v = 0; v < kelvins.size(); ++v) {
            const Rgb q = radiance(kelvins[v]);
            std::copy(q.c.begin(), q.c.end(), values.begin() + static_cast<std::ptrdiff_t>(3 * v));
        }
    };
    return glow;
}

}  // namespace woodcock::medium
