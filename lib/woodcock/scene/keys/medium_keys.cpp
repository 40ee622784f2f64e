// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "woodcock/scene/keys/sections.h"
#include "woodcock/scene/keys/values.h"

namespace woodcock::scene {
namespace {

using I = InteriorDescription;

Key<I> instead(std::string name, std::string doc, std::string type, std::string example,
               std::string beside) {
    return otherWay<I>({.name = std::move(name),
                        .doc = std::move(doc),
                        .type = std::move(type),
                        .fallback = "none",
                        .example = std::move(example),
                        .beside = std::move(beside)});
}

std::vector<Key<I>> interiorKeys() {
    const std::string dyed = "colour = 0.5\ndistance = 1";
    return {
        key({.name = "sigma_a", .doc = "absorption per world unit", .always = true}, &I::sigmaA,
            colour(notNegative)),
        key({.name = "sigma_s", .doc = "scattering per world unit", .always = true}, &I::sigmaS,
            colour(notNegative)),
        instead("scale", "instead of `sigma_a` and `sigma_s`: sigma_t", colour(notNegative).type,
                "2", "scale = 1"),
        instead("albedo", "beside `scale`: sigma_s = albedo x scale", colour(zeroToOne).type, "0.5",
                "scale = 1"),
        instead("colour",
                "instead of `sigma_a`: what white light has become after `distance`. sigma_a = "
                "-ln(colour) / distance",
                colour(zeroToOne).type, "[0.1, 0.2, 0.3]", dyed),
        instead("distance", "beside `colour`, in world units", number(positive).type, "2", dyed),
        key({.name = "g", .doc = "mean cosine of scattering"}, &I::g, meanCosine()),
        key({.name = "emission",
             .doc = "radiance per world unit. Within glass of index n it looks n^2 times darker "
                    "from outside"},
            &I::emission, colour(notNegative)),
    };
}

/// What absorbs so that light of all colours becomes `colour` over `distance`.
Rgb absorptionOf(const TomlTable& medium, const TomlValue& colour) {
    const Vec3d rgb = colour.exactColour(zeroToOne);
    for (int i = 0; i < 3; ++i)
        if (rgb[i] == 0)
            throw colour.error(
                "is 0 in its {} channel, which would need infinite absorption; give what little "
                "comes through, such as 0.001",
                std::array{"red", "green", "blue"}[static_cast<size_t>(i)]);
    const auto distance = medium.find("distance");
    if (!distance)
        throw colour.error("needs a distance beside it: how far light goes to become so");
    const double d = distance->number(positive);
    const Rgb sigma =
        Rgb::map([&](int i) { return static_cast<float>(-std::log(rgb[i]) / d + 0.0); });
    if (!sigma.isFinite()) throw distance->error("is {}: too short for a float's sigma_a", d);
    return sigma;
}

void checkInterior(const TomlTable& table, I& interior) {
    const auto colour = table.find("colour"), distance = table.find("distance");
    if (distance && !colour)
        throw distance->error("needs a colour beside it: what light becomes over that distance");
    if (table.keys().empty() || (table.has("g") && table.keys().size() == 1))
        throw table.error(
            "holds nothing; give sigma_a and sigma_s, scale and albedo, colour and distance, or "
            "emission, or leave it out");
    if (const auto sigma = readScaleAndAlbedo(table))
        std::tie(interior.sigmaA, interior.sigmaS) = *sigma;
    if (colour) interior.sigmaA = absorptionOf(table, *colour);
}

std::vector<Exclusion> interiorExclusions() {
    std::vector<Exclusion> all = coefficientExclusions();
    for (const char* key : {"sigma_a", "scale", "albedo"})
        all.push_back({"colour", key, "both say how much the medium absorbs"});
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
const KeyTable<Box3d>& keysOf() {
    const auto check = [](const TomlTable& table, Box3d& box) {
        for (int i = 0; i < 3; ++i)
            if (!(box.lower[i] < box.upper[i]))
                throw table.find("max")
                    ->element(static_cast<size_t>(i))
                    .error("is {}; it must exceed min[{}], which is {}", box.upper[i], i,
                           box.lower[i]);
    };
    static const KeyTable<Box3d> table{
        .id = "box",
        .keys = {key({.name = "min",
                      .doc = "the corner with the least coordinates",
                      .example = "[0, 0, 0]",
                      .required = true,
                      .always = true},
                     &Box3d::lower, vector()),
                 key({.name = "max",
                      .doc = "the corner with the greatest coordinates",
                      .example = "[1, 1, 1]",
                      .required = true,
                      .always = true},
                     &Box3d::upper, vector())},
        .check = check,
        .outer = "[[volume]]\nsigma_a = 1\n[volume.box]\n",
        .least = "min = [-1, -1, -1]\nmax = [2, 2, 2]",
        .path = "volume[0].box"};
    return table;
}

Value<Box3d> bounds() {
    Value<Box3d> value = nested<Box3d>();
    value.type = "`{ min = [x, y, z], max = [x, y, z] }`";
    value.examples = {"{ min = [-1, 0, 0.1], max = [1, 2, 3] }"};
    return value;
}

template <>
const KeyTable<I>& keysOf() {
    static const KeyTable<I> table{
        .id = "surface.medium",
        .exclusions = interiorExclusions(),
        .keys = interiorKeys(),
        .check = checkInterior,
        .outer =
            "[[material]]\nname = \"glass\"\ntype = \"dielectric\"\n"
            "[[surface]]\nsphere = {}\nmaterial = \"glass\"\n[surface.medium]\n",
        .least = "sigma_a = 1",
        .path = "surface[0].medium"};
    return table;
}

}  // namespace woodcock::scene
