// SPDX-License-Identifier: Apache-2.0
// Points that do not shine everywhere alike: spots, and points with photometric profiles.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "woodcock/light/light.h"
#include "woodcock/proof/checks/cells.h"
#include "woodcock/proof/checks/subjects.h"
#include "woodcock/proof/support/sky.h"
#include "woodcock/proof/support/statistics.h"

namespace woodcock::proof {

namespace {

// ---- spots ------------------------------------------------------------------------------------

const Vec3d axis = normalize(Vec3d{0.3, 0.8, -0.4});

void spots(Lab& lab) {
    const Vec3d position{1, 2, 3};
    for (const double cone : {180.0, 90.0, 30.0, 1.0, 1e-3})
        for (const double blend : {0.0, 0.15, 1.0}) {
            const light::SpotLight light(position, axis * 3.0, Rgb(5.0f), cone, blend);
            const std::string name = fmt::format("spot of {} degrees, blend {}", cone, blend);
            const double half = 2 * std::pow(std::sin(cone * pi / 720), 2);  // 1 - cos
            const auto intensity = [&](double below, double turned, double distance) {
                const Vec3d from = position + around(axis, below, turned) * distance;
                return light.sample(from, 0.3, 0.7).weight[0] * distance * distance;
            };
            double worst = 0;
            for (int i = 0; i < 1000; ++i) {
                const double below = std::min(2.0, half * 1.5) * (i + 0.5) / 1000;
                const double x = blend > 0 ? std::clamp((half - below) / (half * blend), 0.0, 1.0)
                                           : double(below < half);
                const double expected = 5 * (3 * x * x - 2 * x * x * x);
                worst = std::max(worst, std::abs(intensity(below, 2.4 * i, 0.1 + i) - expected));
            }
            lab.add(exactCase("largest difference of intensity and smoothstep, " + name, 0, worst,
                              cone < 0.1 ? 1e-4 : 2e-6, "positions are rounded"));
            // The cone's integral, in two pieces: smoothstep between 0 and 1 has the mean 1/2.
            const double edge = half * (1 - blend);
            const double power =
                2 * pi *
                (integrate(0, edge, 32, [&](double b) { return intensity(b, 1, 2); }) +
                 integrate(edge, half, 32, [&](double b) { return intensity(b, 1, 2); }));
            lab.add(exactCase("power over its closed form, " + name, 1,
                              power / (5 * 2 * pi * half * (1 - blend / 2)),
                              cone < 0.1 ? 1e-4 : 2e-6, "positions are rounded"));
        }
}

// ---- photometric profiles ---------------------------------------------------------------------

struct Luminaire {
    const char* name;
    std::vector<double> vertical, horizontal;
};
const std::vector<Luminaire> luminaires{
    {"all around", {0, 30, 60, 90, 135, 180}, {0}},
    {"of four quadrants", {0, 20, 45, 90}, {0, 30, 45, 90}},
    {"of two halves", {0, 10, 45, 90, 180}, {0, 45, 90, 135, 180}},
    {"of two other halves", {0, 45, 90, 180}, {90, 150, 180, 270}},
    {"of two halves without a plane between", {0, 45, 90, 180}, {90, 150, 270}},
    {"without symmetry", {90, 120, 150, 180}, {0, 60, 90, 180, 270, 360}},
    {"that leaves out 360", {0, 45, 90}, {0, 90, 180, 270}}};

double candelaOf(std::size_t h, std::size_t v, std::size_t horizontals) {
    const std::size_t plane = horizontals == 6 && h == 5 ? 0 : h;  // 360 is 0
    return 100 + 70 * std::cos(3.0 * static_cast<double>(v) + 1.7 * static_cast<double>(plane));
}

std::string textOf(const Luminaire& l) {
    std::string text = "IESNA:LM-63-2002\r\n[TEST] made up\r\nTILT=NONE\r\n";
    text += fmt::format("1 1000 2 {} {} 1 2 0 0 0\r\n0.5 1.5 100\r\n", l.vertical.size(),
                        l.horizontal.size());
    for (double v : l.vertical) text += fmt::format("{} ", v);
    text += "\r\n";
    for (double h : l.horizontal) text += fmt::format("{},", h);
    for (std::size_t h = 0; h < l.horizontal.size(); ++h) {
        text += "\r\n";
        for (std::size_t v = 0; v < l.vertical.size(); ++v)
            text += fmt::format("{:.17g}\r\n", candelaOf(h, v, l.horizontal.size()));
    }
    return text;
}

/// The file's candela, as its symmetry says, linear between angles; `h` in [0, 360).
double candelaTowards(const Luminaire& l, double v, double h) {
    const double last = l.horizontal.back();
    if (l.horizontal.size() == 1)
        h = 0;
    else if (last == 90)
        h = h > 180 ? 360 - h : h, h = h > 90 ? 180 - h : h;
    else if (last == 180)
        h = h > 180 ? 360 - h : h;
    else if (l.horizontal.front() == 90)
        h = h < 90 ? 180 - h : h > 270 ? 540 - h : h;
    std::size_t i = 0, j = 0;
    while (i + 2 < l.horizontal.size() && h > l.horizontal[i + 1]) ++i;
    while (j + 2 < l.vertical.size() && v > l.vertical[j + 1]) ++j;
    if (v < l.vertical.front() || v > l.vertical.back()) return 0;
    std::size_t next = i + 1;
    double width = l.horizontal.size() > 1 ? l.horizontal[next] - l.horizontal[i] : 1;
    if (l.horizontal.size() == 1) next = 0;
    if (last == 270 && l.horizontal.front() == 0 && h > 270) i = 3, next = 0, width = 90;
    const double fh = (h - l.horizontal[i]) / width;
    const double fv = (v - l.vertical[j]) / (l.vertical[j + 1] - l.vertical[j]);
    const auto at = [&](std::size_t a, std::size_t b) {
        return candelaOf(a, b, l.horizontal.size());
    };
    return (at(i, j) * (1 - fv) + at(i, j + 1) * fv) * (1 - fh) +
           (at(next, j) * (1 - fv) + at(next, j + 1) * fv) * fh;
}

void profiles(Lab& lab) {
    const Affine3d worldFromLight =
        Affine3d::rotate(0, 30) * Affine3d::rotate(1, 40) * Affine3d::rotate(2, 50);
    for (const Luminaire& l : luminaires) {
        const auto profile = std::make_shared<const light::IesProfile>(
            light::IesProfile::read(textOf(l), "made.ies"));
        const light::PointLight light{
            {1, 2, 3}, Rgb(static_cast<float>(1 / (4 * pi))), profile, worldFromLight.inverse()};
        double worst = 0, sum = 0, solidAngle = 0;
        constexpr int rows = 360, columns = 720;
        for (int i = 0; i < rows; ++i)
            for (int j = 0; j < columns; ++j) {
                const double v = 180 * (i + 0.5) / rows, h = 360 * (j + 0.5) / columns;
                const double sine = std::sin(v * pi / 180), turned = h * pi / 180;
                // 0 is -z and -y, 90 of the horizontal angles -x
                const Vec3d local{-sine * std::sin(turned), -sine * std::cos(turned),
                                  -std::cos(v * pi / 180)};
                const Vec3d from = light.position + worldFromLight.vector(local) * 2.0;
                const double watts = light.sample(from, 0, 0).weight[0] * 4;
                const double candela = 1.5 * candelaTowards(l, v, h);  // multiplier x ballasts
                worst = std::max(worst, std::abs(watts * 177.83 / candela - 1) * (candela > 0));
                worst = std::max(worst, watts * (candela == 0));
                sum += watts * sine, solidAngle += sine;
            }
        lab.add(
            exactCase(fmt::format("largest difference of intensity and file, luminaire {}", l.name),
                      0, worst, 1e-5, "floats"));
        lab.add(exactCase(fmt::format("mean over that by quadrature, luminaire {}", l.name), 1,
                          profile->mean() / (4 * pi) / (sum / solidAngle), 1e-3,
                          "quadrature in steps of half a degree"));
    }
}

}  // namespace

std::vector<Check> aimedPoints() {
    return {{Kind::Sampling, "spots", spots}, {Kind::Sampling, "photometric profiles", profiles}};
}

}  // namespace woodcock::proof
