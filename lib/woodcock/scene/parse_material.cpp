// SPDX-License-Identifier: Apache-2.0
#include "woodcock/scene/parse_sections.h"
#include "woodcock/scene/parse_values.h"

namespace woodcock {
namespace {

using Base = const std::filesystem::path&;

/// Beyond this no ray gets in or out, but by the last digits of a cosine.
constexpr double largestIor = 100;

/// number | [r, g, b] | { image, colour_space, times }. `range` is of the colour alone; what an
/// image holds is known when it is loaded.
TextureDescription parseTexture(const TomlValue& value, NumberRange range, Base base) {
    TextureDescription texture;
    if (!value.isTable()) {
        texture.colour = value.colour(range);
        return texture;
    }
    const TomlTable table = value.table();
    table.allowOnly({"image", "colour_space", "times"}, value.name());
    texture.image = table.need("image", "image = \"wood.png\"").path(base);
    if (const auto v = table.find("colour_space")) texture.colourSpace = v->text();
    if (const auto v = table.find("times")) texture.colour = v->colour(notNegative);
    return texture;
}

double parseRoughness(const TomlTable& table) {
    const auto v = table.find("roughness");
    return v ? v->number(zeroToOne) : 0;
}

DiffuseDescription parseDiffuse(const TomlTable& table, Base base) {
    table.allowOnly({"name", "type", "colour"}, "a [[material]] of type diffuse");
    DiffuseDescription diffuse;
    if (const auto v = table.find("colour")) diffuse.colour = parseTexture(*v, zeroToOne, base);
    return diffuse;
}

ConductorDescription parseConductor(const TomlTable& table, Base base) {
    table.allowOnly({"name", "type", "colour", "eta", "k", "roughness"},
                    "a [[material]] of type conductor");
    for (const char* key : {"eta", "k"})
        table.exclude(key, "colour", "both say how much light the metal reflects");
    ConductorDescription conductor;
    if (const auto v = table.find("colour")) conductor.colour = parseTexture(*v, zeroToOne, base);
    const auto eta = table.find("eta"), k = table.find("k");
    if (eta && !k) throw eta->error("needs a k beside it, such as k = [3.9, 2.5, 2.1]");
    if (k && !eta) throw k->error("needs an eta beside it, such as eta = [0.14, 0.38, 1.4]");
    if (eta) conductor.etaK = {eta->colour(positive), k->colour(notNegative)};
    conductor.roughness = parseRoughness(table);
    return conductor;
}

DielectricDescription parseDielectric(const TomlTable& table) {
    table.allowOnly({"name", "type", "ior", "ior_below_one", "roughness"},
                    "a [[material]] of type dielectric");
    DielectricDescription dielectric;
    const auto belowOne = table.find("ior_below_one");
    const bool allowed = belowOne && belowOne->flag();
    if (const auto v = table.find("ior")) {
        dielectric.ior = v->number({0, largestIor, true});
        if (dielectric.ior < 1 && !allowed)
            throw v->error(
                "is {}: inside, light would be faster than in vacuum. A bubble of air in glass is "
                "a surface of its own, with ior = 1 and a higher priority; if it is meant all the "
                "same, say ior_below_one = true",
                dielectric.ior);
    }
    dielectric.roughness = parseRoughness(table);
    return dielectric;
}

EmissiveDescription parseEmissive(const TomlTable& table, Base base) {
    table.allowOnly({"name", "type", "radiance", "both_sides"}, "a [[material]] of type emissive");
    EmissiveDescription emissive;
    if (const auto v = table.find("radiance"))
        emissive.radiance = parseTexture(*v, notNegative, base);
    if (const auto v = table.find("both_sides")) emissive.bothSides = v->flag();
    return emissive;
}

MixDescription parseMix(const TomlTable& table, Base base) {
    table.allowOnly({"name", "type", "first", "second", "weight"}, "a [[material]] of type mix");
    MixDescription mix;
    mix.first = table.need("first", "first = \"paint\"").text();
    mix.second = table.need("second", "second = \"rust\"").text();
    if (const auto v = table.find("weight")) mix.weight = parseTexture(*v, zeroToOne, base);
    return mix;
}

}  // namespace

MaterialDescription parseMaterial(const TomlTable& table, Base base) {
    const std::array<std::string, 6> types{"diffuse",   "conductor", "dielectric",
                                           "interface", "emissive",  "mix"};
    MaterialDescription material;
    switch (table.need("type", "type = \"diffuse\"").choice("material type", types)) {
        case 0:
            material.material = parseDiffuse(table, base);
            break;
        case 1:
            material.material = parseConductor(table, base);
            break;
        case 2:
            material.material = parseDielectric(table);
            break;
        case 3:
            table.allowOnly({"name", "type"}, "a [[material]] of type interface");
            material.material = InterfaceDescription();
            break;
        case 4:
            material.material = parseEmissive(table, base);
            break;
        default:
            material.material = parseMix(table, base);
            break;
    }
    material.name = table.need("name", "name = \"glass\"").text();
    return material;
}

}  // namespace woodcock
