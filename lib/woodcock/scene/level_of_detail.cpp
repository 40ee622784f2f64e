// SPDX-License-Identifier: Apache-2.0
#include "woodcock/scene/level_of_detail.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "woodcock/grid/coarsen.h"

namespace woodcock::scene {
namespace {

constexpr int mostLevels = 30;  // more than halve any index away

using FieldPointer = std::shared_ptr<const grid::Field>;

/// Fields at lower resolutions, each made once.
class Pyramid {
public:
    FieldPointer level(const FieldPointer& field, const FieldPointer& weights, int levels) {
        if (levels == 0) return field;
        FieldPointer& coarse = coarse_[{field, weights, levels}];
        if (!coarse) {
            const FieldPointer finer = level(field, weights, levels - 1);
            const FieldPointer finerWeights =
                weights ? level(weights, nullptr, levels - 1) : nullptr;
            coarse = std::make_shared<grid::Field>(grid::coarsened(*finer, finerWeights.get()));
        }
        return coarse;
    }

private:
    std::map<std::tuple<FieldPointer, FieldPointer, int>, FieldPointer> coarse_;
};

double voxelWidth(const Affine3d& worldFromIndex) {
    double width = 0;
    for (const Vec3d& edge : worldFromIndex.column) width = std::max(width, length(edge));
    return width;
}

}  // namespace

double pixelWidth(const camera::Camera& camera, int height, const Box3d& box) {
    if (camera.kind == camera::Camera::Kind::Orthographic) return camera.height / height;
    const Vec3d eye = camera.worldFromCamera.translation;
    const double distance = length(max(Vec3d{}, max(box.lower - eye, eye - box.upper)));
    return distance * 2 * std::tan(camera.fovY * pi / 360) / height;
}

std::vector<std::string> coarsenForCamera(const SceneDescription& description,
                                          const camera::Camera& camera, LoadedScene& loaded) {
    const RenderDescription& render = description.render;
    std::vector<std::string> notes;
    if (!(render.levelOfDetail > 0)) return notes;
    Pyramid pyramid;
    for (std::size_t i = 0; i < loaded.volumes.size(); ++i) {
        const VolumeDescription& volume = description.volumes[i];
        LoadedVolume& fields = loaded.volumes[i];
        const LoadedField density = fields.density;
        const auto coarsen = [&](LoadedField& grid, const FieldPointer& weights) {
            if (!grid || grid.field->extent().empty()) return;
            const Affine3d worldFromIndex = volume.worldFromObject * grid.objectFromIndex;
            const double pixel =
                pixelWidth(camera, render.height, worldFromIndex.box(grid.field->extent()));
            double pixels = voxelWidth(worldFromIndex) / pixel;
            int levels = 0;
            for (; 2 * pixels <= render.levelOfDetail && levels < mostLevels; ++levels)
                pixels *= 2, grid.objectFromIndex = grid.objectFromIndex * grid::fineFromCoarse();
            if (levels == 0) return;
            grid.field = pyramid.level(grid.field, weights, levels);
            std::string note = fmt::format(
                "level of detail: grid '{}' in {}: voxels {} times as wide, now {:.2g} pixels",
                grid.grid, volume.file.string(), 1u << levels, pixels);
            if (std::find(notes.begin(), notes.end(), note) == notes.end())
                notes.push_back(std::move(note));
        };
        const bool sameVoxels =
            fields.albedo && density && fields.albedo.objectFromIndex == density.objectFromIndex;
        coarsen(fields.albedo, sameVoxels ? density.field : nullptr);
        for (LoadedField* grid :
             {&fields.density, &fields.emission, &fields.blackbody, &fields.sigmaA, &fields.sigmaS})
            coarsen(*grid, nullptr);
    }
    return notes;
}

}  // namespace woodcock::scene
