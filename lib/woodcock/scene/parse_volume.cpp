// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "woodcock/scene/parse_sections.h"

namespace woodcock {
namespace {

constexpr NumberRange zeroToOne{0, 1};
/// Beyond this |g| the phase function's peak is finer than a float's cosine can tell.
constexpr double largestG = 0.9999;

const std::string mixedUp =
    "sigma_a and sigma_s say what scale and albedo say (sigma_t = scale x density, "
    "sigma_s = albedo x sigma_t)";

double parseG(const TomlValue& value) {
    const double g = value.number({-1, 1, true});
    if (std::abs(g) > largestG)
        throw value.error("is {}; it must lie between {} and {}", g, -largestG, largestG);
    return g;
}

GridCoefficient parseGridCoefficient(const TomlValue& value, const std::string& density) {
    if (!value.isTable()) return {density, value.colour(notNegative)};
    const TomlTable table = value.table();
    table.allowOnly({"grid", "scale"}, value.name());
    GridCoefficient coefficient;
    coefficient.grid = table.need("grid", "grid = \"absorption\"").text();
    if (const auto scale = table.find("scale")) coefficient.scale = scale->colour(notNegative);
    return coefficient;
}

DensityCoefficients parseDensity(const TomlTable& table, const std::string& density) {
    DensityCoefficients c;
    c.density = density;
    if (const auto v = table.find("scale")) c.scale = v->colour(notNegative);
    if (const auto v = table.find("albedo")) c.albedo = v->exactColour(zeroToOne);
    if (const auto v = table.find("albedo_grid")) c.albedoGrid = v->text();
    return c;
}

SeparateCoefficients parseSeparate(const TomlTable& table, const std::string& density) {
    SeparateCoefficients c;
    if (const auto v = table.find("sigma_a")) c.sigmaA = parseGridCoefficient(*v, density);
    if (const auto v = table.find("sigma_s")) c.sigmaS = parseGridCoefficient(*v, density);
    return c;
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

HomogeneousBox parseBox(const TomlTable& table, const TomlValue& box) {
    for (const char* key : {"density", "albedo_grid", "storage", "repair"})
        if (const auto v = table.find(key))
            throw v->error("needs a file: a box holds constant coefficients and no grids");
    HomogeneousBox c;
    c.box = parseBounds(box);
    if (const auto scale = table.find("scale")) {
        const auto albedo = table.find("albedo");
        std::tie(c.sigmaA, c.sigmaS) = splitByAlbedo(
            scale->colour(notNegative), albedo ? albedo->exactColour(zeroToOne) : Vec3d{1, 1, 1});
    } else if (table.has("albedo")) {
        throw table.need("albedo", "").error("needs a scale: sigma_t = scale in a box");
    } else if (!table.has("sigma_a") && !table.has("sigma_s")) {
        throw table.error("is a box of nothing; give sigma_a and sigma_s, or scale and albedo");
    }
    if (const auto v = table.find("sigma_a")) c.sigmaA = v->colour(notNegative);
    if (const auto v = table.find("sigma_s")) c.sigmaS = v->colour(notNegative);
    return c;
}

Affine3d parseTransform(const TomlValue& value) {
    const TomlTable table = value.table();
    table.allowOnly({"translate", "rotate", "scale"}, value.name());
    Vec3d translate, rotate, scale{1, 1, 1};
    if (const auto v = table.find("translate")) translate = v->vector();
    if (const auto v = table.find("rotate")) rotate = v->vector();
    if (const auto v = table.find("scale")) {
        scale = v->isArray() ? v->vector() : Vec3d{1, 1, 1} * v->number();
        for (int i = 0; i < 3; ++i)
            if (scale[i] == 0) throw v->error("is zero; it would flatten the volume");
    }
    return Affine3d::translate(translate) * Affine3d::rotate(2, rotate.z) *
           Affine3d::rotate(1, rotate.y) * Affine3d::rotate(0, rotate.x) * Affine3d::scale(scale);
}

}  // namespace

VolumeDescription parseVolume(const TomlTable& table, const std::filesystem::path& base) {
    table.allowOnly({"file", "box", "density", "scale", "albedo", "albedo_grid", "sigma_a",
                     "sigma_s", "g", "transform", "matrix", "storage", "repair"},
                    "[[volume]]");
    for (const char* sigma : {"sigma_a", "sigma_s"})
        for (const char* other : {"scale", "albedo", "albedo_grid"})
            table.exclude(sigma, other, mixedUp);
    table.exclude("box", "file", "a volume is either read from a file or a homogeneous box");
    table.exclude("transform", "matrix", "both place the volume");

    VolumeDescription volume;
    if (const auto box = table.find("box")) {
        volume.coefficients = parseBox(table, *box);
    } else {
        const auto file = table.find("file");
        if (!file)
            throw table.error(
                "has neither file nor box; give file = \"smoke.vdb\" or "
                "box = {{ min = [0, 0, 0], max = [1, 1, 1] }}");
        volume.file = file->path(base);
        const auto density = table.find("density");
        const std::string name = density ? density->text() : std::string();
        if (table.has("sigma_a") || table.has("sigma_s"))
            volume.coefficients = parseSeparate(table, name);
        else
            volume.coefficients = parseDensity(table, name);
    }
    if (const auto v = table.find("g")) volume.g = static_cast<float>(parseG(*v));
    if (const auto v = table.find("transform")) volume.worldFromObject = parseTransform(*v);
    if (const auto v = table.find("matrix")) volume.worldFromObject = v->affine();
    if (const auto v = table.find("storage"))
        volume.storage = std::array{Storage::Auto, Storage::Half, Storage::Float}[v->choice(
            "storage", std::array<std::string, 3>{"auto", "half", "float"})];
    if (const auto v = table.find("repair")) volume.repair = v->flag();
    return volume;
}

}  // namespace woodcock
