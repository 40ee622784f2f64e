// SPDX-License-Identifier: Apache-2.0
#include "woodcock/scene/build.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string_view>
#include <tuple>

#include "woodcock/base/error.h"
#include "woodcock/grid/coarsen.h"
#include "woodcock/grid/motion.h"
#include "woodcock/grid/moved_ranges.h"
#include "woodcock/scene/light_groups.h"

namespace woodcock::scene {
namespace {

using Part = medium::MediumPart::Description;

/// A volume with how its grids move.
struct Moving {
    const VolumeDescription& volume;
    const LoadedVolume& loaded;
    /// When the shutter opens and closes, in the time of the velocities.
    double open, close;

    Moving(const SceneDescription& scene, const VolumeDescription& v, const LoadedVolume& l)
        : volume(v),
          loaded(l),
          open(scene.camera.shutter.open * v.velocity.timeOfFrame(scene.render.fps)),
          close(scene.camera.shutter.close * v.velocity.timeOfFrame(scene.render.fps)) {}

    /// Of one of its grids; null: it stands as its file has it.
    std::shared_ptr<const grid::Motion> of(const LoadedField& field) const {
        if (!loaded.velocity || (open == 0 && close == 0)) return nullptr;
        try {
            return std::make_shared<grid::Motion>(loaded.velocity, field.objectFromIndex, open,
                                                  close);
        } catch (const Error& e) {
            throw Error(e.kind(), fmt::format("{}: {}", volume.file.string(), e.what()));
        }
    }
};

Part fieldPart(const Moving& moving, const LoadedField& loaded) {
    Part part;
    part.field = loaded.field;
    part.worldFromIndex = moving.volume.worldFromObject * loaded.objectFromIndex;
    part.motion = moving.of(loaded);
    return part;
}

std::vector<Part> parts(const Moving& moving, const DensityCoefficients& c) {
    const LoadedVolume& loaded = moving.loaded;
    if (!c.scale) throw usageError("a volume's scale has not been chosen yet");
    Part part = fieldPart(moving, loaded.density);
    std::tie(part.absorption, part.scattering) = splitByAlbedo(*c.scale, c.albedo);
    if (loaded.albedo) {
        part.albedo = loaded.albedo.field;
        part.albedoWorldFromIndex = moving.volume.worldFromObject * loaded.albedo.objectFromIndex;
        part.albedoMotion = moving.of(loaded.albedo);
    }
    return {part};
}

std::vector<Part> parts(const Moving& moving, const SeparateCoefficients& c) {
    const LoadedVolume& loaded = moving.loaded;
    std::vector<Part> all;
    if (c.sigmaA) {
        all.push_back(fieldPart(moving, loaded.sigmaA));
        all.back().absorption = c.sigmaA->scale;
        all.back().scattering = Rgb(0);
    }
    if (c.sigmaS) {
        const bool sameGrid = c.sigmaA && loaded.sigmaA.field == loaded.sigmaS.field;
        if (!sameGrid) all.push_back(fieldPart(moving, loaded.sigmaS));
        all.back().scattering = c.sigmaS->scale;
    }
    return all;
}

std::vector<Part> parts(const Moving& moving, const HomogeneousBox& c) {
    Part part;
    part.box = c.box;
    part.worldFromIndex = moving.volume.worldFromObject;
    part.absorption = c.sigmaA;
    part.scattering = c.sigmaS;
    return {part};
}

/// Parts that emit nothing are left out.
std::vector<medium::EmissionPart> emission(const Moving& moving,
                                           const std::shared_ptr<const MovingTransform>& movement,
                                           std::uint8_t group) {
    const VolumeDescription& volume = moving.volume;
    const LoadedVolume& loaded = moving.loaded;
    std::vector<medium::EmissionPart> all;
    const auto add = [&](const LoadedField& field, Rgb scale) {
        medium::EmissionPart::Description part;
        part.worldFromIndex = volume.worldFromObject;
        if (field) {
            part.field = field.field;
            part.motion = moving.of(field);
            part.worldFromIndex = volume.worldFromObject * field.objectFromIndex;
        } else {
            part.box = std::get<HomogeneousBox>(volume.coefficients).box;
        }
        part.scale = scale;
        part.movement = movement;
        part.group = group;
        if (scale.maximum() > 0) all.emplace_back(std::move(part));
    };
    if (volume.emission) add(loaded.emission, volume.emission->scale);
    if (const auto& b = volume.blackbody)
        add(loaded.blackbody, b->colour * static_cast<float>(b->intensity));
    return all;
}

/// The parts of a volume that do something to light.
std::vector<Part> activeParts(const Moving& moving) {
    std::vector<Part> all =
        std::visit([&](const auto& c) { return parts(moving, c); }, moving.volume.coefficients);
    std::erase_if(all, [](const Part& p) { return (p.absorption + p.scattering).maximum() == 0; });
    return all;
}

// ---- levels of detail

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

/// The width of a pixel in world units at the point of `box` next to the camera, as in the middle
/// of a picture without shift; 0 within the box of a perspective camera.
double pixelWidth(const camera::Camera& camera, int height, const Box3d& box) {
    if (camera.kind == camera::Camera::Kind::Orthographic) return camera.height / height;
    const Vec3d eye = camera.worldFromCamera.translation;
    const double distance = length(max(Vec3d{}, max(box.lower - eye, eye - box.upper)));
    return distance * 2 * std::tan(camera.fovY * pi / 360) / height;
}

struct PhaseOf {
    const std::optional<medium::PhaseTable>& table;

    medium::PhaseFunction operator()(const IsotropicPhase&) const { return {}; }
    medium::PhaseFunction operator()(const HenyeyGreensteinPhase& p) const {
        return medium::HenyeyGreenstein(p.g);
    }
    medium::PhaseFunction operator()(const TwoLobePhase& p) const {
        return medium::TwoLobes(p.g, p.g2, p.mix);
    }
    medium::PhaseFunction operator()(const RayleighPhase&) const { return medium::Rayleigh(); }
    medium::PhaseFunction operator()(const DrainePhase& p) const {
        return medium::Draine(p.g, p.alpha);
    }
    medium::PhaseFunction operator()(const MiePhase& p) const {
        return medium::MieDroplets(p.diameter);
    }
    medium::PhaseFunction operator()(const FournierForandPhase& p) const {
        return medium::FournierForand(p.ior, p.backscatter);
    }
    medium::PhaseFunction operator()(const TablePhase&) const {
        if (!table) throw usageError("the table of a phase function has not been loaded");
        return *table;
    }
};

}  // namespace

medium::PhaseFunction buildPhase(float g, const std::optional<PhaseDescription>& phase,
                                 const std::optional<medium::PhaseTable>& table) {
    if (!phase) return medium::HenyeyGreenstein(g);
    return std::visit(PhaseOf{table}, *phase);
}

medium::Medium buildMedium(const SceneDescription& description, const LoadedScene& loaded,
                           const Movements& movements, std::string_view inside) {
    medium::Medium medium;
    for (size_t i = 0; i < description.volumes.size(); ++i) {
        const VolumeDescription& volume = description.volumes[i];
        if (volume.inside != inside) continue;
        const Moving moving(description, volume, loaded.volumes[i]);
        for (Part part : activeParts(moving)) {
            part.phase = buildPhase(volume.g, volume.phase, loaded.volumes[i].phase);
            part.majorantScale = description.render.majorantScale;
            part.movement = movements.volumes[i];
            medium.parts.emplace_back(std::move(part));
        }
        const std::uint8_t group = groupNumber(lightGroups(description), volume.group);
        for (medium::EmissionPart& part : emission(moving, movements.volumes[i], group))
            medium.emission.push_back(std::move(part));
    }
    return medium;
}

std::vector<size_t> volumesOfParts(const SceneDescription& description, const LoadedScene& loaded,
                                   std::string_view inside) {
    std::vector<size_t> volumes;
    for (size_t i = 0; i < description.volumes.size(); ++i)
        if (description.volumes[i].inside == inside)
            volumes.insert(
                volumes.end(),
                activeParts({description, description.volumes[i], loaded.volumes[i]}).size(), i);
    return volumes;
}

std::vector<std::string> motionNotes(const SceneDescription& description, const LoadedScene& loaded,
                                     const medium::Medium& medium, std::string_view inside) {
    std::vector<std::string> notes;
    const std::vector<size_t> volumes = volumesOfParts(description, loaded, inside);
    for (size_t i = 0; i < medium.parts.size(); ++i) {
        const medium::MediumPart& part = medium.parts[i];
        if (!part.moved()) continue;
        const size_t volume = volumes[i];
        notes.push_back(fmt::format(
            "volume[{}]: '{}' moves it by up to {:.3g} voxels while the shutter is open; {:.0f} % "
            "of its blocks have bounds that reach further than a block's width",
            volume, loaded.volumes[volume].velocities, part.description().motion->mostVoxels(),
            100 * part.moved()->looseShare()));
    }
    return notes;
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
