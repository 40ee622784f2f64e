// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "woodcock/base/vec.h"
#include "woodcock/camera/camera.h"
#include "woodcock/light/mesh_light.h"
#include "woodcock/medium/medium.h"
#include "woodcock/render/scene.h"
#include "woodcock/render/session.h"
#include "woodcock/scene/description.h"
#include "woodcock/scene/load.h"
#include "woodcock/scene/movements.h"
#include "woodcock/surface/surface_set.h"

namespace woodcock::image {
struct RenderMetadata;
}

namespace woodcock::scene {

/// The scene that a render draws, from a complete description (see completeScene) and what was
/// loaded for it. Adds to `notes` what the user should know. Throws Error{Usage} where the
/// description is not complete.
render::Scene buildScene(const SceneDescription& description, LoadedScene loaded,
                         std::vector<std::string>* notes = nullptr);

/// What the session is told of a scene file's [render]: all of the image, by all cores.
render::RenderSettings renderSettings(const RenderDescription& render);

Affine3d worldFromCamera(const CameraPose& pose);

/// The scene's camera, where it is complete; throws Error{Usage} where it is not.
camera::Camera buildCamera(const CameraDescription& description);

/// Says in the header of a picture where the camera of a complete scene stands, and how many frames
/// a second has, where the scene says so or its shutter opens.
void describeShot(const SceneDescription& scene, image::RenderMetadata& metadata);

/// The rotation that takes an environment image's up, +y, and centre, -z, to where they are.
Affine3d worldFromLight(const EnvironmentDescription& environment);

/// What a graded environment looks like, as light::gradedImage() has it.
std::vector<float> gradedImageOf(const EnvironmentDescription& environment);

// What is known of the light before a scene is built.

/// Whether a volume, a surface or what a surface holds emits light.
bool anyVolumeOrSurfaceGlows(const SceneDescription& scene);

/// Whether light may come from where nothing covers: what glows, and lights that are seen.
bool anythingGlows(const SceneDescription& scene);

/// Whether no environment is visible to camera rays; lights that are still to be chosen count.
bool environmentIsHidden(const SceneDescription& scene);

// The parts of a scene.

/// What may change of a light within the shutter beside its place; nothing of those that are
/// infinitely far away.
light::LightForm formOf(const LightDescription& light);

/// The volumes that fill the surface of this name; of an empty name, those that fill none.
medium::Medium buildMedium(const SceneDescription& description, const LoadedScene& loaded,
                           const Movements& movements, std::string_view inside);

/// The volume that each part of that medium comes from.
std::vector<size_t> volumesOfParts(const SceneDescription& description, const LoadedScene& loaded,
                                   std::string_view inside);

/// How far each volume of that medium moves while the shutter is open, and what that costs.
std::vector<std::string> motionNotes(const SceneDescription& description, const LoadedScene& loaded,
                                     const medium::Medium& medium, std::string_view inside);

/// Biased: halves the resolution of each grid (see coarsened()) as often as its voxels, by their
/// longest edge, stay at most description.render.levelOfDetail pixels wide where the box of what it
/// holds is next to the camera. Albedos are weighted by density where both grids have one
/// transform. What surfaces magnify is not thought of. Returns a note for each grid that changed.
std::vector<std::string> coarsenForCamera(const SceneDescription& description,
                                          const camera::Camera& camera, LoadedScene& loaded);

/// The phase function of a volume or an interior: `phase`, else Henyey-Greenstein with `g`. `table`
/// is what was loaded for it.
medium::PhaseFunction buildPhase(float g, const std::optional<PhaseDescription>& phase,
                                 const std::optional<medium::PhaseTable>& table);

struct BuiltSurfaces {
    std::shared_ptr<const surface::SurfaceSet> set;      ///< null: none
    std::vector<medium::Medium> interiorMedia;           ///< as of Scene
    std::vector<std::vector<std::uint32_t>> partOwners;  ///< of each, as of Scene
    std::vector<light::MeshLight::Triangle> emitters;
    light::MeshLight::RadianceAt radianceAt;  ///< of the emitters; empty where none varies
    std::vector<light::MeshLight::Moving> movingEmitters;
};

/// The surfaces of a scene, what they hold, and the triangles that emit light: those of all
/// emissive instances, in the order of instances and of their triangles. Throws Error{Input} on
/// transforms that flatten a surface, and where there are more emitters than can be counted.
BuiltSurfaces buildSurfaces(const SceneDescription& description, const LoadedScene& loaded,
                            const Movements& movements);

}  // namespace woodcock::scene
