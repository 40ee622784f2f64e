// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "woodcock/base/vec.h"
#include "woodcock/grid/field_source.h"
#include "woodcock/scene/keys/key.h"

namespace woodcock::scene {

// The kinds of values that keys of a scene file have. What is read throws Error{Input}.

inline constexpr NumberRange zeroToOne{0, 1};
inline constexpr int largestCount = std::numeric_limits<int>::max();

Value<double> number(NumberRange range = {});
Value<int> integer(int lower, int upper = largestCount);
Value<bool> flag();
Value<std::string> text();
/// The name of a light group.
Value<std::string> groupName();
Value<std::filesystem::path> path();
Value<Vec3d> vector();
Value<Rgb> colour(NumberRange range);
Value<Vec3d> exactColour(NumberRange range);
Value<Affine3d> matrix();
/// Two numbers; `what` says which, as "[width, height]".
Value<std::array<double, 2>> numberPair(std::string what, NumberRange range);
/// The mean cosine of a phase function.
Value<float> meanCosine();
Value<grid::Storage> storage();

/// One of several words; `what` names the kind of thing in messages ("camera type").
template <class E>
Value<E> choice(std::string what, std::vector<std::pair<E, std::string>> known) {
    std::vector<std::string> names;
    for (const auto& [value, name] : known) names.push_back(name);
    std::vector<std::string> quoted;
    for (const std::string& name : names) quoted.push_back(tomlText(name));
    return {fmt::format("`{}`", fmt::join(quoted, "`, `")), quoted,
            [=](const TomlValue& v, const std::filesystem::path&) {
                return known[v.choice(what, names)].first;
            },
            [=](const E& value, const SceneWriter&) {
                for (const auto& [each, name] : known)
                    if (each == value) return tomlText(name);
                throw usageError("no {} has the number {}", what, static_cast<int>(value));
            }};
}

/// Those of an enumeration whose names are listed in its order.
template <class E, class Names>
Value<E> choiceOf(std::string what, const Names& names) {
    std::vector<std::pair<E, std::string>> known;
    for (size_t i = 0; i < names.size(); ++i) known.emplace_back(static_cast<E>(i), names[i]);
    return choice<E>(std::move(what), std::move(known));
}

/// { translate, rotate, scale }
struct Transform {
    Vec3d translate, rotate, scale{1, 1, 1};
};
template <>
const KeyTable<Transform>& keysOf();

/// { min = [x, y, z], max = [x, y, z] }
Value<Box3d> bounds();

/// Scaled, then turned about x, y and z in this order (degrees), then moved.
Affine3d placement(Vec3d translate, Vec3d rotate, Vec3d scale);
/// The same of { translate, rotate, scale }; `what` is placed by it ("volume").
Affine3d readTransform(const TomlValue& value, std::string_view what);

/// The keys `transform` and `matrix` of a table that describes a D, which both set `member`.
template <class D>
std::vector<Key<D>> placementKeys(Affine3d D::*member, std::string what, const std::string& doc) {
    Key<D> transform = otherWay<D>({.name = "transform",
                                    .doc = doc,
                                    .type = "table",
                                    .fallback = "none",
                                    .example = "{ translate = [1, 2, 3] }",
                                    .moves = true});
    transform.read = [=](const TomlValue& v, D& d, const std::filesystem::path&) {
        d.*member = readTransform(v, what);
    };
    return {transform, key({.name = "matrix",
                            .doc = "instead of `transform`. The last row is `[0, 0, 0, 1]`",
                            .fallback = "identity"},
                           member, matrix())};
}

// What volumes and the media of surfaces say alike.

/// sigma_a and sigma_s against scale and albedo.
std::vector<Exclusion> coefficientExclusions();

/// The sigma_a and sigma_s that a table's scale and albedo say; nothing where it has no scale.
/// Throws Error{Input} on an albedo without a scale.
std::optional<std::pair<Rgb, Rgb>> readScaleAndAlbedo(const TomlTable& table);

}  // namespace woodcock::scene
