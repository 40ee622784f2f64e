// SPDX-License-Identifier: Apache-2.0
#include "woodcock/proof/checks/volume.h"

#include "woodcock/base/error.h"
#include "woodcock/grid/grid_roles.h"
#include "woodcock/grid/vdb/load_field.h"
#include "woodcock/proof/checks/hostile.h"

namespace woodcock::proof {

namespace {

Volume volumeOf(const std::filesystem::path& file, std::string name, std::uint64_t seed) {
    constexpr int points = 32;
    constexpr double depth = 5;
    const grid::VdbFile listed = grid::listGrids(file);
    const grid::GridListing grid = grid::findGrid(listed, grid::GridRole::Density).grid;
    grid::LoadOptions options;
    options.repair = true;
    grid::LoadedGrid loaded = grid::loadGrid(listed, grid, options);
    Volume v{std::move(name),
             std::make_shared<const grid::Field>(std::move(loaded.field)),
             loaded.worldFromIndex,
             oracle::readVoxels(file, grid.name, points, seed),
             {},
             1};
    if (v.voxels.matter.empty()) throw inputError("{}: its density is the same everywhere", name);
    RandomStream random(seed);
    double sum = 0;
    for (const Vec3d& p : v.voxels.matter) {
        v.matter.push_back(v.voxels.worldFromIndex.point(p));
        sum +=
            v.opticalDepth(v.matter.back(), anyDirection(random), -2 * v.radius(), 2 * v.radius()) /
            points;
    }
    v.sigma = depth / sum;
    return v;
}

}  // namespace

Vec3d Volume::centre() const { return worldFromIndex.point(field->support().centre()); }

double Volume::radius() const {
    double radius = 0;
    for (int i = 0; i < 8; ++i)
        radius =
            std::max(radius, length(worldFromIndex.point(field->support().corner(i)) - centre()));
    return radius;
}

medium::MediumPart Volume::part(Rgb absorption, Rgb scattering, double g) const {
    medium::MediumPart::Description d;
    d.field = field;
    d.worldFromIndex = worldFromIndex;
    d.absorption = absorption * static_cast<float>(sigma);
    d.scattering = scattering * static_cast<float>(sigma);
    d.phase = medium::HenyeyGreenstein(g);
    return medium::MediumPart(std::move(d));
}

double Volume::opticalDepth(Vec3d origin, Vec3d direction, double t0, double t1) const {
    const Affine3d indexFromWorld = voxels.worldFromIndex.inverse();
    const auto aboveBackground = [this](Vec3i v) { return voxels.at(v) - voxels.background; };
    return sigma * (voxels.background * (t1 - t0) +
                    oracle::lineIntegral(aboveBackground, voxels.box, indexFromWorld.point(origin),
                                         indexFromWorld.vector(direction), t0, t1));
}

std::vector<Volume> volumes(const Lab& lab, Endless endless) {
    std::vector<Volume> all;
    for (const auto& file : lab.volumes())
        all.push_back(volumeOf(file, file.filename().string(), lab.seed(file.filename().string())));
    for (const HostileGrid& h : hostileGrids()) {
        const auto file = lab.file(std::string(h.name) + ".vdb");
        writeVdb(file, {h.grid});
        all.push_back(volumeOf(file, h.name, lab.seed(h.name)));
    }
    if (endless == Endless::Not) std::erase_if(all, [](const Volume& v) { return v.endless(); });
    return all;
}

Vec3d anyDirection(RandomStream& random) {
    const double z = 2 * random.uniform() - 1, phi = 2 * pi * random.uniform();
    const double r = std::sqrt((1 - z) * (1 + z));
    return {r * std::cos(phi), r * std::sin(phi), z};
}

}  // namespace woodcock::proof
