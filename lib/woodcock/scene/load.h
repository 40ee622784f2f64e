// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "woodcock/base/affine.h"
#include "woodcock/grid/field.h"
#include "woodcock/light/environment_map.h"
#include "woodcock/light/ies_profile.h"
#include "woodcock/medium/phase/phase_table.h"
#include "woodcock/scene/description.h"
#include "woodcock/scene/load_cache.h"
#include "woodcock/scene/load_surfaces.h"
#include "woodcock/surface/texture.h"

namespace woodcock::grid {
class Velocity;
}

namespace woodcock::scene {

/// A grid in memory; several volumes may share its field.
struct LoadedField {
    std::shared_ptr<const grid::Field> field;
    Affine3d objectFromIndex;  ///< the grid's own transform
    std::string grid;          ///< its name in the file

    explicit operator bool() const { return field != nullptr; }
};

/// What a volume's description names; the rest is null.
struct LoadedVolume {
    LoadedField density, albedo;  ///< of DensityCoefficients
    LoadedField emission;         ///< of the emission, where it has a grid
    LoadedField blackbody;        ///< radiance of the temperature grid, as blackbodySource() says
    float ambient = 0;            ///< the temperature grid's background, where nothing glows
    LoadedField sigmaA, sigmaS;   ///< of SeparateCoefficients; one field where one grid is both
    /// Grids of the file that usually mean fire, and the colour of smoke (of three channels),
    /// whether or not they are asked for; empty: none.
    std::string temperatures, flames, colours;
    /// The largest values of `temperatures` and `flames`, where they are of use: the scene comes
    /// from the VDB file alone, and the grid is small enough to be looked through; 0: unknown.
    float hottest = 0, brightest = 0;
    /// The same of `colours`, whose values are sound: finite, and nowhere below 0.
    float palest = 0;
    /// By which the volume moves; null: it stands still, or the shutter opens for no time.
    std::shared_ptr<const grid::Velocity> velocity;
    std::string velocities;  ///< their grids' names; of a volume that stands still, of the first
                             ///< grid of the file that means them and is not used; or empty
    std::optional<medium::PhaseTable> phase;  ///< of a TablePhase
    UpAxis up = UpAxis::Y;  ///< Z where the file's metadata say that Blender wrote it
};

/// What a light reads from disk; most read nothing.
struct LoadedLight {
    light::EnvironmentMap map = {};                         ///< of an environment
    std::shared_ptr<const light::IesProfile> profile = {};  ///< of a point
};

/// All that a scene reads from disk.
struct LoadedScene {
    std::vector<LoadedVolume> volumes;    ///< one for each volume of the description
    std::vector<LoadedLight> lights;      ///< one for each light
    std::vector<LoadedSurface> surfaces;  ///< one for each surface
    /// One for each surface: of a TablePhase of its interior.
    std::vector<std::optional<medium::PhaseTable>> interiorPhases;
    std::vector<std::shared_ptr<const surface::TextureImage>>
        textures;                    ///< one for each material, or null
    std::vector<std::string> notes;  ///< what the user should know
};

/// Reads the grids and meshes that the scene uses, each once, and its images; what `cache` knows
/// from the scene before is taken from there, and its notes are not repeated. Throws Error{Input}
/// that names the place in the scene, the file and the grid.
LoadedScene loadScene(const SceneDescription& scene, LoadCache* cache = nullptr);

/// What completeScene() chose and loadScene() could not know of: images of lights, as --set asked
/// for them, grids that glow and grids of colours. Throws Error{Input}.
void loadChosen(const SceneDescription& scene, LoadedScene& loaded, LoadCache* cache = nullptr);

}  // namespace woodcock::scene
