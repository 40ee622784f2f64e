// SPDX-License-Identifier: Apache-2.0
// Unscattered light: transmittance that has a formula, as radiance, as alpha and as a layer.
#include "woodcock/proof/oracles/closed_forms.h"

#include <fmt/format.h>

#include <cmath>

#include "woodcock/proof/checks/measure.h"
#include "woodcock/proof/checks/slab_kinds.h"
#include "woodcock/proof/checks/subjects.h"
#include "woodcock/proof/oracles/quadrature.h"
#include "woodcock/proof/support/write_vdb.h"

namespace woodcock::proof {

namespace {

constexpr const char* evenLight = "[[light]]\ntype = \"environment\"\nradiance = [1, 2, 4]\n";
constexpr double lightColour[]{1, 2, 4};

struct Rays {
    Vec3d eye, direction;
};

/// The relative error of three optical depths, and its reason.
struct Slack {
    double relative = 0;
    std::string why{};
};

/// Pixels that look along one line through an absorbing or scattering medium of these optical
/// depths: light from behind it, alpha and the transmittance layer. Scattered light is left out.
/// Where little light comes through, few paths measure it; such cases are left out too, except for
/// `homogeneous` media, which have no noise.
void addTransmittance(Lab& lab, const std::string& name, const std::string& volume,
                      const Rays& rays, const double (&depth)[3], const Slack& slack = {},
                      bool homogeneous = false) {
    const Precision precision{lab.pick(1e-2, 2e-3), lab.pick(3e-4, 1e-5)};
    // The layers are random hits or misses, while radiance is weighted.
    const Precision rough{lab.pick(1e-2, 3e-3), lab.pick(4e-3, 1e-3)};
    const render::Scene scene =
        sceneIn(lab, volume + evenLight + pencilCamera(rays.eye, rays.direction));
    double t[3], alpha = 1;
    for (int c = 0; c < 3; ++c) t[c] = std::exp(-depth[c]), alpha -= t[c] / 3;
    const auto tells = [&](double value, const Precision& p) { return value > 4 * p.floor; };
    const image::Film film = evenFilm(
        lab, name, scene, {.maxScatterings = 0, .depthLayers = true},
        [&](const image::Film& pilot) {
            const RgbEstimate light = evenRadiance(pilot), layer = evenTransmittance(pilot);
            double worst = evenAlpha(pilot).error / rough.of(alpha);
            for (std::size_t c = 0; c < 3; ++c) {
                if (tells(t[c], precision))
                    worst = std::max(worst, light[c].error / (lightColour[c] * precision.of(t[c])));
                if (tells(t[c], rough)) worst = std::max(worst, layer[c].error / rough.of(t[c]));
            }
            return worst;
        });
    const auto add = [&](Case c, double off) {
        c.allowance += off;
        c.note = slack.why;
        lab.add(std::move(c));
    };
    const RgbEstimate light = evenRadiance(film), layer = evenTransmittance(film);
    double slackOfAlpha = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        constexpr double rounding = 1.2e-7, smallest = 1e-37;  // of depths as floats; of floats
        const double off = t[i] * (std::expm1(depth[i] * slack.relative) + depth[i] * rounding);
        slackOfAlpha += off / 3;
        if (tells(t[i], precision) || homogeneous) {
            Case c = caseOf(fmt::format("{}, channel {}", name, i), t[i],
                            {light[i].mean / lightColour[i], light[i].error / lightColour[i]},
                            precision);
            c.curve = "transmittance", c.xName = "optical depth", c.x = depth[i];
            add(c, off + smallest);
        }
        if (tells(t[i], rough) && (i == 0 || depth[i] != depth[0]))
            add(caseOf(fmt::format("layer, {}, channel {}", name, i), t[i], layer[i], rough), off);
    }
    add(caseOf("alpha, " + name, alpha, evenAlpha(film), rough), slackOfAlpha);
}

// ---- slabs ------------------------------------------------------------------------------------

Rays downAt(double mu) { return {{0, 50, 0}, {std::sqrt((1 - mu) * (1 + mu)), -mu, 0}}; }

void beerLambert(Lab& lab) {
    slab::write(lab);
    for (const char* shape : slab::kinds)
        for (const double depth : {0.1, 1.0, 5.0, 20.0})
            for (const double mu : {1.0, 0.5, 0.1}) {
                const std::string what =
                    fmt::format("{}, depth {}, mu {}", slab::nameOf(shape), depth, mu);
                const double along = depth / mu, grey[]{along, along, along},
                             tinted[]{along, along / 4, along / 20};
                const auto add = [&](const char* kind, const double(&depths)[3],
                                     const char* albedo) {
                    addTransmittance(
                        lab, fmt::format("{} {}", kind, what),
                        fmt::format("[[volume]]\n{}scale = [{}, {}, {}]\nalbedo = {}\n", shape,
                                    depths[0] * mu, depths[1] * mu, depths[2] * mu, albedo),
                        downAt(mu), depths, {}, shape == slab::box && *albedo == '0');
                };
                if (lab.full() || shape != slab::layered) add("absorbing", grey, "0");
                if (lab.full() || shape != slab::even) add("tinted", tinted, "0");
                if (along > lab.pick(2.0, 5.1)) continue;
                if (lab.full() || shape == slab::even) add("scattering", grey, "0.8");
                if (lab.full() || shape == slab::layered)
                    add("tinted scattering", tinted, "[0.2, 0.9, 1]");
            }
}

// ---- fields that vary -------------------------------------------------------------------------

/// Density falls by e every 16 voxels, seen from inside, upwards. The chords of an exponential lie
/// above it: voxels hold (h / 2H) coth(h / 2H) as much, h^2 / 12 H^2 more.
void atmosphere(Lab& lab) {
    constexpr int height = 256;
    constexpr double scaleHeight = 16;
    std::vector<double> weights;
    double sum = 0;
    for (int y = 0; y < height; ++y)
        weights.push_back(std::exp(-y / scaleHeight)), sum += weights.back();
    writeSlab(lab, "atmosphere.vdb", weights);
    for (const double altitude : {0.0, 16.0, 40.0})
        for (const double mu : {1.0, 0.3, 0.05}) {
            const double scale = 3;
            const double depth = oracle::exponentialAtmosphereOpticalDepth(
                scale / sum, scaleHeight, altitude, height - 1, mu);
            addTransmittance(
                lab, fmt::format("atmosphere from altitude {} up, mu {}", altitude, mu),
                fmt::format("[[volume]]\nfile = \"atmosphere.vdb\"\nscale = {}\nalbedo = 0\n",
                            scale),
                {{0, altitude, 0}, {std::sqrt(1 - mu * mu), mu, 0}}, {depth, depth, depth},
                {1 / (12 * scaleHeight * scaleHeight), "chords of the exponential"});
        }
}

/// Extinction that rises evenly over eight voxels from nothing, and falls within one: exact.
void ramp(Lab& lab) {
    writeSlab(lab, "ramp.vdb", {1, 2, 3, 4, 5, 6, 7, 8});
    const double scale = 2, slope = scale / 36;
    for (const double altitude : {0.25, 3.5, 6.75})
        for (const double mu : {1.0, 0.4})
            for (const bool up : {false, true}) {
                const double here = slope * (altitude + 1);
                const double depth =
                    up ? oracle::rampOpticalDepth(here, 8 * slope, (7 - altitude) / mu) +
                             oracle::rampOpticalDepth(8 * slope, 0, 1 / mu)
                       : oracle::rampOpticalDepth(here, 0, (altitude + 1) / mu);
                addTransmittance(
                    lab,
                    fmt::format("ramp from altitude {} {}, mu {}", altitude, up ? "up" : "down",
                                mu),
                    fmt::format("[[volume]]\nfile = \"ramp.vdb\"\nscale = {}\nalbedo = 0\n", scale),
                    {{0, altitude, 0}, {std::sqrt(1 - mu * mu), up ? mu : -mu, 0}},
                    {depth, depth, depth});
            }
}

/// Along rows of voxels the trapezoidal rule is exact to all digits. On other lines a linear
/// interpolation is off by at most h^2 / 8 of the second derivatives, which sum up to
/// (4 / s^2 + b^2 / s^4) / 8 of the depth at offset b, in voxels. The tail is cut at 5.5 s.
void gaussianBall(Lab& lab) {
    const int s = lab.pick(8, 20), reach = s * 11 / 2;
    GridSpec grid;
    grid.box = {{-reach, -reach, -reach}, {reach, reach, reach}};
    grid.value = [s](Vec3i p) {
        const Vec3d d = p.as<double>();
        return std::exp(-dot(d, d) / (2.0 * s * s));
    };
    writeVdb(lab.file("gauss.vdb"), {grid});
    const double scale = 1.5 / s;  // depth 3.76 through the centre
    const std::string volume =
        fmt::format("[[volume]]\nfile = \"gauss.vdb\"\nscale = {}\nalbedo = 0\n", scale);
    for (const double offset : {0.0, 0.5, 1.0, 2.0}) {
        const double b = offset * s, far = 10.0 * s;
        const double depth = oracle::gaussianBallOpticalDepth(scale, s, b);
        const double depths[]{depth, depth, depth};
        addTransmittance(lab, fmt::format("Gaussian ball along voxels, offset {} s", offset),
                         volume, {{b, 0, far}, {0, 0, -1}}, depths, {1e-6, "the tail"});
        const Vec3d direction = normalize(Vec3d{0.5, -0.3, 0.8});
        Vec3d side, other;
        orthonormalBasis(direction, side, other);
        addTransmittance(lab, fmt::format("Gaussian ball askew, offset {} s", offset), volume,
                         {side * b - direction * far, direction}, depths,
                         {(4 + offset * offset) / (8.0 * s * s), "linear interpolation"});
    }
}

/// Means over 1.5 voxels to either side with the weights of voxels that hold their part of a body:
/// the integral of f(x, y) over the density of the sum of three even numbers in [-1/2, 1/2].
template <class F>
double blurred(F&& f) {
    const oracle::Quadrature rule = oracle::gaussLegendre(8);
    double sum = 0;
    const auto weight = [](double x) {
        const double edge = 1.5 - std::abs(x);
        return std::abs(x) < 0.5 ? 0.75 - x * x : edge * edge / 2;
    };
    for (const double x0 : {-1.5, -0.5, 0.5})
        for (const double y0 : {-1.5, -0.5, 0.5})
            for (std::size_t i = 0; i < rule.nodes.size(); ++i)
                for (std::size_t j = 0; j < rule.nodes.size(); ++j) {
                    const double x = x0 + rule.nodes[i], y = y0 + rule.nodes[j];
                    sum += rule.weights[i] * rule.weights[j] * weight(x) * weight(y) * f(x, y);
                }
    return sum;
}

/// Voxels that hold the part of them inside the ball show it blurred, with all its mass: by
/// Jensen's inequality its shadow is darker, by as much as a quadrature of the blurred chords
/// tells.
void sphereDisc(Lab& lab) {
    const int radius = lab.pick(64, 160);
    constexpr int margin = 2, fine = 4;
    GridSpec grid;
    const int reach = radius + 1;
    grid.box = {{-reach, -reach, -reach}, {reach, reach, reach}};
    const double r2 = radius * radius;
    grid.value = [=](Vec3i p) {
        const Vec3d d = p.as<double>();
        const double distance = length(d);
        if (distance < radius - 1) return 1.0;
        if (distance > radius + 1) return 0.0;
        int inside = 0;
        for (int i = 0; i < fine * fine * fine; ++i) {
            const auto at = [&](int n) { return (n % fine + 0.5) / fine - 0.5; };
            const Vec3d q = d + Vec3d{at(i), at(i / fine), at(i / fine / fine)};
            inside += dot(q, q) < r2;
        }
        return inside / double{fine * fine * fine};
    };
    writeVdb(lab.file("ball.vdb"), {grid});
    const double half = radius + margin;
    for (const double depth : {0.5, 1.0, 2.0, 5.0}) {
        const double sigma = depth / radius;
        const auto shadow = [&](double b2) {
            return -std::expm1(-2 * sigma * std::sqrt(std::max(0.0, r2 - b2)));
        };
        // The effect of the blur on the light that the disc absorbs, per area of the disc.
        const oracle::Quadrature radial = oracle::gaussLegendre(16);
        double darker = 0;
        for (int ring = 0; ring < radius + margin; ++ring)
            for (std::size_t i = 0; i < radial.nodes.size(); ++i) {
                const double b = ring + radial.nodes[i];
                const double chord = blurred([&](double x, double y) {
                    return 2 * std::sqrt(std::max(0.0, r2 - (b + x) * (b + x) - y * y));
                });
                darker +=
                    radial.weights[i] * 2 * b / r2 * (-std::expm1(-sigma * chord) - shadow(b * b));
            }
        const std::string name =
            fmt::format("disc of an absorbing ball of optical radius {}", depth);
        const render::Scene scene =
            sceneIn(lab, fmt::format("[[volume]]\nfile = \"ball.vdb\"\nscale = {}\nalbedo = 0\n"
                                     "[[light]]\ntype = \"environment\"\nradiance = 1\n"
                                     "[camera]\ntype = \"orthographic\"\nheight = {}\n"
                                     "eye = [{}, {}, {}]\nlook_at = [0, 0, 0]\n",
                                     sigma, 2 * half, 0.3 * radius, 0.2 * radius, 3 * radius));
        const RgbEstimate square = meanOverSeeds(
            scene, {16, 16, lab.pick(depth < 5 ? 16 : 128, depth < 2 ? 256 : 1024), lab.seed(name)},
            lab.pick(32, 64));
        const double discs = 4 * half * half / (pi * r2);
        const Precision precision{lab.pick(1e-2, 1e-3), lab.pick(0.0, 5e-5)};
        Case c = caseOf(name, oracle::sphereDiscTransmittance(depth) - darker,
                        {1 - (1 - square[0].mean) * discs, square[0].error * discs}, precision);
        c.allowance += darker / 10;
        c.note = fmt::format("less {:.1e}, which {} voxels across take more, known to a tenth",
                             darker, 2 * radius);
        c.curve = "disc of an absorbing ball", c.xName = "optical radius", c.x = depth;
        lab.add(c);
    }
}

}  // namespace

std::vector<Check> closedForms() {
    return {{Kind::ClosedForm, "Beer and Lambert", beerLambert},
            {Kind::ClosedForm, "exponential atmosphere", atmosphere},
            {Kind::ClosedForm, "linear ramp", ramp},
            {Kind::ClosedForm, "Gaussian ball", gaussianBall},
            {Kind::ClosedForm, "absorbing sphere", sphereDisc}};
}

}  // namespace woodcock::proof
