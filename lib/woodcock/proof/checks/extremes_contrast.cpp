// SPDX-License-Identifier: Apache-2.0
// Media that are deep in some places and thin in others, on which a careless tracker hangs.
#include <fmt/format.h>

#include <cmath>

#include "woodcock/proof/checks/extremes.h"
#include "woodcock/proof/support/write_vdb.h"

namespace woodcock::proof {

namespace {

/// Three channels, each in its own way from `low` to `high` from voxel to voxel.
GridSpec threeChannels(const char* name, Vec3d largest, double unit = 1) {
    GridSpec spec;
    spec.name = name;
    spec.type = VdbType::Vec3s;
    spec.box = {{0, 0, 0}, {15, 15, 15}};
    spec.colour = [=](Vec3i v) {
        const double u = (1 + (v.x * 5 + v.y * 3 + v.z * 7) % 11) / 11.0;
        return largest * u;
    };
    spec.worldFromIndex = Affine3d::scale({unit, unit, unit});
    return spec;
}

/// Twelve decades between the channels. Where the deepest absorbs, it ends at once, and then must
/// not set the rate of collisions.
void channels(Lab& lab) {
    writeVdb(lab.file("rgb.vdb"), {threeChannels("rgb", {1e12, 1, 1e-6}, 1.0 / 16)});
    const Precision precision = extremePrecision(lab);
    const Vec3d from{-0.5, 0.42, 0.52}, along{1, 0.1, -0.05};
    const std::string camera = pencilCamera(from, along);
    const GridSpec spec = threeChannels("rgb", {1, 1, 1}, 1.0 / 16);
    const KnownGrid grid{
        [=](Vec3i v) { return ((v.x | v.y | v.z) & ~15) == 0 ? spec.colour(v).x : 0.0; }, spec.box,
        spec.worldFromIndex};
    const double depth = grid.opticalDepth(spec.worldFromIndex.inverse().point(from),
                                           spec.worldFromIndex.inverse().vector(along));
    for (const bool absorbing : {true, false}) {
        const std::string name = absorbing ? "absorbing" : "scattering";
        // With a little scattering the paths that track distances are taken; order 0 is left out.
        const std::string volume =
            fmt::format("[[volume]]\nfile = \"rgb.vdb\"\nsigma_a = {{ grid = \"rgb\" }}\n{}",
                        absorbing ? "" : "sigma_s = { grid = \"rgb\", scale = 1e-7 }\n");
        const RgbEstimate e =
            watch(lab, "12 decades between channels, " + name,
                  sceneIn(lab, volume + evenLight + camera), precision, {.channels = {0, 1, 2}});
        const double factor[]{1e12, 1, 1e-6};
        for (int c = 0; c < 3; ++c) {
            Case one =
                caseOf(fmt::format("12 decades between channels, {}, channel {}", name, c),
                       std::exp(-depth * factor[c]), e[static_cast<std::size_t>(c)], precision);
            one.allowance += 1e-6 + (absorbing ? 0 : 2e-7 * depth);
            lab.add(one);
        }
    }
    for (const bool all : {true, false}) {
        Precision wanted = precision;
        wanted.relative = lab.pick(5e-2, 1e-2);  // a third of the paths, the deep one's, scatter on
        const std::string name = fmt::format("furnace, 12 decades between channels, {}",
                                             all ? "all" : "the deepest without scattering");
        const RgbEstimate e = watch(
            lab, name,
            sceneIn(lab, fmt::format("[[volume]]\nfile = \"rgb.vdb\"\n"
                                     "sigma_s = {{ grid = \"rgb\", scale = [{}, 1, 1] }}\n{}{}",
                                     all ? 1 : 0, evenLight, camera)),
            wanted, {.channels = {0, 1, 2}, .side = 8});
        for (int c = 0; c < 3; ++c)
            lab.add(caseOf(fmt::format("{}, channel {}", name, c), 1,
                           e[static_cast<std::size_t>(c)], wanted));
    }
}

/// A volume from production, or noise where there is none, deeper than anything.
void deepClouds(Lab& lab) {
    GridSpec cloud;
    cloud.box = {{0, 0, 0}, {23, 23, 23}};
    cloud.value = [](Vec3i v) {
        const double x = v.x - 11.5, y = v.y - 11.5, z = v.z - 11.5;
        const double r = std::sqrt(x * x + y * y + z * z) / 12;
        return r < 1 ? (1 - r) * (0.1 + (v.x * 7 + v.y * 5 + v.z * 3) % 13 / 13.0) : 0;
    };
    writeVdb(lab.file("cloud.vdb"), {cloud});
    struct File {
        std::string name, file;
        Vec3d from, along;
    };
    std::vector<File> files{{"noisy ball", "cloud.vdb", {-20, 8, 13}, {1, 0.1, 0}}};
    for (const auto& path : lab.volumes())
        if (lab.full() && path.filename() == "teapot_cloud.vdb")
            files.push_back({"teapot cloud", path.string(), {0, 0.4, 3.4}, {0, -0.1, -1}});
    const Precision precision = extremePrecision(lab);
    for (const File& f : files)
        for (const double sigma : {1e4, 1e12})
            for (const double g : {0.0, 0.99}) {
                // Thousands of scatterings, and weights to match.
                if (!lab.full() && (g > 0 || sigma < 1e6)) continue;
                Precision wanted = precision;
                if (g > 0 || sigma > 1e6) wanted.relative = lab.pick(3e-2, 1e-2);
                const std::string name =
                    fmt::format("furnace, {} of sigma {:g}, g {}", f.name, sigma, g);
                lab.add(caseOf(
                    name, 1,
                    watch(lab, name,
                          sceneIn(lab, fmt::format("[[volume]]\nfile = '{}'\nscale = {}\ng = {}\n",
                                                   f.file, digits(sigma), g) +
                                           evenLight + pencilCamera(f.from, f.along)),
                          wanted, {.side = 8})[0],
                    wanted));
            }
}

/// Parts that overlap: one of nearly nothing, one of nearly everything.
void unequalParts(Lab& lab) {
    writeVdb(lab.file("rgb.vdb"), {threeChannels("rgb", {1, 1, 1}, 1.0 / 16)});
    const Precision precision = extremePrecision(lab);
    const std::string camera = pencilCamera({-0.5, 0.42, 0.52}, {1, 0.1, -0.05});
    const std::string thin = "[[volume]]\nfile = \"rgb.vdb\"\nsigma_s = { grid = \"rgb\", scale = ";
    const std::string name = "furnace, parts of 1e12, 1, 1e-12 and a box of 1e6";
    lab.add(caseOf(
        name, 1,
        watch(lab, name,
              sceneIn(lab, thin + "1e12 }\n" + thin + "1 }\ng = 0.9\n" + thin + "1e-12 }\n" +
                               "[[volume]]\nbox = { min = [0.2, 0.2, 0.2], max = [0.5, 0.5, 0.5] "
                               "}\nsigma_a = 0\nsigma_s = 1e6\ng = -0.5\n" +
                               evenLight + camera),
              precision, {.side = 8})[0],
        precision));
    // A thin box, then black: depth 0.5 in front, and no light behind it.
    const std::string black =
        "[[volume]]\nbox = { min = [0, 0, 0], max = [1, 1, 1] }\nsigma_a = [1e12, 1, 1e-12]\n"
        "sigma_s = 0\n[[volume]]\nbox = { min = [-1, -1, -1], max = [2, 2, 2] }\nsigma_a = 0.5\n"
        "sigma_s = 0\n";
    const RgbEstimate e =
        watch(lab, "overlapping boxes of 1e12, 1 and 1e-12",
              sceneIn(lab, black + evenLight + pencilCamera({-3, 0.5, 0.5}, {1, 0, 0})), precision,
              {.channels = {0, 1, 2}});
    for (const auto& [c, depth] : {std::pair{0, 1e12}, {1, 2.5}, {2, 1.5}})
        lab.add(
            caseOf(fmt::format("transmittance, overlapping boxes of 1e12, 1, 1e-12, channel {}", c),
                   std::exp(-depth), e[static_cast<std::size_t>(c)], precision));
}

}  // namespace

std::vector<Check> extremeContrasts() {
    return {{Kind::Extreme, "twelve decades between channels", channels},
            {Kind::Extreme, "clouds deeper than anything", deepClouds},
            {Kind::Extreme, "overlapping parts of unlike depth", unequalParts}};
}

}  // namespace woodcock::proof
