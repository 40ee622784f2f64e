// SPDX-License-Identifier: Apache-2.0
// Writes the demo's cumulus: demo_cloud FILE.vdb

#include <fmt/core.h>
#include <openvdb/openvdb.h>
#include <tbb/parallel_for.h>

#include <memory>
#include <vector>

#include "woodcock/base/random.h"
#include "woodcock/base/vec.h"

namespace {

using namespace woodcock;
using Tree = openvdb::FloatTree;
using Leaf = Tree::LeafNodeType;

constexpr double voxel = 4;     // metres
constexpr double blend = 30;    // metres over which neighbouring puffs melt into each other
constexpr double relief = 110;  // metres, height of the cauliflower
constexpr double edge = 16;     // metres from clear air to full density

struct Puff {
    Vec3d centre;
    double radius;
};

double uniform(RandomStream& random, double from, double to) {
    return from + (to - from) * random.uniform();
}

/// Smaller puffs on the upper side of `parent`, and smaller ones on those.
void grow(const Puff& parent, int generations, RandomStream& random, std::vector<Puff>& puffs) {
    puffs.push_back(parent);
    if (generations == 0) return;
    for (int i = 0; i < 5; ++i) {
        const double height = uniform(random, 0.0, 1.0), turn = uniform(random, 0, 2 * pi);
        const double side = std::sqrt(1 - height * height);
        const Vec3d direction{side * std::cos(turn), height, side * std::sin(turn)};
        const Puff child{parent.centre + direction * (parent.radius * 0.85),
                         parent.radius * uniform(random, 0.4, 0.6)};
        grow(child, generations - 1, random, puffs);
    }
}

std::vector<Puff> makePuffs() {
    RandomStream random(1965);
    std::vector<Puff> puffs;
    constexpr int feet = 9;
    for (int i = 0; i < feet; ++i) {
        const double along = 2.0 * i / (feet - 1) - 1;
        const double bulk = 1 - 0.55 * along * along;
        const Puff foot{{along * 330, bulk * 70, uniform(random, -110, 110)},
                        bulk * uniform(random, 115, 165)};
        grow(foot, 2, random, puffs);
    }
    return puffs;
}

/// 1 at the scattered points of a random lattice of spacing 1, falling to 0 with distance.
double cells(Vec3d p) {
    const Vec3i corner = Vec3d{std::floor(p.x), std::floor(p.y), std::floor(p.z)}.as<int>();
    double nearest = 1;
    for (int i = 0; i < 27; ++i) {
        const Vec3i cell = corner + Vec3i{i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1};
        RandomStream random(hashOf(static_cast<std::uint64_t>(cell.x), cell.y, cell.z));
        const double x = random.uniform(), y = random.uniform(), z = random.uniform();
        const Vec3d toPoint = cell.as<double>() + Vec3d{x, y, z} - p;
        nearest = std::min(nearest, dot(toPoint, toPoint));
    }
    return 1 - std::sqrt(nearest);
}

double cauliflower(Vec3d p) {
    double sum = 0, wavelength = 130, weight = 0.5;
    for (int octave = 0; octave < 5; ++octave, wavelength *= 0.5, weight *= 0.5)
        sum += weight * cells(p * (1 / wavelength));
    return sum;
}

/// Quilez 2013, "smooth minimum", the quadratic one.
double smoothMin(double a, double b, double width) {
    const double h = std::max(width - std::abs(a - b), 0.0) / width;
    return std::min(a, b) - h * h * width * 0.25;
}

/// Signed distance to the melted puffs over a flat base, before any relief.
double distanceTo(Vec3d p, const std::vector<Puff>& puffs) {
    double distance = 1e6;
    for (const Puff& puff : puffs)
        distance = smoothMin(distance, length(p - puff.centre) - puff.radius, blend);
    return -smoothMin(-distance, p.y, blend);
}

double density(Vec3d p, const std::vector<Puff>& puffs) {
    const double smooth = distanceTo(p, puffs);
    if (smooth > relief || smooth < -relief - edge) return smooth < 0;
    const double rough = smooth - relief * (cauliflower(p) - 0.35);
    const double t = std::clamp(-rough / edge, 0.0, 1.0);
    return t * t * (3 - 2 * t);
}

std::unique_ptr<Leaf> makeLeaf(openvdb::Coord origin, const std::vector<Puff>& puffs) {
    const auto world = [](openvdb::Coord c) {
        return Vec3d{c.x() + 0.0, c.y() + 0.0, c.z() + 0.0} * voxel;
    };
    constexpr double reach = 4 * voxel * 1.7320508 + relief + blend;
    const Vec3d centre = world(origin.offsetBy(4));
    std::vector<Puff> near;
    for (const Puff& puff : puffs)
        if (length(centre - puff.centre) < puff.radius + reach) near.push_back(puff);
    if (near.empty()) return nullptr;

    auto leaf = std::make_unique<Leaf>(origin, 0.0f);
    for (openvdb::Index i = 0; i < Leaf::SIZE; ++i) {
        const double d = density(world(leaf->offsetToGlobalCoord(i)), near);
        if (d > 0) leaf->setValueOn(i, static_cast<float>(d));
    }
    if (leaf->isEmpty()) return nullptr;
    return leaf;
}

openvdb::FloatGrid::Ptr makeCloud() {
    const std::vector<Puff> puffs = makePuffs();
    Box3d box;
    for (const Puff& puff : puffs) {
        const Vec3d reach = Vec3d{1, 1, 1} * (puff.radius + relief);
        box.add(puff.centre - reach), box.add(puff.centre + reach);
    }
    std::vector<openvdb::Coord> origins;
    const auto leafOf = [](double metres) {
        return static_cast<int>(std::floor(metres / voxel / 8));
    };
    for (int x = leafOf(box.lower.x); x <= leafOf(box.upper.x); ++x)
        for (int y = leafOf(-relief); y <= leafOf(box.upper.y); ++y)
            for (int z = leafOf(box.lower.z); z <= leafOf(box.upper.z); ++z)
                origins.emplace_back(8 * x, 8 * y, 8 * z);

    std::vector<std::unique_ptr<Leaf>> leaves(origins.size());
    tbb::parallel_for(std::size_t{0}, origins.size(),
                      [&](std::size_t i) { leaves[i] = makeLeaf(origins[i], puffs); });

    auto grid = openvdb::FloatGrid::create();
    for (std::unique_ptr<Leaf>& leaf : leaves)
        if (leaf) grid->tree().addLeaf(leaf.release());
    grid->tree().prune();
    grid->setName("density");
    grid->setGridClass(openvdb::GRID_FOG_VOLUME);
    grid->setTransform(openvdb::math::Transform::createLinearTransform(voxel));
    grid->setSaveFloatAsHalf(true);
    return grid;
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 2) {
        fmt::print(stderr, "usage: demo_cloud FILE.vdb\n");
        return 2;
    }
    try {
        openvdb::initialize();
        openvdb::io::File(argv[1]).write({makeCloud()});
    } catch (const std::exception& error) {
        fmt::print(stderr, "demo_cloud: {}: {}\n", argv[1], error.what());
        return 1;
    }
    return 0;
}
