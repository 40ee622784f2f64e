// SPDX-License-Identifier: Apache-2.0
#include "woodcock/base/frame_names.h"
#include "woodcock/base/frame_range.h"
#include "woodcock/scene/keys/sections.h"
#include "woodcock/scene/keys/values.h"

namespace woodcock::scene {
namespace {

using V = VolumeDescription;
using Density = DensityCoefficients;
using Separate = SeparateCoefficients;
using Homogeneous = HomogeneousBox;
using Base = const std::filesystem::path&;

const std::string perDensity = "x density, 1/unit";

/// A colour, or a grid of its own. A colour multiplies the volume's density grid.
Value<GridCoefficient> gridCoefficient() {
    return {"colour >= 0, or `{ grid, scale }`",
            {"{ grid = \"soot\", scale = 0.5 }"},
            [](const TomlValue& v, Base base) {
                if (v.isTable()) return nested<GridCoefficient>().read(v, base);
                return GridCoefficient{{}, v.colour(notNegative)};
            },
            [](const GridCoefficient& c, const SceneWriter& out) {
                return c.grid.empty() ? tomlColour(c.scale) : inlineTable(c, out);
            },
            {},
            true};
}

/// The grid says itself what it is times.
Key<V> uncommentedForGrids(Key<V> key, std::string boxComment = {}) {
    key.write = [=, write = key.write](const V& v, const SceneWriter& out) {
        auto written = write(v, out);
        if (written && written->value.starts_with("{")) written->comment.clear();
        if (written && v.file.empty() && !boxComment.empty()) written->comment = boxComment;
        return written;
    };
    return key;
}

Key<V> separateKey(std::string name, std::string doc,
                   std::optional<GridCoefficient> Separate::*member) {
    return uncommentedForGrids(keyOfKind<Separate>({.name = std::move(name),
                                                    .doc = std::move(doc),
                                                    .fallback = "0",
                                                    .comment = perDensity,
                                                    .example = "[0.1, 0.2, 0.3]"},
                                                   &V::coefficients, member, gridCoefficient()));
}

/// A volume of a file that has neither coefficient says so by a sigma_a of 0.
Key<V> absorption() {
    Key<V> key = separateKey(
        "sigma_a",
        "instead of `scale` and `albedo`: absorption per world unit. A colour multiplies the "
        "density grid",
        &Separate::sigmaA);
    key.write = [write = key.write](const V& v, const SceneWriter& out) {
        const auto* c = std::get_if<Separate>(&v.coefficients);
        if (c && !c->sigmaA && !c->sigmaS) return std::optional(Written{"0", "it only emits"});
        return write(v, out);
    };
    return key;
}

/// A constant coefficient of a box; the guide's line is that of a file's.
Key<V> boxCoefficient(std::string name, Rgb Homogeneous::*member) {
    return keyOfKind<Homogeneous>({.name = std::move(name), .comment = "1/unit", .always = true},
                                  &V::coefficients, member, colour(notNegative));
}

Key<V> boxOfVolume() {
    return keyOfKind<Homogeneous>(
        {.name = "box",
         .doc = "instead of a file: a box that is filled evenly. It takes `sigma_a` and `sigma_s` "
                "(colours, per world unit) or `scale` and `albedo`, and `emission` (a colour)",
         .type = "`{ min = [x, y, z], max = [x, y, z] }`",
         .fallback = "none",
         .beside = "box = { min = [0, 0, 0], max = [1, 1, 1] }\nsigma_a = 1",
         .always = true},
        &V::coefficients, &Homogeneous::box, bounds());
}

std::vector<Key<V>> densityKeys() {
    return {
        keyOfKind<Density>(
            {.name = "density",
             .doc = "name of a scalar grid, or of a vec3 grid, whose three numbers are the "
                    "densities of red, green and blue. Where several grids share a name, `name[0]` "
                    "is the first and `name[1]` the second",
             .fallback =
                 "*chosen*: `density` or `smoke` in any case, or the finest of its levels "
                 "of detail (`density_level_0`), else the only scalar grid that may be one"},
            &V::coefficients, &Density::density, text()),
        keyOfKind<Density>({.name = "scale",
                            .doc = "extinction per world unit where the density is 1. sigma_t = "
                                   "scale x density",
                            .fallback = "*chosen*: a typical ray has an optical depth of 20",
                            .comment = "sigma_t = scale x density, 1/unit"},
                           &V::coefficients, &Density::scale, colour(notNegative)),
        keyOfKind<Density>({.name = "albedo", .doc = "sigma_s = albedo x sigma_t"},
                           &V::coefficients, &Density::albedo, exactColour(zeroToOne)),
        keyOfKind<Density>({.name = "albedo_grid",
                            .doc = "name of a vec3 or scalar grid, in 0..1, that multiplies "
                                   "`albedo`",
                            .fallback = "none"},
                           &V::coefficients, &Density::albedoGrid, text()),
    };
}

template <class Rule>
Value<Rule> sequenceRule(std::string what, std::vector<std::pair<Rule, std::string>> known) {
    // As Blender has them.
    known.emplace_back(Rule::Black, "clip");
    known.emplace_back(Rule::Hold, "extend");
    return choice(std::move(what), std::move(known));
}

template <class Rule, class Names>
std::vector<std::pair<Rule, std::string>> namedRules(const Names& names) {
    std::vector<std::pair<Rule, std::string>> known;
    for (size_t i = 0; i < names.size(); ++i) known.emplace_back(static_cast<Rule>(i), names[i]);
    return known;
}

std::vector<Key<V>> sequenceKeys() {
    const std::string sequence = "file = \"a.####.vdb\"";
    return {
        key({.name = "frame_start",
             .doc = "of a sequence, `file = \"smoke.####.vdb\"`: the frame that shows file number "
                    "1 + `offset`",
             .type = "integer",
             .beside = sequence},
            &V::sequence, &FileSequence::start, integer(-largestFrame, largestFrame)),
        key({.name = "offset",
             .doc = "of a sequence: frame n shows the file of number n - `frame_start` + 1 + "
                    "`offset`",
             .type = "integer",
             .beside = sequence},
            &V::sequence, &FileSequence::offset, integer(-largestFrame, largestFrame)),
        key({.name = "outside",
             .doc = "of a sequence: what is shown before its first and behind its last file, see "
                    "\"Frames\". `\"clip\"` is `\"black\"`, and `\"extend\"` is `\"hold\"`",
             .beside = sequence},
            &V::sequence, &FileSequence::outside,
            sequenceRule("rule", namedRules<OutsideRule>(outsideNames))),
        key({.name = "missing",
             .doc = "of a sequence: what is shown where a file is missing between others",
             .beside = sequence},
            &V::sequence, &FileSequence::missing,
            sequenceRule("rule", namedRules<MissingRule>(missingNames))),
    };
}

std::vector<Key<V>> coefficientKeys() {
    return joined(
        std::vector{key({.name = "name",
                         .doc = "for mattes, see \"Mattes\"",
                         .fallback = "that of the file, without its extension and the frame's "
                                     "number",
                         .inDigest = false},
                        &V::name, text()),
                    key({.name = "file",
                         .doc = "an OpenVDB or NanoVDB file",
                         .fallback = "that or `box` must be given"},
                        &V::file, path()),
                    boxOfVolume()},
        sequenceKeys(), densityKeys(),
        std::vector{
            absorption(), separateKey("sigma_s", "the same for scattering", &Separate::sigmaS),
            boxCoefficient("sigma_a", &Homogeneous::sigmaA),
            boxCoefficient("sigma_s", &Homogeneous::sigmaS),
            uncommentedForGrids(
                key({.name = "emission",
                     .doc = "radiance per world unit of length. A colour multiplies the "
                            "density grid. The volume need not absorb",
                     .comment = "x density, radiance per unit"},
                    &V::emission, gridCoefficient()),
                "radiance per unit"),
            key({.name = "blackbody",
                 .doc = "fire, see below",
                 .type = "`{ temperature = \"name\", scale = 1, offset = 0, intensity = 1, "
                         "colour = 1 }`",
                 .comment = "scale and offset make kelvins",
                 .example = "{ scale = 700 }"},
                &V::blackbody, nested<BlackbodyDescription>()),
            key({.name = "group",
                 .doc = "the light group that its emission counts to; see \"Light groups\""},
                &V::group, groupName())});
}

std::vector<Key<V>> velocityKeys() {
    using Velocity = VelocityDescription;
    return {
        key({.name = "velocity",
             .doc = "name of the vector grid by which all grids of the volume move while the "
                    "shutter is open, or what three scalar ones are named after (`vel` of `vel.x`, "
                    "`vel.y`, `vel.z`). See \"Motion blur\"",
             .fallback = "`vel`, `v` or `velocity` in any case, one grid or three; without any, "
                         "the volume stands still"},
            &V::velocity, &Velocity::grid, text()),
        key({.name = "velocity_scale",
             .doc = "multiplies the velocities. 0: the volume stands still"},
            &V::velocity, &Velocity::scale, number({-1e6, 1e6})),
        key({.name = "velocity_unit",
             .doc = "the time in which a velocity of 1 moves by one world unit. Seconds become "
                    "frames by `[render] fps`"},
            &V::velocity, &Velocity::unit,
            choice<Velocity::Unit>("velocity unit", {{Velocity::Unit::Second, "second"},
                                                     {Velocity::Unit::Frame, "frame"}})),
        key({.name = "velocity_sampling",
             .doc = "`\"collocated\"` reads staggered grids as if their components lay in the "
                    "middle of voxels, half a voxel aside, as Cycles and MoonRay do"},
            &V::velocity, &Velocity::sampling,
            choice<Velocity::Sampling>("velocity sampling",
                                       {{Velocity::Sampling::AsStored, "stored"},
                                        {Velocity::Sampling::Collocated, "collocated"}})),
    };
}

std::vector<Key<V>> fieldKeys() {
    return {
        key({.name = "inside",
             .doc = "name of a `[[surface]]` that it fills. Outside of it the volume does not "
                    "exist. The surface must stand in one place and let light in (see below)",
             .fallback = "none: it is outside of all surfaces",
             .example = "\"ball\"",
             .beside = "file = \"a.vdb\"\n[[surface]]\nname = \"ball\"\nsphere = {}\n"
                       "material = \"air\"\n[[material]]\nname = \"air\"\ntype = \"interface\""},
            &V::inside, text()),
        key({.name = "storage",
             .doc = "how voxels are kept in memory. `\"auto\"` is half where that is exact, and "
                    "float elsewhere. `\"half\"`, `\"fixed16\"` and `\"fixed8\"` are biased; see "
                    "\"Fields\""},
            &V::storage, storage()),
        key({.name = "background",
             .doc = "for a grid whose background is not 0. `\"clip\"` ends the medium one voxel "
                    "around the grid's active voxels. `\"endless\"` fills all of space with the "
                    "background; see below",
             .fallback = "`\"clip\"`; `\"endless\"` with `inside`"},
            &V::background, choiceOf<Background>("background", backgroundNames)),
        key({.name = "repair",
             .doc = "NaN, infinite and negative voxels become 0, and albedos above 1 become 1, "
                    "with a note. Otherwise they are errors"},
            &V::repair, flag()),
    };
}

std::vector<Key<V>> volumeKeys() {
    return joined(
        coefficientKeys(),
        std::vector{
            key({.name = "g",
                 .doc = "mean cosine of scattering (Henyey-Greenstein): 0 all around, "
                        "above forwards, below backwards",
                 .fallback = "0; 0.6 where a VDB is rendered without a scene file",
                 .comment = "mean cosine"},
                &V::g, meanCosine()),
            key({.name = "phase", .doc = "instead of `g`: another phase function, see below"},
                &V::phase, phaseFunction())},
        placementKeys(&V::worldFromObject, "volume",
                      "`{ translate, rotate, scale }`, after the grid's own transform. sigma stays "
                      "per *world* unit, so a volume made larger is denser to look through"),
        velocityKeys(), fieldKeys());
}

void checkBox(const TomlTable& table, V& volume, Homogeneous& box) {
    for (const char* key : {"density", "albedo_grid", "blackbody", "velocity", "velocity_scale",
                            "velocity_unit", "velocity_sampling", "storage", "background", "repair",
                            "frame_start", "offset", "outside", "missing"})
        if (const auto v = table.find(key))
            throw v->error("needs a file: a box holds constant coefficients and no grids");
    if (const auto v = table.find("emission"); v && !volume.emission->grid.empty())
        throw v->error("is a table; expected a number or [r, g, b]");
    if (!table.has("scale") && !table.has("albedo") && !table.has("sigma_a") &&
        !table.has("sigma_s") && !table.has("emission"))
        throw table.error(
            "is a box of nothing; give sigma_a and sigma_s, or scale and albedo, or emission");
    if (const auto sigma = readScaleAndAlbedo(table)) std::tie(box.sigmaA, box.sigmaS) = *sigma;
}

/// Colours are times the density grid.
void nameDensity(const TomlTable& table, V& volume) {
    const auto density = table.find("density");
    const std::string name = density ? density->text() : std::string();
    const auto fill = [&](std::optional<GridCoefficient>& c) {
        if (c && c->grid.empty()) c->grid = name;
    };
    fill(volume.emission);
    auto* separate = std::get_if<Separate>(&volume.coefficients);
    if (!separate) return;
    // A fire without smoke needs no density grid.
    for (auto* sigma : {&separate->sigmaA, &separate->sigmaS}) {
        if ((volume.emission || volume.blackbody) && *sigma && (*sigma)->scale == Rgb(0))
            sigma->reset();
        fill(*sigma);
    }
}

/// One frame's file in place of a sequence, by --set, leaves its keys without a meaning.
void checkSequence(const TomlTable& table, V& volume) {
    if (namesFrame(volume.file.string())) return;
    volume.sequence = {};
    if (table.need("file", "").place().starts_with(overrideMark)) return;
    for (const char* key : {"frame_start", "offset", "outside", "missing"})
        if (const auto v = table.find(key))
            throw v->error(
                "is for a sequence, and file names none: write \"smoke.####.vdb\", with #### where "
                "a frame's number goes");
}

void checkVolume(const TomlTable& table, V& volume) {
    if (auto* box = std::get_if<Homogeneous>(&volume.coefficients)) {
        checkBox(table, volume, *box);
    } else {
        if (volume.file.empty())
            throw table.error(
                "has neither file nor box; give file = \"smoke.vdb\" or "
                "box = {{ min = [0, 0, 0], max = [1, 1, 1] }}");
        checkSequence(table, volume);
        nameDensity(table, volume);
    }
}

std::vector<Exclusion> exclusions() {
    std::vector<Exclusion> all = coefficientExclusions();
    all.push_back({"box", "file", "a volume is either read from a file or a homogeneous box"});
    all.push_back({"transform", "matrix", "both place the volume"});
    all.push_back({"phase", "g", "both say how the volume scatters"});
    return all;
}

}  // namespace

std::vector<Exclusion> coefficientExclusions() {
    std::vector<Exclusion> all;
    for (const char* sigma : {"sigma_a", "sigma_s"})
        for (const char* other : {"scale", "albedo", "albedo_grid"})
            all.push_back({sigma, other,
                           "sigma_a and sigma_s say what scale and albedo say (sigma_t = scale x "
                           "density, sigma_s = albedo x sigma_t)"});
    return all;
}

std::optional<std::pair<Rgb, Rgb>> readScaleAndAlbedo(const TomlTable& table) {
    const auto scale = table.find("scale"), albedo = table.find("albedo");
    if (albedo && !scale) throw albedo->error("needs a scale: here sigma_t = scale");
    if (!scale) return std::nullopt;
    return splitByAlbedo(scale->colour(notNegative),
                         albedo ? albedo->exactColour(zeroToOne) : Vec3d{1, 1, 1});
}

template <>
const KeyTable<GridCoefficient>& keysOf() {
    static const KeyTable<GridCoefficient> table{
        .id = "volume.coefficient",
        .keys = {key({.name = "grid",
                      .doc = "its name",
                      .example = "\"absorption\"",
                      .required = true,
                      .always = true},
                     &GridCoefficient::grid, text()),
                 key({.name = "scale", .doc = "multiplies the grid", .always = true},
                     &GridCoefficient::scale, colour(notNegative))},
        .outer = "[[volume]]\nfile = \"a.vdb\"\n[volume.sigma_a]\n",
        .least = "grid = \"soot\"",
        .path = "volume[0].sigma_a"};
    return table;
}

template <>
const KeyTable<BlackbodyDescription>& keysOf() {
    using B = BlackbodyDescription;
    static const KeyTable<B> table{
        .id = "volume.blackbody",
        .keys = {key({.name = "temperature",
                      .doc = "name of a grid",
                      .fallback = "`temperature`, in any case"},
                     &B::temperature, text()),
                 key({.name = "scale",
                      .doc = "kelvins where the grid is 1: T = scale x grid + offset",
                      .always = true},
                     &B::scale, number()),
                 key({.name = "offset", .doc = "kelvins", .always = true}, &B::offset, number()),
                 key({.name = "intensity", .doc = "multiplies the emission", .always = true},
                     &B::intensity, number(notNegative)),
                 key({.name = "colour", .doc = "multiplies the emission", .always = true},
                     &B::colour, colour(notNegative))},
        .outer = "[[volume]]\nfile = \"a.vdb\"\n[volume.blackbody]\n",
        .path = "volume[0].blackbody"};
    return table;
}

template <>
const KeyTable<V>& keysOf() {
    static const KeyTable<V> table{.id = "volume",
                                   .where = "[[volume]]",
                                   .exclusions = exclusions(),
                                   .keys = volumeKeys(),
                                   .check = checkVolume,
                                   .outer = "[[volume]]\n",
                                   .least = "file = \"a.vdb\"",
                                   .path = "volume[0]"};
    return table;
}

VolumeDescription readVolume(const TomlTable& table, Base base) {
    V volume;
    if (table.has("box"))
        volume.coefficients = Homogeneous();
    else if (table.has("sigma_a") || table.has("sigma_s"))
        volume.coefficients = Separate();
    readKeys(table, volume, base);
    return volume;
}

}  // namespace woodcock::scene
