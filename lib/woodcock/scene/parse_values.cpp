// SPDX-License-Identifier: Apache-2.0
#include "woodcock/scene/parse_values.h"

#include <cmath>

#include "woodcock/scene/description.h"

namespace woodcock {
namespace {

/// Beyond this |g| the phase function's peak is finer than a float's cosine can tell.
constexpr double largestG = 0.9999;

}  // namespace

float parseG(const TomlValue& value) {
    const double g = value.number({-1, 1, true});
    if (std::abs(g) > largestG)
        throw value.error("is {}; it must lie between {} and {}", g, -largestG, largestG);
    return static_cast<float>(g);
}

Storage parseStorage(const TomlValue& value) {
    return static_cast<Storage>(value.choice("storage", storageNames));
}

Box3d parseBounds(const TomlValue& value) {
    const TomlTable table = value.table();
    table.allowOnly({"min", "max"}, value.name());
    Box3d box;
    box.lower = table.need("min", "min = [0, 0, 0]").vector();
    const TomlValue upper = table.need("max", "max = [1, 1, 1]");
    box.upper = upper.vector();
    for (int i = 0; i < 3; ++i)
        if (!(box.lower[i] < box.upper[i]))
            throw upper.element(static_cast<size_t>(i))
                .error("is {}; it must exceed min[{}], which is {}", box.upper[i], i, box.lower[i]);
    return box;
}

void checkCoefficientKeys(const TomlTable& table) {
    for (const char* sigma : {"sigma_a", "sigma_s"})
        for (const char* other : {"scale", "albedo", "albedo_grid"})
            table.exclude(sigma, other,
                          "sigma_a and sigma_s say what scale and albedo say (sigma_t = scale x "
                          "density, sigma_s = albedo x sigma_t)");
}

std::pair<Rgb, Rgb> parseCoefficients(const TomlTable& table) {
    checkCoefficientKeys(table);
    const auto scale = table.find("scale"), albedo = table.find("albedo");
    if (albedo && !scale) throw albedo->error("needs a scale: here sigma_t = scale");
    if (scale)
        return splitByAlbedo(scale->colour(notNegative),
                             albedo ? albedo->exactColour(zeroToOne) : Vec3d{1, 1, 1});
    std::pair sigma{Rgb(0), Rgb(0)};
    if (const auto v = table.find("sigma_a")) sigma.first = v->colour(notNegative);
    if (const auto v = table.find("sigma_s")) sigma.second = v->colour(notNegative);
    return sigma;
}

Affine3d placement(Vec3d translate, Vec3d rotate, Vec3d scale) {
    return Affine3d::translate(translate) * Affine3d::rotate(2, rotate.z) *
           Affine3d::rotate(1, rotate.y) * Affine3d::rotate(0, rotate.x) * Affine3d::scale(scale);
}

Affine3d parseTransform(const TomlValue& value, std::string_view what) {
    const TomlTable table = value.table();
    table.allowOnly({"translate", "rotate", "scale"}, value.name());
    Vec3d translate, rotate, scale{1, 1, 1};
    if (const auto v = table.find("translate")) translate = v->vector();
    if (const auto v = table.find("rotate")) rotate = v->vector();
    if (const auto v = table.find("scale")) {
        scale = v->isArray() ? v->vector() : Vec3d{1, 1, 1} * v->number();
        for (int i = 0; i < 3; ++i)
            if (scale[i] == 0) throw v->error("is zero; it would flatten the {}", what);
    }
    const Affine3d map = placement(translate, rotate, scale);
    if (const std::string flaw = flawOf(map); !flaw.empty()) throw value.error("{}", flaw);
    return map;
}

Affine3d parsePlacement(const TomlTable& table, std::string_view what) {
    table.exclude("transform", "matrix", fmt::format("both place the {}", what));
    if (const auto v = table.find("transform")) return parseTransform(*v, what);
    if (const auto v = table.find("matrix")) return v->affine();
    return {};
}

}  // namespace woodcock
