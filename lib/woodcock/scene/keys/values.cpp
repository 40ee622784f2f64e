// SPDX-License-Identifier: Apache-2.0
#include "woodcock/scene/keys/values.h"

#include <cmath>

#include "woodcock/base/printable.h"
#include "woodcock/image/light_parts.h"

namespace woodcock::scene {
namespace {

using Base = const std::filesystem::path&;

/// Beyond this |g| the phase function's peak is finer than a float's cosine can tell.
constexpr double largestG = 0.9999;

/// " >= 0", ", 0..1": what stands behind the name of a type.
std::string rangeText(NumberRange range) {
    const NumberRange all;
    const bool below = range.lower != all.lower, above = range.upper < 1e30;
    if (below && above)
        return fmt::format(", {}..{}{}", range.lower, range.upper,
                           range.strict ? " exclusive" : "");
    if (below) return fmt::format(" {} {}", range.strict ? ">" : ">=", range.lower);
    return "";
}

/// Two numbers within the range.
std::vector<std::string> numbersWithin(NumberRange range) {
    const double lower = std::max(range.lower, 0.0), upper = std::min(range.upper, lower + 4);
    return {tomlNumber(lower + (upper - lower) / 4), tomlNumber(lower + (upper - lower) / 2)};
}

float readG(const TomlValue& value) {
    const double g = value.number({-1, 1, true});
    if (std::abs(g) > largestG)
        throw value.error("is {}; it must lie between {} and {}", g, -largestG, largestG);
    return static_cast<float>(g);
}

}  // namespace

Value<double> number(NumberRange range) {
    return {"number" + rangeText(range),
            numbersWithin(range),
            [=](const TomlValue& v, Base) { return v.number(range); },
            [](const double& v, const SceneWriter&) { return tomlNumber(v); },
            {},
            true};
}

Value<int> integer(int lower, int upper) {
    return {upper == largestCount ? fmt::format("integer >= {}", lower)
                                  : fmt::format("integer, {}..{}", lower, upper),
            {std::to_string(std::max(lower, 0) + 2), std::to_string(std::max(lower, 0) + 3)},
            [=](const TomlValue& v, Base) { return v.integer(lower, upper); },
            [](const int& v, const SceneWriter&) { return std::to_string(v); }};
}

Value<bool> flag() {
    return {"`true` or `false`",
            {"true", "false"},
            [](const TomlValue& v, Base) { return v.flag(); },
            [](const bool& v, const SceneWriter&) { return std::string(v ? "true" : "false"); }};
}

Value<std::string> text() {
    return {"text",
            {"\"a \\\"b\\\"\"", "\"c\""},
            [](const TomlValue& v, Base) { return v.text(); },
            [](const std::string& v, const SceneWriter&) { return tomlText(v); }};
}

Value<std::string> groupName() {
    return {"text",
            {"\"key\"", "\"fire-2\""},
            [](const TomlValue& v, Base) {
                const std::string name = v.text();
                if (const std::string flaw = image::flawOfGroupName(name); !flaw.empty())
                    throw v.error("is '{}', which {}", shown(name, 60), flaw);
                return name;
            },
            [](const std::string& v, const SceneWriter&) { return tomlText(v); }};
}

Value<std::filesystem::path> path() {
    return {"path",
            {"\"folder/b $$5.exr\"", "\"c.exr\""},
            [](const TomlValue& v, Base base) { return v.path(base); },
            [](const std::filesystem::path& v, const SceneWriter& out) { return out.quoted(v); },
            [](std::filesystem::path& v, Files& files) {
                if (!v.empty()) files.push_back(&v);
            }};
}

Value<Vec3d> vector() {
    return {"`[x, y, z]`",
            {"[1, 2, 0.1]", "[3, 4, 5]"},
            [](const TomlValue& v, Base) { return v.vector(); },
            [](const Vec3d& v, const SceneWriter&) { return tomlVector(v); },
            {},
            true};
}

Value<Rgb> colour(NumberRange range) {
    return {"colour" + rangeText(range),
            {"[0.1, 0.2, 0.3]", "0.6"},
            [=](const TomlValue& v, Base) { return v.colour(range); },
            [](const Rgb& v, const SceneWriter&) { return tomlColour(v); },
            {},
            true};
}

Value<Vec3d> exactColour(NumberRange range) {
    return {"colour" + rangeText(range),
            {"[0.1, 0.2, 0.3]", "0.6"},
            [=](const TomlValue& v, Base) { return v.exactColour(range); },
            [](const Vec3d& v, const SceneWriter&) { return tomlColour(v); },
            {},
            true};
}

Value<Affine3d> matrix() {
    return {"four rows of four numbers",
            {"[[0, -1, 0, 1], [1, 0, 0, 2], [0, 0, 1, 0.1], [0, 0, 0, 1]]"},
            [](const TomlValue& v, Base) { return v.affine(); },
            [](const Affine3d& v, const SceneWriter&) { return tomlMatrix(v); },
            {},
            true};
}

Value<std::array<double, 2>> numberPair(std::string what, NumberRange range) {
    return {fmt::format("`{}`{}", what, rangeText(range)),
            {"[0.1, 2]", "[3, 4]"},
            [=](const TomlValue& v, Base) {
                const auto both = v.elements(what, 2);
                return std::array{both[0].number(range), both[1].number(range)};
            },
            [](const std::array<double, 2>& v, const SceneWriter&) {
                return fmt::format("[{}, {}]", tomlNumber(v[0]), tomlNumber(v[1]));
            },
            {},
            true};
}

Value<float> meanCosine() {
    return {fmt::format("number, {}..{}", -largestG, largestG),
            {"0.1", "0.5"},
            [](const TomlValue& v, Base) { return readG(v); },
            [](const float& v, const SceneWriter&) { return fmt::format("{}", v); },
            {},
            true};
}

Value<grid::Storage> storage() { return choiceOf<grid::Storage>("storage", grid::storageNames); }

template <>
const KeyTable<Transform>& keysOf() {
    static const KeyTable<Transform> table{
        .id = "transform",
        .where = "",
        .tag = "",
        .exclusions = {},
        .keys = {key({.name = "translate", .doc = "world units"}, &Transform::translate, vector()),
                 key({.name = "rotate", .doc = "degrees about x, y and z"}, &Transform::rotate,
                     vector()),
                 key({.name = "scale", .doc = "a factor, or one for each axis"}, &Transform::scale,
                     Value<Vec3d>{"number, or `[x, y, z]`",
                                  {"2"},
                                  [](const TomlValue& v, Base) {
                                      return v.isArray() ? v.vector() : Vec3d{1, 1, 1} * v.number();
                                  },
                                  [](const Vec3d& v, const SceneWriter&) { return tomlVector(v); },
                                  {},
                                  true})},
        .outer = "[[surface]]\nsphere = {}\n[surface.transform]\n",
        .path = "surface[0].transform"};
    return table;
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

Affine3d placement(Vec3d translate, Vec3d rotate, Vec3d scale) {
    return Affine3d::translate(translate) * Affine3d::rotate(2, rotate.z) *
           Affine3d::rotate(1, rotate.y) * Affine3d::rotate(0, rotate.x) * Affine3d::scale(scale);
}

Affine3d readTransform(const TomlValue& value, std::string_view what) {
    Transform t;
    const TomlTable table = value.table();
    readKeys(table, t, {});
    for (int i = 0; i < 3; ++i)
        if (t.scale[i] == 0)
            throw table.find("scale")->error("is zero; it would flatten the {}", what);
    const Affine3d map = placement(t.translate, t.rotate, t.scale);
    if (const std::string flaw = flawOf(map); !flaw.empty()) throw value.error("{}", flaw);
    return map;
}

}  // namespace woodcock::scene
