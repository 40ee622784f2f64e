// SPDX-License-Identifier: Apache-2.0
#include <tuple>

#include "woodcock/scene/parse_sections.h"
#include "woodcock/scene/parse_values.h"

namespace woodcock {
namespace {

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

bool emits(const TomlTable& table) { return table.has("emission") || table.has("blackbody"); }

SeparateCoefficients parseSeparate(const TomlTable& table, const std::string& density) {
    SeparateCoefficients c;
    if (const auto v = table.find("sigma_a")) c.sigmaA = parseGridCoefficient(*v, density);
    if (const auto v = table.find("sigma_s")) c.sigmaS = parseGridCoefficient(*v, density);
    // A fire without smoke needs no density grid.
    for (auto* sigma : {&c.sigmaA, &c.sigmaS})
        if (emits(table) && *sigma && (*sigma)->scale == Rgb(0)) sigma->reset();
    return c;
}

BlackbodyDescription parseBlackbody(const TomlValue& value) {
    const TomlTable table = value.table();
    table.allowOnly({"temperature", "scale", "offset", "intensity", "colour"}, value.name());
    BlackbodyDescription b;
    if (const auto v = table.find("temperature")) b.temperature = v->text();
    if (const auto v = table.find("scale")) b.scale = v->number();
    if (const auto v = table.find("offset")) b.offset = v->number();
    if (const auto v = table.find("intensity")) b.intensity = v->number(notNegative);
    if (const auto v = table.find("colour")) b.colour = v->colour(notNegative);
    return b;
}

HomogeneousBox parseBox(const TomlTable& table, const TomlValue& box) {
    for (const char* key :
         {"density", "albedo_grid", "blackbody", "storage", "background", "repair"})
        if (const auto v = table.find(key))
            throw v->error("needs a file: a box holds constant coefficients and no grids");
    HomogeneousBox c;
    c.box = parseBounds(box);
    if (!table.has("scale") && !table.has("albedo") && !table.has("sigma_a") &&
        !table.has("sigma_s") && !table.has("emission"))
        throw table.error(
            "is a box of nothing; give sigma_a and sigma_s, or scale and albedo, or emission");
    std::tie(c.sigmaA, c.sigmaS) = parseCoefficients(table);
    return c;
}

}  // namespace

VolumeDescription parseVolume(const TomlTable& table, const std::filesystem::path& base) {
    table.allowOnly({"file", "box", "density", "scale", "albedo", "albedo_grid", "sigma_a",
                     "sigma_s", "emission", "blackbody", "g", "transform", "matrix", "inside",
                     "storage", "background", "repair"},
                    "[[volume]]");
    checkCoefficientKeys(table);
    table.exclude("box", "file", "a volume is either read from a file or a homogeneous box");

    VolumeDescription volume;
    if (const auto box = table.find("box")) {
        volume.coefficients = parseBox(table, *box);
        if (const auto v = table.find("emission")) volume.emission = {"", v->colour(notNegative)};
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
        if (const auto v = table.find("emission")) volume.emission = parseGridCoefficient(*v, name);
        if (const auto v = table.find("blackbody")) volume.blackbody = parseBlackbody(*v);
    }
    if (const auto v = table.find("g")) volume.g = parseG(*v);
    volume.worldFromObject = parsePlacement(table, "volume");
    if (const auto v = table.find("inside")) volume.inside = v->text();
    if (const auto v = table.find("storage")) volume.storage = parseStorage(*v);
    if (const auto v = table.find("background"))
        volume.background = static_cast<Background>(v->choice("background", backgroundNames));
    if (const auto v = table.find("repair")) volume.repair = v->flag();
    return volume;
}

}  // namespace woodcock
