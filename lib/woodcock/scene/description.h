// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "woodcock/base/affine.h"
#include "woodcock/base/error.h"
#include "woodcock/base/spectrum.h"
#include "woodcock/camera/shutter.h"
#include "woodcock/grid/field_source.h"
#include "woodcock/mesh/faceted_mesh.h"
#include "woodcock/render/approximations.h"
#include "woodcock/scene/light_descriptions.h"

namespace woodcock::scene {

/// A scene as its file says it: plain values, checked for type and range, nothing loaded yet.
/// Lengths are world units, angles degrees, colours scene-linear.

/// A coefficient from a grid of its own: sigma(x) = scale x grid(x).
struct GridCoefficient {
    std::string grid;
    Rgb scale{1.0f};
    bool operator==(const GridCoefficient&) const = default;
};

/// sigma_a and sigma_s of an extinction and an albedo, without the cancellation of sigma_t -
/// sigma_s.
inline std::pair<Rgb, Rgb> splitByAlbedo(Rgb sigmaT, Vec3d albedo) {
    const auto part = [&](auto&& share) {
        return Rgb::map(
            [&](int c) { return static_cast<float>(double{sigmaT[c]} * share(albedo[c])); });
    };
    return {part([](double a) { return 1 - a; }), part([](double a) { return a; })};
}

/// sigma_t = scale x density, sigma_s = albedo x sigma_t.
struct DensityCoefficients {
    std::string density;       ///< grid name; empty: found by its role
    std::optional<Rgb> scale;  ///< absent: chosen for a reasonable optical depth
    Vec3d albedo{1, 1, 1};     ///< double: 1 - albedo is what absorbs, and may be 1e-7
    std::string albedoGrid;    ///< vec3 or scalar grid that multiplies `albedo`; empty: none
    bool operator==(const DensityCoefficients&) const = default;
};

/// sigma_a and sigma_s each from a grid; either may be absent (zero). sigma_a = [..] without a grid
/// in a scene file means "times the density grid" and arrives here with that grid's name (or empty,
/// for the role). Without both, the volume does nothing but emit.
struct SeparateCoefficients {
    std::optional<GridCoefficient> sigmaA, sigmaS;
    bool operator==(const SeparateCoefficients&) const = default;
};

/// A constant medium in an axis-aligned box of object space.
struct HomogeneousBox {
    Box3d box;
    Rgb sigmaA{0.0f}, sigmaS{0.0f};
    bool operator==(const HomogeneousBox&) const = default;
};

/// A medium that glows as a black body of T = scale x grid + offset kelvins would:
/// q = intensity x colour x blackbodyRadiance(T), per world unit (see medium/blackbody.h).
struct BlackbodyDescription {
    std::string temperature;  ///< grid name; empty: found by its role
    double scale = 1, offset = 0;
    double intensity = 1;
    Rgb colour{1.0f};
    bool operator==(const BlackbodyDescription&) const = default;
};

/// How far a grid's background reaches, where it is not 0: as far as the grid's active voxels, or
/// through all of space (inside of a surface, through all that it holds).
enum class Background { Clip, Endless };
/// Their names in scene files, in the same order.
inline const std::array<std::string, 2> backgroundNames{"clip", "endless"};

// The kinds of phase functions; see the classes of the same names in medium/phase.

struct IsotropicPhase {
    bool operator==(const IsotropicPhase&) const = default;
};
struct HenyeyGreensteinPhase {
    float g = 0;
    bool operator==(const HenyeyGreensteinPhase&) const = default;
};
struct TwoLobePhase {
    float g = 0, g2 = 0;
    double mix = 0;  ///< the second's part
    bool operator==(const TwoLobePhase&) const = default;
};
struct RayleighPhase {
    bool operator==(const RayleighPhase&) const = default;
};
struct DrainePhase {
    float g = 0;
    double alpha = 0;
    bool operator==(const DrainePhase&) const = default;
};
struct MiePhase {
    double diameter = 20;  ///< micrometres
    bool operator==(const MiePhase&) const = default;
};
struct FournierForandPhase {
    double ior = 1.33, backscatter = 0.1;
    bool operator==(const FournierForandPhase&) const = default;
};
struct TablePhase {
    std::filesystem::path file;  ///< see medium::readPhaseTable()
    bool normalise = false;
    bool operator==(const TablePhase&) const = default;
};
using PhaseDescription =
    std::variant<IsotropicPhase, HenyeyGreensteinPhase, TwoLobePhase, RayleighPhase, DrainePhase,
                 MiePhase, FournierForandPhase, TablePhase>;

/// What is shown where a sequence of files has none: outside of its first and last file...
enum class OutsideRule { Error, Hold, Black, Repeat, PingPong };
/// ... and between them.
enum class MissingRule { Error, Hold, Black };
/// Their names in scene files, in the same order.
inline const std::array<std::string, 5> outsideNames{"error", "hold", "black", "repeat",
                                                     "ping_pong"};
inline const std::array<std::string, 3> missingNames{"error", "hold", "black"};

/// Of a file whose name holds a frame's number, as withFrame() fills it in: frame `start` shows
/// file number 1 + offset, and so on. See sequenceFile().
struct FileSequence {
    int start = 1, offset = 0;
    OutsideRule outside = OutsideRule::Error;
    MissingRule missing = MissingRule::Error;
    bool operator==(const FileSequence&) const = default;
};

/// How a volume's grids are moved while the shutter is open.
struct VelocityDescription {
    std::string grid;  ///< of vectors, or what three of numbers are named after; empty: by its role
    double scale = 1;
    enum class Unit { Second, Frame } unit = Unit::Second;  ///< distance per ...
    /// Staggered voxels hold their components on faces; or all as if in the middle of voxels.
    enum class Sampling { AsStored, Collocated } sampling = Sampling::AsStored;
    bool operator==(const VelocityDescription&) const = default;

    /// Of a frame, in the unit of the velocities' time, and scaled.
    double timeOfFrame(double fps) const { return scale / (unit == Unit::Second ? fps : 1); }
};

struct VolumeDescription {
    std::string name = {};       ///< for mattes and messages; may be empty
    std::filesystem::path file;  ///< empty for a HomogeneousBox
    FileSequence sequence = {};
    bool black = false;  ///< no key says it: this frame has no file, and nothing is drawn
    std::variant<DensityCoefficients, SeparateCoefficients, HomogeneousBox> coefficients;
    /// q = scale x grid: radiance per world unit. Its grid is that of a GridCoefficient; in a box,
    /// none.
    std::optional<GridCoefficient> emission = {};
    std::optional<BlackbodyDescription> blackbody = {};
    std::string group = {};                      ///< that its emission counts to; empty: none
    float g = 0;                                 ///< mean cosine of Henyey-Greenstein, in (-1, 1)
    std::optional<PhaseDescription> phase = {};  ///< in place of Henyey-Greenstein
    VelocityDescription velocity = {};
    Affine3d worldFromObject;  ///< applied after the grid's own transform
    std::string inside;  ///< name of the closed surface that it fills; empty: it is outside of all
    grid::Storage storage = grid::Storage::Auto;
    /// Absent: Clip, and Endless inside of a surface.
    std::optional<Background> background = {};
    bool repair = false;  ///< NaN, infinite and negative voxels become zero instead of an error
    bool operator==(const VolumeDescription&) const = default;
};

/// A colour, or an image times one.
struct TextureDescription {
    Rgb colour{1.0f};
    std::filesystem::path image = {};
    /// Of OpenColorIO; empty: an ordinary picture where it holds integers, scene-linear where it
    /// holds floats; a weight's numbers are always taken as they are.
    std::string colourSpace = {};
    bool operator==(const TextureDescription&) const = default;
};
struct DiffuseDescription {
    TextureDescription colour{Rgb(0.8f)};
    bool operator==(const DiffuseDescription&) const = default;
};
struct ConductorDescription {
    TextureDescription colour{Rgb(0.9f)};  ///< reflectance at normal incidence, without eta and k
    std::optional<std::pair<Rgb, Rgb>> etaK;
    double roughness = 0;
    bool operator==(const ConductorDescription&) const = default;
};
struct DielectricDescription {
    double ior = 1.5, roughness = 0;
    bool operator==(const DielectricDescription&) const = default;
};
struct InterfaceDescription {
    bool operator==(const InterfaceDescription&) const = default;
};
struct EmissiveDescription {
    TextureDescription radiance{Rgb(1.0f)};
    bool bothSides = false;
    std::string group = {};  ///< that its light counts to; empty: none
    bool operator==(const EmissiveDescription&) const = default;
};
struct MixDescription {
    std::string first, second;  ///< names of materials
    TextureDescription weight{Rgb(0.5f)};
    bool operator==(const MixDescription&) const = default;
};
struct MaterialDescription {
    std::string name;
    std::variant<DiffuseDescription, ConductorDescription, DielectricDescription,
                 InterfaceDescription, EmissiveDescription, MixDescription>
        material;
    bool operator==(const MaterialDescription&) const = default;
};

/// A mesh file; or, of a VDB file, the surface of a level set.
struct MeshShape {
    std::filesystem::path file;
    std::string levelSet;  ///< grid of a VDB file; empty: its only level set
    bool operator==(const MeshShape&) const = default;
};
struct SphereShape {
    Vec3d centre;
    double radius = 1;
    bool operator==(const SphereShape&) const = default;
};
struct BoxShape {
    Box3d box;
    bool operator==(const BoxShape&) const = default;
};
/// In y = 0, facing +y.
struct DiskShape {
    double radius = 1;
    bool operator==(const DiskShape&) const = default;
};
/// y = 0, facing +y; without a size infinite, and what is below is inside.
struct PlaneShape {
    std::optional<std::array<double, 2>> size;  ///< along x and z
    bool operator==(const PlaneShape&) const = default;
};
/// See latheMesh().
struct LatheShape {
    std::vector<std::array<double, 2>> profile;  ///< radius, height
    int segments = 96;
    bool operator==(const LatheShape&) const = default;
};

/// See facetedMesh().
struct FacetShape {
    std::vector<mesh::FacetRing> rings;
    bool operator==(const FacetShape&) const = default;
};

/// What a closed surface of glass, or an interface, holds.
struct InteriorDescription {
    Rgb sigmaA{0.0f}, sigmaS{0.0f};  ///< per world unit
    float g = 0;
    std::optional<PhaseDescription> phase = {};  ///< in place of Henyey-Greenstein with g
    Rgb emission{0.0f};                          ///< radiance per world unit
    std::string group = {};                      ///< that its emission counts to; empty: none
    bool operator==(const InteriorDescription&) const = default;
};

struct SurfaceDescription {
    std::string name;  ///< may be empty
    std::variant<MeshShape, SphereShape, BoxShape, DiskShape, PlaneShape, LatheShape, FacetShape>
        shape;
    std::string material;  ///< name; empty: diffuse grey of 0.8
    /// Degrees: edges less sharp are smooth, so 0 is flat. Absent: as a mesh file says; a lathe's
    /// and a level set's at 60.
    std::optional<double> smooth;
    Affine3d worldFromObject;
    /// Each places the surface once more, before worldFromObject; empty: once.
    std::vector<Affine3d> instances;
    std::filesystem::path instanceFile;  ///< further ones, a line each
    std::optional<InteriorDescription> interior;
    int priority = 0;
    bool holdout = false, shadowCatcher = false, matte = false, cameraVisible = true;
    bool operator==(const SurfaceDescription&) const = default;
};

/// A camera at `eye` that looks at `target`, with `up` upwards in the picture.
struct LookAt {
    Vec3d eye, target;
    Vec3d up{0, 1, 0};
    bool operator==(const LookAt&) const = default;
};

/// Where a camera stands; or the world from the camera, a rigid motion, looking along -z with +y
/// up.
using CameraPose = std::variant<LookAt, Affine3d>;

/// What is given of a pose of which the rest is to be chosen.
struct PartialPose {
    std::optional<Vec3d> eye, target, up;
    bool operator==(const PartialPose&) const = default;
};

struct CameraDescription {
    enum class Kind { Perspective, Orthographic } kind = Kind::Perspective;
    std::optional<CameraPose> pose;  ///< absent: chosen to frame the volumes
    double fovY = 40;                ///< full vertical angle, degrees (perspective)
    std::optional<double> height;   ///< world units from bottom to top (orthographic); absent: fits
    PartialPose given = {};         ///< where `pose` is absent
    std::array<double, 2> shift{};  ///< of the film, in heights of the picture: right, up
    /// Degrees by which completeScene() turns the camera about the up axis, around what it looks
    /// at; a positive angle takes it to its right. A camera that is chosen frames the volumes then
    /// from all sides.
    std::optional<double> orbit = {};
    camera::Shutter shutter = {};
    bool operator==(const CameraDescription&) const = default;
};

/// Whether finished pictures are denoised; see denoise::Denoiser.
enum class Denoise { Never, IfInstalled, Always };

struct RenderDescription {
    int width = 960, height = 540;
    double fps = 24;  ///< frames per second, of what moves by so much in a second
    int spp = 64;
    std::uint64_t seed = 0;
    std::optional<int> maxScatterings;  ///< absent: unlimited
    std::optional<int> maxBounces;      ///< off surfaces; absent: unlimited
    render::Approximations approximations;
    grid::Storage storage = grid::Storage::Auto;    ///< of volumes that say nothing
    grid::Lookup lookup = grid::Lookup::Trilinear;  ///< Nearest is biased
    /// Biased: grids are coarsened by powers of two as long as their voxels, where they are next to
    /// the camera, stay below so many pixels; 0: never.
    double levelOfDetail = 0;
    /// Samples go where the error is largest; absent: as false. Told apart, as what a scene says is
    /// written again.
    std::optional<bool> adaptive;
    Denoise denoise = Denoise::Never;
    double timeLimit = 0;      ///< seconds; 0: none
    double noise = 0;          ///< Film::noise() to stop at; 0: none
    double majorantScale = 1;  ///< 1 to 1000; loosens the majorants: for experiments
    bool operator==(const RenderDescription&) const = default;
};

struct OutputDescription {
    std::vector<std::filesystem::path> files;  ///< by extension: exr, png, jpg
    std::vector<std::string> layers;           ///< see image::parseLayerName()
    std::vector<std::string> mattes;           ///< of image::matteKinds()
    std::filesystem::path mattesFile;          ///< an EXR for them alone; empty: they go to all
    std::filesystem::path deep;                ///< an EXR of deep pixels; empty: none
    double deepError = 0.01;                   ///< see render::DeepBins
    bool half = false;                         ///< EXR colour in half instead of float
    bool multipart = false;                    ///< EXR layers in parts of their own
    std::string display, view, look;           ///< OpenColorIO names; empty: the config's default
    double exposure = 0;                       ///< stops, before the display transform
    bool operator==(const OutputDescription&) const = default;
};

/// Where the values of a scene were written, for messages: "volume[0].scale" -> "scene.toml:4:9",
/// or the "--set ..." or option that gave it. Values that nobody wrote are not in it.
using Places = std::map<std::string, std::string, std::less<>>;

/// Of `value`; empty where nobody wrote it.
inline std::string findPlace(const Places& places, std::string_view value) {
    const auto found = places.find(value);
    return found == places.end() ? std::string() : found->second;
}

/// What `action` returns; its errors gain the place before them.
template <class Action>
decltype(auto) inPlace(const std::string& place, Action action) {
    try {
        return action();
    } catch (const Error& e) {
        if (place.empty()) throw;
        throw Error(e.kind(), fmt::format("{}: {}", place, e.what()));
    }
}

/// What a scene keeps of an animated value; see animation.h.
struct AnimatedValue {
    std::string table;  ///< "volume[0]"
    std::string key;    ///< of that table: "transform"; or of a table in there: "colour.times"
    std::string value;  ///< TOML, with its curves; without any where it only stands beside one
    bool operator==(const AnimatedValue&) const = default;
};

/// What is absent (lights, the camera's pose, a density's name and scale) is chosen by
/// completeScene() of scene/defaults.h, which says what it chose.
struct SceneDescription {
    /// Whether velocities have a say in the picture.
    bool needsVelocities(const VolumeDescription& volume) const {
        return camera.shutter != camera::Shutter{} && volume.velocity.scale != 0;
    }

    std::vector<VolumeDescription> volumes;
    std::vector<LightDescription> lights;
    /// Overrides of lights ("light[0].azimuth=200") where there are none: of those that are chosen.
    std::vector<std::string> lightChanges;
    std::vector<MaterialDescription> materials;
    std::vector<SurfaceDescription> surfaces;
    CameraDescription camera;
    RenderDescription render;
    OutputDescription output;
    std::filesystem::path ocio;  ///< OpenColorIO config of this scene; empty: $OCIO, then built-in
    std::vector<AnimatedValue> animation;  ///< all else is as it is at `frame`
    double frame = 0;
    Places places;  ///< of all its values
    bool operator==(const SceneDescription&) const = default;
};

}  // namespace woodcock::scene
