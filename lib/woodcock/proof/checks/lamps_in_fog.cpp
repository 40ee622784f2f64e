// SPDX-License-Identifier: Apache-2.0
// Fog that spots, rectangles and disks light: scattered once against quadrature, and any number of
// times against paths that meet the light by chance alone.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "woodcock/base/random.h"
#include "woodcock/light/light.h"
#include "woodcock/proof/checks/measure.h"
#include "woodcock/proof/checks/subjects.h"
#include "woodcock/proof/oracles/closed_forms.h"

namespace woodcock::proof {

namespace {

constexpr double sigmaA = 0.3, sigmaS = 0.7, sigmaT = sigmaA + sigmaS, half = 2;

/// Scattered once, in a box of fog of half width 2, into a view along -z: by quadrature along the
/// view and over what `shine` hands out, which are directions towards the light, distances within
/// the box, and radiance times solid angle.
double scatteredOnce(
    double g,
    const std::function<void(Vec3d at, const std::function<void(Vec3d direction, double distance,
                                                                double light)>& visit)>& shine,
    int steps) {
    double sum = 0;
    for (int i = 0; i < steps; ++i) {
        const double z = half * (2 * (i + 0.5) / steps - 1);
        shine({0, 0, z}, [&](Vec3d direction, double distance, double light) {
            sum += 2 * half / steps * sigmaS * oracle::henyeyGreenstein(-direction.z, g) * light *
                   std::exp(-sigmaT * (half - z + distance));
        });
    }
    return sum;
}

/// The box of fog and its view, without lights.
render::Scene fogBefore(const Lab& lab, double g) {
    return sceneIn(lab, fmt::format("[[volume]]\nbox = {{ min = [-2, -2, -2], max = [2, 2, 2] }}\n"
                                    "sigma_a = {}\nsigma_s = {}\ng = {}\n",
                                    sigmaA, sigmaS, g) +
                            pencilCamera({0, 0, 10}, {0, 0, -1}));
}

void inFog(Lab& lab) {
    const Precision precision = lab.full() ? Precision{2e-3, 4e-6} : Precision{1e-2, 0};
    for (const double g : {0.0, 0.8, -0.5}) {
        render::Scene scene = fogBefore(lab, g);
        const auto add = [&](const std::string& name, const light::Light& light, double expected) {
            scene.lights = light::LightSet({light});
            Case c = caseOf(name, expected, evenPicture(lab, name, scene, precision, {0}, 1)[0],
                            precision);
            c.allowance += 1e-3 * c.expected;
            c.note = "quadrature to 1e-3";
            lab.add(c);
        };

        const Vec3d lamp{1.2, 0.3, 0.9}, aim = normalize(Vec3d{-1, -0.2, -0.6});
        for (const double blend : {0.0, 0.5}) {
            const light::SpotLight spot(lamp, aim, Rgb(4), 40, blend);
            const double exact = scatteredOnce(
                g,
                [&](Vec3d at, const auto& visit) {
                    const Vec3d d = lamp - at;
                    const double distance = length(d), cosHalf = std::cos(20 * pi / 180);
                    const double inside = dot(d, aim) / -distance - cosHalf;
                    const double x = blend > 0
                                         ? std::clamp(inside / (blend * (1 - cosHalf)), 0.0, 1.0)
                                         : double(inside > 0);
                    visit(d / distance, distance, 4 * x * x * (3 - 2 * x) / (distance * distance));
                },
                20000);
            add(fmt::format("spot in fog, blend {}, g {}", blend, g), spot, exact);
        }

        for (const bool disk : {false, true})
            for (const double spread : {180.0, 90.0}) {
                light::FlatLight flat{};
                flat.centre = {1.2, 0.3, 0.5}, flat.normal = aim, flat.radiance = Rgb(3);
                flat.halfX = 0.6, flat.halfY = disk ? 0.6 : 0.4, flat.visible = false;
                orthonormalBasis(flat.normal, flat.x, flat.y);
                flat.spread = light::Spread(spread);
                const double a = spread * pi / 360;
                constexpr int side = 40;
                const double exact = scatteredOnce(
                    g,
                    [&](Vec3d at, const auto& visit) {
                        for (int i = 0; i < side * side; ++i) {
                            const double u = (i / side + 0.5) / side, v = (i % side + 0.5) / side;
                            const double r = std::sqrt(u), phi = 2 * pi * v;
                            const double x = flat.halfX * (disk ? r * std::cos(phi) : 2 * u - 1);
                            const double y = flat.halfY * (disk ? r * std::sin(phi) : 2 * v - 1);
                            const Vec3d d = flat.centre + flat.x * x + flat.y * y - at;
                            const double distance = length(d), cosine = -dot(d, aim) / distance;
                            if (!(cosine > 0)) continue;
                            const double area = (disk ? pi : 4) * flat.halfX * flat.halfY;
                            const double tangent = std::sqrt(1 - cosine * cosine) / cosine;
                            const double factor =
                                spread == 180
                                    ? 1
                                    : std::max(0.0, std::tan(a) - tangent) / (std::tan(a) - a);
                            visit(
                                d / distance, distance,
                                3 * factor * cosine * area / (side * side) / (distance * distance));
                        }
                    },
                    400);
                add(fmt::format("{} in fog, spread {}, g {}", disk ? "disk" : "rectangle", spread,
                                g),
                    disk ? light::Light(light::DiskLight{flat}) : light::RectangleLight{flat},
                    exact);
            }
    }
}

/// Where a ray leaves the box of fog.
double wayOut(Vec3d from, Vec3d direction) {
    double t = std::numeric_limits<double>::infinity();
    for (int axis = 0; axis < 3; ++axis)
        if (direction[axis] != 0)
            t = std::min(t, (std::copysign(half, direction[axis]) - from[axis]) / direction[axis]);
    return t;
}

/// The front of a rectangle on a ray; infinity where the ray misses it.
double meetRectangle(const light::FlatLight& flat, Vec3d from, Vec3d direction) {
    const double height = dot(from - flat.centre, flat.normal), fall = -dot(direction, flat.normal);
    const Vec3d p = from + direction * (height / fall) - flat.centre;
    const bool met = height > 0 && fall > 0 && std::abs(dot(p, flat.x)) <= flat.halfX &&
                     std::abs(dot(p, flat.y)) <= flat.halfY;
    return met ? height / fall : std::numeric_limits<double>::infinity();
}

/// The same view's radiance, scattered any number of times, by the plainest of path tracers:
/// flights end by chance, and a path has the light's radiance where it happens to meet the light.
Moments metByChance(RandomStream& random, const light::FlatLight& flat, double g, int paths) {
    Moments radiance;
    for (int i = 0; i < paths; ++i) {
        Vec3d at{0, 0, half}, direction{0, 0, -1};
        double weight = 1, sum = 0;
        for (bool scattered = false;; scattered = true) {
            const double flight = -std::log1p(-random.uniform()) / sigmaT;
            const double out = wayOut(at, direction);
            if (scattered && meetRectangle(flat, at, direction) < std::min(flight, out))
                sum += weight * flat.radiance[0];
            if (flight >= out) break;
            at = at + direction * flight;
            weight *= sigmaS / sigmaT;
            const double u = random.uniform(), phi = 2 * pi * random.uniform();
            const double q = (1 - g * g) / (1 - g + 2 * g * u);
            const double cosine = g == 0 ? 1 - 2 * u : (1 + g * g - q * q) / (2 * g);
            const double sine = std::sqrt(std::max(0.0, 1 - cosine * cosine));
            Vec3d x, y;
            orthonormalBasis(direction, x, y);
            direction =
                normalize(direction * cosine + (x * std::cos(phi) + y * std::sin(phi)) * sine);
        }
        radiance.add(sum);
    }
    return radiance;
}

void scatteredOften(Lab& lab) {
    const Precision precision = lab.full() ? Precision{2e-3, 0} : Precision{1e-2, 0};
    light::FlatLight flat{};
    flat.centre = {0.7, 0.3, 0.5}, flat.normal = normalize(Vec3d{-1, -0.2, -0.6});
    flat.halfX = 0.9, flat.halfY = 0.5, flat.radiance = Rgb(3), flat.visible = false;
    orthonormalBasis(flat.normal, flat.x, flat.y);
    for (const double g : {0.0, 0.7, -0.5}) {
        const std::string name = fmt::format("rectangle in fog, scattered often, g {}", g);
        render::Scene scene = fogBefore(lab, g);
        scene.lights = light::LightSet({light::RectangleLight{flat}});
        RandomStream random(lab.seed(name));
        const Moments exact = metByChance(random, flat, g, lab.pick(500000, 40000000));
        Case c =
            caseOf(name, exact.mean(), evenPicture(lab, name, scene, precision, {0})[0], precision);
        c.standardError = std::hypot(c.standardError, exact.standardError());
        c.largestError = std::hypot(c.largestError, (lab.full() ? 3e-3 : 2e-2) * exact.mean());
        c.note = "the noise of the paths that meet the light by chance is in the error";
        lab.add(c);
    }
}

}  // namespace

std::vector<Check> lampsInFog() {
    return {{Kind::ClosedForm, "lamps in fog", inFog},
            {Kind::ClosedForm, "lamps in fog, scattered often", scatteredOften}};
}

}  // namespace woodcock::proof
