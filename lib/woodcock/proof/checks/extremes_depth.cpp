// SPDX-License-Identifier: Apache-2.0
// Optical depths, albedos, coefficients and lengths of any size.
#include <fmt/format.h>

#include <cmath>

#include "woodcock/medium/optical_depth.h"
#include "woodcock/proof/checks/extremes.h"
#include "woodcock/proof/oracles/adding_doubling.h"
#include "woodcock/proof/oracles/chandrasekhar.h"
#include "woodcock/proof/support/write_vdb.h"

namespace woodcock::proof {

namespace {

constexpr double depths[]{0, 1e-10, 1, 88, 104, 1e4, 1e8};
constexpr double smallestFloat = 1.5e-45;

/// A box of height 1, and a tile of 4096 voxels between ramps of one voxel each.
void transmittance(Lab& lab) {
    writeVdb(lab.file("tile.vdb"),
             {GridSpec{.tiles = {{{0, 0, 0}, 4096, {1}}},
                       .worldFromIndex = Affine3d::scale({1.0 / 4096, 1.0 / 4096, 1.0 / 4096})}});
    const Precision usual = extremePrecision(lab);
    const auto camera = pencilCamera({0.4, 3, 0.3}, {0, -1, 0});
    for (const double depth : depths)
        for (const bool tile : {false, true}) {
            const Precision precision{usual.relative, depth == 88 ? 0 : usual.floor};
            const std::string name =
                fmt::format("of a {} of depth {:g}", tile ? "tile" : "box", depth);
            const std::string volume =
                (tile ? std::string("[[volume]]\nfile = \"tile.vdb\"\n")
                      : "[[volume]]\nbox = { min = [-1, -1, -1], max = [1, 0, 1] }\n") +
                fmt::format("sigma_a = {}\nsigma_s = 0\n", digits(depth));
            const render::Scene scene = sceneIn(lab, volume + evenLight + camera);
            Case c = caseOf("transmittance " + name, std::exp(-depth),
                            watch(lab, name, scene, precision)[0], precision);
            // A float's exponent of 88 is known to 88 x 2^-24.
            c.allowance = (2e-6 + 6e-8 * depth) * c.expected + smallestFloat;
            c.curve = fmt::format("transmittance of a {}", tile ? "tile" : "box");
            c.xName = "optical depth", c.x = depth;
            lab.add(c);
            const double infinity = std::numeric_limits<double>::infinity();
            const double exact = double{
                medium::exactOpticalDepth(scene.medium, {0.4, 3, 0.3}, {0, -1, 0}, 0, infinity)[0]};
            lab.add({.name = "opacity, from the exact depth, " + name,
                     .expected = -std::expm1(-depth),
                     .measured = -std::expm1(-exact),
                     .allowance = -1e-6 * std::expm1(-depth)});
        }
}

std::string slab(double depth, double albedo, double g) {
    return fmt::format("[[volume]]\nfile = \"slab.vdb\"\nscale = {}\nalbedo = {}\ng = {}\n",
                       digits(depth), digits(albedo), g);
}
/// Takes the light from below away.
const char* const blackBelow =
    "[[volume]]\nbox = { min = [-1e9, -1000, -1e9], max = [1e9, -100, 1e9] }\n"
    "sigma_a = 10\nsigma_s = 0\n";

/// What a conservative medium does is known to its last photon.
void furnace(Lab& lab) {
    writeSlab(lab, "slab.vdb", {1, 1, 1, 1});
    for (const double g : {0.0, 0.9, -0.9})
        for (const double depth : depths) {
            if (g != 0 && depth < 1e4) continue;
            Precision precision = extremePrecision(lab);
            if (g != 0 && !lab.full()) continue;
            if (depth > 1e3) precision.relative = lab.pick(3e-2, 1e-2);
            if (g > 0) precision.relative = 3e-2;  // ten thousand scatterings, weights to match
            const std::string name = fmt::format("furnace of depth {:g}, g {}", depth, g);
            Case c = caseOf(
                name, 1,
                watch(lab, name, sceneIn(lab, slab(depth, 1, g) + evenLight + cameraAbove(1)),
                      precision, {.side = 16})[0],
                precision);
            c.curve = fmt::format("conservative furnace, g {}", g);
            c.xName = "optical depth", c.x = depth;
            lab.add(c);
        }
}

/// Reflectance at any depth and albedo: adding-doubling and Chandrasekhar's H.
void reflectance(Lab& lab) {
    writeSlab(lab, "slab.vdb", {1, 1, 1, 1});
    for (const double albedo : {0.0, 1e-12, 1 - 1e-7, 1.0})
        for (const double depth : depths) {
            // As good as the furnace.
            if (!lab.full() && (albedo == 1 ? depth > 1e3 : depth == 104)) continue;
            const Precision precision = extremePrecision(lab);
            const std::string name =
                fmt::format("depth {:g}, albedo {}", depth,
                            albedo == 1 - 1e-7 ? "1 - 1e-7" : fmt::format("{:g}", albedo));
            const double truth = depth > 1e7
                                     ? oracle::halfSpaceAlbedo(albedo, 0.8)
                                     : oracle::solveSlab({.layers = {{depth, albedo, 0}}}, {0.8})
                                           .above.reflectance[0];
            Case c = caseOf("reflectance, " + name, truth,
                            watch(lab, name,
                                  sceneIn(lab, slab(depth, albedo, 0) + blackBelow + evenLight +
                                                   cameraAbove(0.8)),
                                  precision, {.side = 8})[0],
                            precision);
            c.allowance += 3e-6;
            c.curve = "reflectance at mu 0.8, albedo " + digits(albedo), c.xName = "optical depth",
            c.x = depth;
            lab.add(c);
        }
}

/// The same slab of depth 1 in units of any size, and far from the origin.
void units(Lab& lab) {
    writeTwoColouredSky(lab);
    writeSlab(lab, "slab.vdb", {1, 1, 1, 1});
    const Precision precision = extremePrecision(lab);
    const oracle::Face truth = oracle::solveSlab({.layers = {{1, 0.9, 0.5}}}, {0.6}).above;
    const Vec3d along{0.8, -0.6, 0};
    struct Place {
        double unit, offset;
    };
    for (const Place& p :
         {Place{1e-12, 0}, {1e-6, 0}, {1e6, 0}, {1e12, 0}, {1, 1e7}, {1e-3, 1e7}, {1e6, -1e7}}) {
        const std::string name = fmt::format("slab of voxels {:g} high, sigma {:g}, at {:g}",
                                             p.unit, 1 / p.unit, p.offset);
        const Vec3d centre{p.offset, p.offset, p.offset};
        const std::string volume =
            fmt::format("transform = {{ scale = {}, translate = [{}, {}, {}] }}\n", digits(p.unit),
                        centre.x, centre.y, centre.z);
        const RgbEstimate e =
            watch(lab, name,
                  sceneIn(lab, slab(1 / p.unit, 0.9, 0.5) + volume + twoColouredSky +
                                   pencilCamera(centre - along * (50 * p.unit), along)),
                  precision, {.channels = {0, 2}});
        for (const bool above : {true, false}) {
            Case c = caseOf((above ? "reflectance, " : "transmittance, ") + name,
                            above ? truth.reflectance[0] : truth.transmittance[0], e[above ? 0 : 2],
                            precision);
            c.allowance += 3e-6 + horizonAllowance;
            lab.add(c);
        }
    }
}

}  // namespace

std::vector<Check> extremeDepths() {
    return {{Kind::Extreme, "transmittance at any depth", transmittance},
            {Kind::Extreme, "furnace at any depth", furnace},
            {Kind::Extreme, "reflectance at any depth and albedo", reflectance},
            {Kind::Extreme, "units and places", units}};
}

}  // namespace woodcock::proof
