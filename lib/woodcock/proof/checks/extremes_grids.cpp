// SPDX-License-Identifier: Apache-2.0
// Grids of every shape and every value.
#include <fmt/format.h>

#include <cmath>

#include "woodcock/base/random.h"
#include "woodcock/proof/checks/extremes.h"
#include "woodcock/proof/support/write_vdb.h"

namespace woodcock::proof {

namespace {

/// In the leaf at the origin.
bool inLeaf(Vec3i v) { return ((v.x | v.y | v.z) & ~7) == 0; }

std::string volumeOf(const char* file, double sigma, const char* more = "") {
    return fmt::format("[[volume]]\nfile = \"{}\"\nsigma_a = {}\nsigma_s = 0\n{}", file,
                       digits(sigma), more);
}
std::string furnaceOf(const char* file, double sigma, const char* more = "") {
    return fmt::format("[[volume]]\nfile = \"{}\"\nsigma_a = 0\nsigma_s = {}\n{}", file,
                       digits(sigma), more) +
           evenLight;
}

void addFurnace(Lab& lab, const std::string& name, const std::string& scene,
                const std::string& camera) {
    const Precision precision = extremePrecision(lab);
    lab.add(caseOf(
        "furnace, " + name, 1,
        watch(lab, "furnace, " + name, sceneIn(lab, scene + camera), precision, {.side = 8})[0],
        precision));
}

/// Ten voxels in a grid a million wide.
void wide(Lab& lab) {
    GridSpec spec;
    for (int i = 0; i < 10; ++i) spec.voxels.push_back({{i * 111111, 7 * i, -3 * i}, {1}});
    spec.worldFromIndex = Affine3d::scale({0.5, 0.5, 0.5});
    writeVdb(lab.file("wide.vdb"), {spec});
    const KnownGrid grid{[](Vec3i v) {
                             const int i = v.x / 111111;
                             return v.x == i * 111111 && v.y == 7 * i && v.z == -3 * i ? 1.0 : 0.0;
                         },
                         {},
                         spec.worldFromIndex,
                         2};
    for (const int i : {0, 4, 9}) {
        KnownGrid one = grid;
        const Vec3i at = spec.voxels[static_cast<std::size_t>(i)].at;
        one.box = {at, at};
        addTransmittance(lab, fmt::format("across voxel {} of ten, a million apart", i),
                         volumeOf("wide.vdb", 2), one, at.as<double>() + Vec3d{0.3, 40, -0.2},
                         {0, -1, 0});
    }
    // Along all of them, in the plane that each is next to.
    KnownGrid all = grid;
    all.sigma = 0.2;
    const Vec3d along{111111, 7, -3};
    double depth = 0;
    for (int i = 0; i < 10; ++i) {
        const Vec3i at = spec.voxels[static_cast<std::size_t>(i)].at;
        all.box = {at, at};
        depth += all.opticalDepth(Vec3d{0, 0, 0} - along * 0.5, along);
    }
    const Vec3d eye = spec.worldFromIndex.point(Vec3d{0, 0, 0} - along * 0.5);
    const Precision precision = extremePrecision(lab);
    Case c =
        caseOf("transmittance, through ten voxels, a million apart", std::exp(-depth),
               watch(lab, "through ten voxels, a million apart",
                     sceneIn(lab, volumeOf("wide.vdb", 0.2) + evenLight + pencilCamera(eye, along)),
                     precision, {.mostSteps = 500})[0],
               precision);
    lab.add(c);
    addFurnace(lab, "ten voxels, a million apart", furnaceOf("wide.vdb", 1e6),
               pencilCamera(eye, along));
}

/// The hat of one voxel: through its middle, past it, along a face and at an angle.
void singleVoxel(Lab& lab) {
    GridSpec spec;
    spec.voxels = {{{5, -9, 1000}, {3}}};
    spec.worldFromIndex = Affine3d::rotate(1, 30) * Affine3d::scale({0.25, 0.25, 0.25});
    writeVdb(lab.file("voxel.vdb"), {spec});
    for (const double sigma : {1e-6, 1.0, 1e4}) {
        const KnownGrid grid{[](Vec3i v) {
                                 return v == Vec3i{5, -9, 1000} ? 3.0 : 0.0;
                             },
                             {{5, -9, 1000}, {5, -9, 1000}},
                             spec.worldFromIndex,
                             sigma};
        const std::string volume = volumeOf("voxel.vdb", sigma);
        // The edge of a deep voxel, where light still comes through.
        const double offset = sigma > 1e3 ? 0.999 : 0.4;
        struct Line {
            const char* name;
            Vec3d from, along;
        };
        for (const Line& l :
             {Line{"its middle", {-10, -9, 1000 + (sigma > 1e3 ? 0.9998 : 0)}, {1, 0, 0}},
              {"its side", {5 - offset, -9 + offset, 980}, {0, 0, 1}},
              {"its support's face", {6, 3, 1000}, {0, -1, 0}},
              {"a diagonal", {-4.5 - offset, -19 + offset, 990}, {1, 1, 1}}})
            if (grid.opticalDepth(l.from, l.along) < 10)
                addTransmittance(lab,
                                 fmt::format("a single voxel of sigma {:g}, {}", 3 * sigma, l.name),
                                 volume, grid, l.from, l.along);
    }
    addFurnace(lab, "a single voxel of sigma 3e12", furnaceOf("voxel.vdb", 1e12),
               pencilCamera(spec.worldFromIndex.point({-10, -9, 1000}),
                            spec.worldFromIndex.vector({1, 0, 0})));
}

/// Tiles only, of every size.
void onlyTiles(Lab& lab) {
    GridSpec spec;
    spec.tiles = {{{0, 0, 0}, 8, {1}}, {{128, 0, 0}, 128, {0.125}}, {{4096, 0, 0}, 4096, {0.001}}};
    writeVdb(lab.file("tiles.vdb"), {spec});
    const auto inside = [](Vec3i v, int from, int size) {
        return v.x >= from && v.x < from + size && v.y >= 0 && v.y < size && v.z >= 0 && v.z < size;
    };
    const KnownGrid grid{[=](Vec3i v) {
                             return inside(v, 0, 8)         ? 1.0
                                    : inside(v, 128, 128)   ? 0.125
                                    : inside(v, 4096, 4096) ? double{0.001f}
                                                            : 0.0;
                         },
                         {{0, 0, 0}, {8191, 4095, 4095}},
                         {},
                         0.05};
    const std::string volume = volumeOf("tiles.vdb", 0.05);
    addTransmittance(lab, "only tiles, along their faces", volume, grid, {-5, 7, 0}, {1, 0, 0});
    addTransmittance(lab, "only tiles, inside their faces' ramps", volume, grid, {-5, 7.5, -0.25},
                     {1, 0, 0});
    addTransmittance(lab, "only tiles, at an angle", volume, grid, {-5, 1, 1}, {1, 0.01, 0.02});
    addFurnace(lab, "only tiles", furnaceOf("tiles.vdb", 10),
               pencilCamera({-5, 1, 1}, {1, 0.01, 0.02}));
}

/// A background without end, and a sphere light behind it.
void background(Lab& lab) {
    GridSpec spec;
    spec.background = {0.25};
    spec.voxels = {{{0, 0, 0}, {2}}, {{3, 0, 0}, {0}}};
    writeVdb(lab.file("haze.vdb"), {spec});
    const Precision precision = extremePrecision(lab);
    for (const double sigma : {1.0, 0.05}) {
        // The light is a sphere of radius 1 at 10 / sigma.
        const double end = 10 / sigma - 1;
        for (const double offset : {0.0, 0.4}) {
            const auto above = [](Vec3i v) {
                return v == Vec3i{0, 0, 0} ? 1.75 : v == Vec3i{3, 0, 0} ? -0.25 : 0.0;
            };
            const double extra = oracle::lineIntegral(above, {{0, 0, 0}, {3, 0, 0}},
                                                      {-5, offset, 0}, {1, 0, 0}, 0, 100);
            const double depth = 0.1 * sigma * (extra + 0.25 * (end + 5));
            const std::string name =
                fmt::format("a background of {:g} up to a light, offset {}", 0.025 * sigma, offset);
            const render::Scene scene = sceneIn(
                lab, volumeOf("haze.vdb", 0.1 * sigma, "background = \"endless\"\n") +
                         fmt::format("[[light]]\ntype = \"sphere\"\nradius = 1\nradiance = 1\n"
                                     "position = [{}, {}, 0]\n",
                                     digits(end + 1), offset) +
                         pencilCamera({-5, offset, 0}, {1, 0, 0}));
            lab.add(caseOf("transmittance, " + name, std::exp(-depth),
                           watch(lab, name, scene, precision)[0], precision));
        }
    }
    lab.add(caseOf("light from behind a background without end", 0,
                   watch(lab, "light from behind a background without end",
                         sceneIn(lab, volumeOf("haze.vdb", 1e-9, "background = \"endless\"\n") +
                                          evenLight + pencilCamera({-5, 0, 0}, {1, 0, 0})),
                         precision)[0],
                   precision));
}

/// A background that ends one voxel around the active voxels; these become ever fainter.
void backgroundWithin(Lab& lab) {
    for (const double haze : {0.25, 1e-6, 1e-38}) {
        GridSpec spec;
        spec.background = {haze};
        spec.voxels = {{{0, 0, 0}, {2}}, {{3, 0, 0}, {0}}, {{9, 1, 0}, {haze}}};
        const std::string file = fmt::format("haze_{:g}.vdb", haze);
        writeVdb(lab.file(file), {spec});
        const KnownGrid grid{[=](Vec3i v) {
                                 return v == Vec3i{0, 0, 0}   ? 2
                                        : v == Vec3i{3, 0, 0} ? 0
                                                              : double{static_cast<float>(haze)};
                             },
                             {{0, 0, 0}, {9, 1, 0}},
                             {},
                             0.3};
        addTransmittance(lab, fmt::format("a background of {:g} around the active voxels", haze),
                         volumeOf(file.c_str(), 0.3), grid, {-5, 0.4, -0.3}, {1, 0, 0});
        addFurnace(lab, fmt::format("a background of {:g}", haze), furnaceOf(file.c_str(), 30),
                   pencilCamera({-5, 0.4, -0.3}, {1, 0, 0}));
    }
}

/// The largest and the smallest numbers of a half.
void halves(Lab& lab) {
    for (const bool large : {true, false}) {
        const double unit = large ? 32 : 0x1p-24;
        const auto value = [=](Vec3i v) {
            if (!inLeaf(v)) return 0.0;
            const auto h = hashOf(11, v.x, v.y, v.z);
            // Up to 65504; or the denormals, to the normal ones' first.
            return unit * static_cast<double>(h % (large ? 2048 : 1026));
        };
        GridSpec spec;
        spec.box = {{0, 0, 0}, {7, 7, 7}};
        spec.value = value;
        spec.saveAsHalf = true;
        const char* const file = large ? "large.vdb" : "small.vdb";
        writeVdb(lab.file(file), {spec});
        const KnownGrid grid{value, spec.box, {}, 0.25 / (1024 * unit)};
        for (const char* storage : {"half", "float"})
            addTransmittance(
                lab,
                fmt::format("halves from {:g} to {:g}, kept as {}", unit,
                            unit * (large ? 2047 : 1025), storage),
                volumeOf(file, grid.sigma, fmt::format("storage = \"{}\"\n", storage).c_str()),
                grid, {-3, 2.3, 4.6}, {1, 0.1, -0.2});
    }
}

/// Each voxel of another size: 12 decades in a leaf.
void decades(Lab& lab) {
    const auto value = [](Vec3i v) {
        if (!inLeaf(v)) return 0.0;
        const double u = static_cast<double>(hashOf(5, v.x, v.y, v.z) >> 11) * 0x1p-53;
        return double{static_cast<float>(std::pow(10, 12 * u - 6))};
    };
    GridSpec spec;
    spec.box = {{0, 0, 0}, {7, 7, 7}};
    spec.value = value;
    writeVdb(lab.file("decades.vdb"), {spec});
    // The last line almost misses it, between voxels of 1e6.
    for (const double sigma : {1e-6, 1e-2})
        for (const Vec3d from : {Vec3d{-3, 2.3, 4.6}, {-3, 2, 5}, {-3, -0.99999, 3.3}}) {
            const KnownGrid grid{value, spec.box, {}, sigma};
            const double depth = grid.opticalDepth(from, {1, 0, 0});
            if (depth > 12 || depth < 1e-3) continue;  // rare events tell no scatter
            addTransmittance(lab,
                             fmt::format("12 decades in a leaf, sigma to {:g}, from {}, {}",
                                         1e6 * sigma, from.y, from.z),
                             volumeOf("decades.vdb", sigma), grid, from, {1, 0, 0});
        }
    for (const double sigma : {1e-6, 1e6})
        if (sigma < 1 || lab.full())
            addFurnace(lab, fmt::format("12 decades in a leaf, sigma to {:g}", 1e6 * sigma),
                       furnaceOf("decades.vdb", sigma),
                       pencilCamera({-3, 2.3, 4.6}, {1, 0.1, -0.1}));
}

}  // namespace

std::vector<Check> extremeGrids() {
    return {{Kind::Extreme, "ten voxels in a grid a million wide", wide},
            {Kind::Extreme, "a single voxel", singleVoxel},
            {Kind::Extreme, "only tiles", onlyTiles},
            {Kind::Extreme, "background not zero", background},
            {Kind::Extreme, "background within bounds", backgroundWithin},
            {Kind::Extreme, "half-float extremes", halves},
            {Kind::Extreme, "twelve decades in a leaf", decades}};
}

}  // namespace woodcock::proof
