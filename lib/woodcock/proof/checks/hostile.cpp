// SPDX-License-Identifier: Apache-2.0
#include "woodcock/proof/checks/hostile.h"

#include <cmath>

#include "woodcock/base/random.h"

namespace woodcock::proof {

namespace {

double noise(Vec3i v, int salt = 0) {
    return RandomStream(hashOf(0x68, v.x, v.y, v.z, salt)).uniform();
}

/// Neighbours are up to six decades apart.
GridSpec checkerboard() {
    GridSpec g;
    g.box = {{-9, -9, -9}, {8, 8, 8}};  // voxels beside the faces of bricks on either side
    g.value = [](Vec3i v) { return (v.x + v.y + v.z) & 1 ? 1 : std::pow(10, -6 * noise(v)); };
    return g;
}

GridSpec singleVoxel() {
    GridSpec g;
    g.voxels = {{{-1, 7, 8}, {3}}};  // its ramp reaches into eight bricks
    g.worldFromIndex = Affine3d::scale({0.25, 0.25, 0.25});
    return g;
}

GridSpec tilesOnly() {
    GridSpec g;
    g.tiles = {{{0, 0, 0}, 128, {0.25}},        {{128, 0, 0}, 8, {4}},
               {{136, 8, 0}, 8, {1e-3}},        {{-128, 0, 0}, 128, {0.5}, false},
               {{-8, -8, -8}, 8, {0.1}, false}, {{128, 128, 128}, 8, {2}}};
    g.worldFromIndex = Affine3d::scale({0.01, 0.01, 0.01});
    return g;
}

/// Leaves of magnitudes six decades apart, with a thousand voxels of nothing between them.
GridSpec farApart() {
    GridSpec g;
    const Vec3i origins[]{{0, 0, 0}, {-1000, 520, 0}, {700, -300, 900}, {8, 0, 0}};
    double magnitude = 1e3;
    for (const Vec3i o : origins) {
        for (int x = 0; x < 8; ++x)
            for (int y = 0; y < 8; ++y)
                for (int z = 0; z < 8; ++z) {
                    const Vec3i v = o + Vec3i{x, y, z};
                    g.voxels.push_back({v, {magnitude * noise(v)}});
                }
        magnitude /= 100;
    }
    return g;
}

/// Cells have minima that make good controls, and neighbours that differ.
GridSpec nowhereEmpty() {
    GridSpec g;
    g.box = {{-16, 0, 0}, {16, 23, 23}};
    g.value = [](Vec3i v) { return 1 + noise(v); };
    g.worldFromIndex = Affine3d::scale({10, 10, 10});
    return g;
}

/// Fog without end, with voxels above and below its density, and holes.
GridSpec endless() {
    GridSpec g;
    g.background = {0.1};
    g.box = {{0, 0, 0}, {19, 9, 14}};
    g.value = [](Vec3i v) { return noise(v, 1) < 0.3 ? 0 : noise(v); };
    g.worldFromIndex = Affine3d::translate({3, 2, 1}) * Affine3d::scale({0.5, 0.5, 0.5});
    return g;
}

/// Turned, sheared, mirrored, with voxels 1 : 9.
GridSpec awkward() {
    GridSpec g;
    g.box = {{-6, -20, 3}, {13, 5, 11}};
    g.value = [](Vec3i v) { return noise(v, 2) < 0.3 ? 0 : noise(v); };
    g.worldFromIndex = Affine3d::translate({-40, 7, 90}) * Affine3d::rotate(1, 25) *
                       Affine3d::rotate(0, 110) *
                       Affine3d{{Vec3d{0.9, 0, 0.1}, Vec3d{0.2, -0.3, 0}, Vec3d{0, 0.1, 2.7}}, {}};
    return g;
}

/// Values at both ends of a half's range of exponents, denormals included.
GridSpec halfSaved() {
    GridSpec g;
    g.box = {{0, 0, 0}, {14, 14, 14}};
    g.value = [](Vec3i v) { return 65504 * std::pow(2, -40 * noise(v) * noise(v, 3)); };
    g.saveAsHalf = true;
    return g;
}

}  // namespace

std::vector<HostileGrid> hostileGrids() {
    return {{"checkerboard", checkerboard()},
            {"single voxel", singleVoxel()},
            {"tiles only", tilesOnly()},
            {"far apart", farApart()},
            {"nowhere empty", nowhereEmpty()},
            {"endless", endless()},
            {"awkward", awkward()},
            {"half-saved", halfSaved()}};
}

}  // namespace woodcock::proof
