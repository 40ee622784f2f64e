// SPDX-License-Identifier: Apache-2.0
#include "woodcock/scene/build_medium.h"

#include <tuple>

#include "woodcock/base/error.h"

namespace woodcock::scene {
namespace {

using Part = medium::MediumPart::Description;

Part fieldPart(const VolumeDescription& volume, const LoadedField& loaded) {
    Part part;
    part.field = loaded.field;
    part.worldFromIndex = volume.worldFromObject * loaded.objectFromIndex;
    return part;
}

std::vector<Part> parts(const VolumeDescription& volume, const DensityCoefficients& c,
                        const LoadedVolume& loaded) {
    if (!c.scale) throw usageError("a volume's scale has not been chosen yet");
    Part part = fieldPart(volume, loaded.density);
    std::tie(part.absorption, part.scattering) = splitByAlbedo(*c.scale, c.albedo);
    if (loaded.albedo) {
        part.albedo = loaded.albedo.field;
        part.albedoWorldFromIndex = volume.worldFromObject * loaded.albedo.objectFromIndex;
    }
    return {part};
}

std::vector<Part> parts(const VolumeDescription& volume, const SeparateCoefficients& c,
                        const LoadedVolume& loaded) {
    std::vector<Part> all;
    if (c.sigmaA) {
        all.push_back(fieldPart(volume, loaded.sigmaA));
        all.back().absorption = c.sigmaA->scale;
        all.back().scattering = Rgb(0);
    }
    if (c.sigmaS) {
        const bool sameGrid = c.sigmaA && loaded.sigmaA.field == loaded.sigmaS.field;
        if (!sameGrid) all.push_back(fieldPart(volume, loaded.sigmaS));
        all.back().scattering = c.sigmaS->scale;
    }
    return all;
}

std::vector<Part> parts(const VolumeDescription& volume, const HomogeneousBox& c,
                        const LoadedVolume&) {
    Part part;
    part.box = c.box;
    part.worldFromIndex = volume.worldFromObject;
    part.absorption = c.sigmaA;
    part.scattering = c.sigmaS;
    return {part};
}

/// Parts that emit nothing are left out.
std::vector<medium::EmissionPart> emission(const VolumeDescription& volume,
                                           const LoadedVolume& loaded) {
    std::vector<medium::EmissionPart> all;
    const auto add = [&](const LoadedField& field, Rgb scale) {
        medium::EmissionPart::Description part;
        part.worldFromIndex = volume.worldFromObject;
        if (field) {
            part.field = field.field;
            part.worldFromIndex = volume.worldFromObject * field.objectFromIndex;
        } else {
            part.box = std::get<HomogeneousBox>(volume.coefficients).box;
        }
        part.scale = scale;
        if (scale.maximum() > 0) all.emplace_back(std::move(part));
    };
    if (volume.emission) add(loaded.emission, volume.emission->scale);
    if (const auto& b = volume.blackbody)
        add(loaded.blackbody, b->colour * static_cast<float>(b->intensity));
    return all;
}

/// The parts of a volume that do something to light.
std::vector<Part> activeParts(const VolumeDescription& volume, const LoadedVolume& loaded) {
    std::vector<Part> all =
        std::visit([&](const auto& c) { return parts(volume, c, loaded); }, volume.coefficients);
    std::erase_if(all, [](const Part& p) { return (p.absorption + p.scattering).maximum() == 0; });
    return all;
}

}  // namespace

medium::Medium buildMedium(const SceneDescription& description, const LoadedScene& loaded,
                           std::string_view inside) {
    medium::Medium medium;
    for (size_t i = 0; i < description.volumes.size(); ++i) {
        const VolumeDescription& volume = description.volumes[i];
        if (volume.inside != inside) continue;
        for (Part part : activeParts(volume, loaded.volumes[i])) {
            part.g = volume.g;
            part.majorantScale = description.render.majorantScale;
            medium.parts.emplace_back(std::move(part));
        }
        for (medium::EmissionPart& part : emission(volume, loaded.volumes[i]))
            medium.emission.push_back(std::move(part));
    }
    return medium;
}

std::vector<size_t> volumesOfParts(const SceneDescription& description, const LoadedScene& loaded,
                                   std::string_view inside) {
    std::vector<size_t> volumes;
    for (size_t i = 0; i < description.volumes.size(); ++i)
        if (description.volumes[i].inside == inside)
            volumes.insert(volumes.end(),
                           activeParts(description.volumes[i], loaded.volumes[i]).size(), i);
    return volumes;
}

}  // namespace woodcock::scene
