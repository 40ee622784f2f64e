// SPDX-License-Identifier: Apache-2.0
#include "woodcock/trade/scaling_cloud.h"

#include <algorithm>
#include <cmath>

#include "woodcock/bake/bake_file.h"
#include "woodcock/bake/baker.h"
#include "woodcock/base/error.h"
#include "woodcock/grid/vdb/load_field.h"
#include "woodcock/grid/vdb/read_voxels.h"
#include "woodcock/medium/optical_depth.h"

namespace woodcock::trade {
namespace {

constexpr const char* gridName = "density";
constexpr const char* presetName = "cumulus";

bake::Bake bake(int side) {
    const bake::Recipe recipe =
        bake::makeRecipe({std::string(bake::presets().at(presetName)), presetName, ""}, {});
    const Vec3d size = recipe.bounds.size();
    return *bake::bakeRecipe(recipe,
                             bake::cubicVoxels(std::max({size.x, size.y, size.z}) / (side - 1)));
}

medium::MediumPart part(const ScalingCloud& cloud, double extinction, const ScalingView& view,
                        Vec3d moved) {
    medium::MediumPart::Description d;
    d.field = cloud.field;
    d.worldFromIndex = Affine3d::translate(moved) * cloud.worldFromIndex;
    d.scattering = Rgb(static_cast<float>(extinction * view.albedo));
    d.absorption = Rgb(static_cast<float>(extinction * (1 - view.albedo)));
    d.phase = medium::HenyeyGreenstein(view.g);
    d.majorantSmallestLog2 = view.majorantSmallestLog2;
    return medium::MediumPart(d);
}

/// Through the middle of the cloud.
camera::Camera camera(const Box3d& box) {
    const double size = length(box.size());
    return camera::Camera::perspective(box.centre() + normalize(Vec3d{0.2, 0.15, 1}) * (2 * size),
                                       box.centre(), {0, 1, 0}, 12);
}

/// Places of a square lattice, far from each other.
Vec3d farAway(int i, double size) {
    return Vec3d{double(i % 16), 0, double(i / 16)} * (100 * size);
}

}  // namespace

double meanOpticalDepth(const render::Scene& scene) {
    constexpr int rays = 24;
    const double far = 1e3 * length(scene.medium.parts.front().worldBounds().size());
    double sum = 0;
    for (int y = 0; y < rays; ++y)
        for (int x = 0; x < rays; ++x) {
            const camera::CameraRay ray = scene.camera.ray(x + 0.5, y + 0.5, rays, rays);
            sum += medium::exactOpticalDepth(scene.medium, ray.origin, ray.direction, 0, far)
                       .maximum();
        }
    return sum / (rays * rays);
}

render::Scene scalingScene(const ScalingCloud& cloud, const ScalingView& view) {
    render::Scene scene;
    const double together = view.apart ? 1 : view.volumes;
    const double extinction = view.opticalDepth / cloud.unitDepth / together;
    const double size = length(cloud.worldFromIndex.box(cloud.field->support()).size());
    for (int i = 0; i < view.volumes; ++i)
        scene.medium.parts.push_back(
            part(cloud, extinction, view, view.apart ? farAway(i, size) : Vec3d{}));
    scene.camera = camera(scene.medium.parts.front().worldBounds());
    scene.lights = light::LightSet(
        {light::Sun({-0.5, -1, -0.3}, Rgb(4), 0.53, false), light::Environment(Rgb(0.3f), true)});
    return scene;
}

ScalingCloud bakeScalingCloud(int side, const std::filesystem::path& directory, int loads) {
    ScalingCloud cloud;
    cloud.side = side;
    const std::filesystem::path file = directory / fmt::format("cloud_{}.vdb", side);
    {
        const double start = wallSeconds();
        const bake::Bake baked = bake(side);
        cloud.boxVoxels = baked.boxVoxels;
        bake::writeBake(file, baked, {}, 0);
        cloud.bakeSeconds = wallSeconds() - start;
    }
    std::vector<double> ours, peers;
    for (int i = 0; i < loads; ++i) {
        double start = wallSeconds();
        const grid::VdbPeer peer = grid::readByOpenVdb(file, gridName);
        peers.push_back(wallSeconds() - start);
        cloud.activeVoxels = peer.activeVoxels, cloud.peerBytes = peer.bytes;
        start = wallSeconds();
        grid::LoadedGrid loaded = grid::loadGrid(file, gridName, {});
        ours.push_back(wallSeconds() - start);
        cloud.worldFromIndex = loaded.worldFromIndex;
        cloud.field = std::make_shared<const grid::Field>(std::move(loaded.field));
    }
    std::filesystem::remove(file);
    cloud.load = medianOf(ours), cloud.peer = medianOf(peers);
    cloud.fieldBytes = cloud.field->bytes();
    const ScalingView usual;
    cloud.unitDepth = usual.opticalDepth;  // so that sigma_t is the density
    cloud.unitDepth = meanOpticalDepth(scalingScene(cloud, usual));
    cloud.majorantBytes = scalingScene(cloud, usual).medium.parts.front().majorants().bytes();
    return cloud;
}

}  // namespace woodcock::trade
