// SPDX-License-Identifier: Apache-2.0
#include "woodcock/scene/keys/sections.h"
#include "woodcock/scene/keys/values.h"

namespace woodcock::scene {
namespace {

using Texture = TextureDescription;
using Diffuse = DiffuseDescription;
using Conductor = ConductorDescription;
using Dielectric = DielectricDescription;
using Emissive = EmissiveDescription;
using Mix = MixDescription;

/// Beyond this no ray gets in or out, but by the last digits of a cosine.
constexpr double largestIor = 100;

const std::string outerOfMaterial = "[[surface]]\nsphere = {}\n[[material]]\nname = \"m\"\n";

/// number | [r, g, b] | { image, colour_space, times }. `range` is of the colour alone; what an
/// image holds is known when it is loaded.
Value<Texture> texture(NumberRange range) {
    Value<Rgb> colours = colour(range);
    colours.type.replace(0, std::string("colour").size(), "texture");
    return {colours.type,
            {"{ image = \"a $$5.png\", colour_space = \"srgb\", times = 2 }"},
            [=](const TomlValue& v, const std::filesystem::path& base) {
                if (v.isTable()) return nested<Texture>().read(v, base);
                return Texture{v.colour(range), {}, {}};
            },
            [](const Texture& t, const SceneWriter& out) {
                return t.image.empty() ? tomlColour(t.colour) : inlineTable(t, out);
            },
            nested<Texture>().files,
            true};
}

template <class M>
Key<M> roughness(double M::*member) {
    return key({.name = "roughness",
                .doc = "0 is polished; above it is GGX with alpha = roughness^2. No light is lost "
                       "between facets"},
               member, number(zeroToOne));
}

/// A key of the pair `etaK`, which is there as soon as one of them is read.
Key<Conductor> refraction(KeyInfo info, Rgb std::pair<Rgb, Rgb>::*part, NumberRange range) {
    info.fallback = "none";
    info.always = true;
    info.example = "[3, 2, 1]";
    info.beside = "eta = [0.1, 0.4, 1.4]\nk = [4, 2.5, 2]";
    return keyAt<Conductor, Rgb>(
        std::move(info),
        [=](auto& m) {
            if constexpr (!std::is_const_v<std::remove_reference_t<decltype(m)>>)
                if (!m.etaK) m.etaK.emplace();
            return m.etaK ? &((*m.etaK).*part) : nullptr;
        },
        colour(range));
}

Key<Conductor> conductorColour() {
    Key<Conductor> k = key({.name = "colour",
                            .doc = "its reflectance face on. `eta` and `k` may stand instead",
                            .always = true},
                           &Conductor::colour, texture(zeroToOne));
    k.write = [write = k.write](const Conductor& m, const SceneWriter& out) {
        return m.etaK ? std::nullopt : write(m, out);
    };
    return k;
}

void checkConductor(const TomlTable& table, Conductor&) {
    const auto eta = table.find("eta"), k = table.find("k");
    if (eta && !k) throw eta->error("needs a k beside it, such as k = [3.9, 2.5, 2.1]");
    if (k && !eta) throw k->error("needs an eta beside it, such as eta = [0.14, 0.38, 1.4]");
}

Key<Dielectric> belowOne() {
    Key<Dielectric> k = otherWay<Dielectric>({.name = "ior_below_one",
                                              .doc = "allows an `ior` below 1",
                                              .type = flag().type,
                                              .fallback = "false",
                                              .example = "true",
                                              .beside = "ior = 0.75",
                                              .permission = true});
    k.read = [](const TomlValue& v, Dielectric&, const std::filesystem::path&) { v.flag(); };
    k.write = [](const Dielectric& m, const SceneWriter&) {
        return m.ior < 1 ? std::optional(Written{"true"}) : std::nullopt;
    };
    return k;
}

void checkDielectric(const TomlTable& table, Dielectric& m) {
    const auto permission = table.find("ior_below_one");
    if (m.ior < 1 && !(permission && permission->flag()))
        throw table.find("ior")->error(
            "is {}: inside, light would be faster than in vacuum. A bubble of air in glass is "
            "a surface of its own, with ior = 1 and a higher priority; if it is meant all the "
            "same, say ior_below_one = true",
            m.ior);
}

}  // namespace

template <>
const KeyTable<Texture>& keysOf() {
    static const KeyTable<Texture> table{
        .id = "texture",
        .keys = {key({.name = "image",
                      .doc = "an image; see \"Files in and out\"",
                      .example = "\"wood.png\"",
                      .required = true},
                     &Texture::image, path()),
                 key({.name = "colour_space",
                      .doc = "a colour space of the OpenColorIO config, or `\"data\"` (numbers as "
                             "they are)",
                      .fallback = "integers are ordinary sRGB pictures, floats scene-linear"},
                     &Texture::colourSpace, text()),
                 key({.name = "times", .doc = "multiplies the image"}, &Texture::colour,
                     colour(notNegative))},
        .outer = outerOfMaterial + "type = \"diffuse\"\n[material.colour]\n",
        .least = "image = \"a.png\"",
        .path = "material[0].colour"};
    return table;
}

template <>
const KeyTable<Diffuse>& keysOf() {
    static const KeyTable<Diffuse> table{
        .id = "material.diffuse",
        .where = "a [[material]] of type diffuse",
        .tag = "diffuse",
        .keys = {key({.name = "colour", .doc = "its reflectance", .always = true}, &Diffuse::colour,
                     texture(zeroToOne))},
        .outer = outerOfMaterial,
        .path = "material[0]"};
    return table;
}

template <>
const KeyTable<Conductor>& keysOf() {
    const std::string why = "both say how much light the metal reflects";
    static const KeyTable<Conductor> table{
        .id = "material.conductor",
        .where = "a [[material]] of type conductor",
        .tag = "conductor",
        .exclusions = {{"eta", "colour", why}, {"k", "colour", why}},
        .keys = {conductorColour(),
                 refraction({.name = "eta", .doc = "with `k`: the metal's index of refraction"},
                            &std::pair<Rgb, Rgb>::first, positive),
                 refraction({.name = "k", .doc = "the imaginary part of that index"},
                            &std::pair<Rgb, Rgb>::second, notNegative),
                 roughness(&Conductor::roughness)},
        .check = checkConductor,
        .outer = outerOfMaterial,
        .path = "material[0]"};
    return table;
}

template <>
const KeyTable<Dielectric>& keysOf() {
    static const KeyTable<Dielectric> table{
        .id = "material.dielectric",
        .where = "a [[material]] of type dielectric",
        .tag = "dielectric",
        .keys = {key({.name = "ior",
                      .doc = "index of refraction of the inside; below 1 only with "
                             "`ior_below_one = true`",
                      .example = "1.25",
                      .always = true},
                     &Dielectric::ior, number({0, largestIor, true})),
                 belowOne(), roughness(&Dielectric::roughness)},
        .check = checkDielectric,
        .outer = outerOfMaterial,
        .path = "material[0]"};
    return table;
}

template <>
const KeyTable<InterfaceDescription>& keysOf() {
    static const KeyTable<InterfaceDescription> table{.id = "material.interface",
                                                      .where = "a [[material]] of type interface",
                                                      .tag = "interface",
                                                      .outer = outerOfMaterial,
                                                      .path = "material[0]"};
    return table;
}

template <>
const KeyTable<Emissive>& keysOf() {
    static const KeyTable<Emissive> table{
        .id = "material.emissive",
        .where = "a [[material]] of type emissive",
        .tag = "emissive",
        .keys = {key({.name = "radiance", .doc = "what it emits", .always = true},
                     &Emissive::radiance, texture(notNegative)),
                 key({.name = "both_sides", .doc = "`false`: it emits on the outside alone"},
                     &Emissive::bothSides, flag()),
                 key({.name = "group",
                      .doc = "the light group that it counts to; see \"Light groups\""},
                     &Emissive::group, groupName())},
        .outer = outerOfMaterial,
        .path = "material[0]"};
    return table;
}

template <>
const KeyTable<Mix>& keysOf() {
    const auto part = [](std::string name, std::string example, std::string Mix::*member) {
        return key({.name = std::move(name),
                    .doc = "name of a material that is no mix",
                    .example = std::move(example),
                    .required = true,
                    .always = true},
                   member, text());
    };
    const std::string parts =
        "[[surface]]\nsphere = {}\n"
        "[[material]]\nname = \"paint\"\ntype = \"diffuse\"\n"
        "[[material]]\nname = \"rust\"\ntype = \"conductor\"\n";
    static const KeyTable<Mix> table{
        .id = "material.mix",
        .where = "a [[material]] of type mix",
        .tag = "mix",
        .keys = {part("first", "\"paint\"", &Mix::first), part("second", "\"rust\"", &Mix::second),
                 key({.name = "weight",
                      .doc = "the share of the second. Images of weights are data, unless "
                             "`colour_space` says otherwise",
                      .always = true},
                     &Mix::weight, texture(zeroToOne))},
        .outer = parts + "[[material]]\nname = \"m\"\n",
        .least = "first = \"rust\"\nsecond = \"paint\"",
        .path = "material[2]"};
    return table;
}

template <>
const KeyTable<MaterialDescription>& keysOf() {
    static const KeyTable<MaterialDescription> table{
        .id = "material",
        .keys = {key({.name = "name",
                      .doc = "what surfaces and mixes call it",
                      .example = "\"glass\"",
                      .required = true,
                      .always = true},
                     &MaterialDescription::name, text())},
        .outer = "[[surface]]\nsphere = {}\n[[material]]\ntype = \"diffuse\"\n",
        .least = "name = \"m\"",
        .path = "material[0]"};
    return table;
}

MaterialDescription readMaterial(const TomlTable& table, const std::filesystem::path& base) {
    MaterialDescription material;
    readTagged(table, "material type", material.material, base, {"name"});
    for (const Key<MaterialDescription>& key : keysOf<MaterialDescription>().keys) {
        const std::string& name = key.info.name;
        key.read(table.need(name, name + " = " + key.info.example), material, base);
    }
    return material;
}

}  // namespace woodcock::scene
