// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>

#include "woodcock/scene/keys/sections.h"
#include "woodcock/scene/keys/values.h"

namespace woodcock::scene {

// What the tables of several lights have in common.

inline constexpr const char* outerOfLight = "[[surface]]\nsphere = {}\n[[light]]\n";

Value<UpAxis> upAxis();

template <class Light>
Key<Light> position(Vec3d Light::*member) {
    return key({.name = "position",
                .doc = "in world space",
                .example = "[0, 2, 0]",
                .required = true,
                .always = true},
               member, vector());
}

template <class Light>
Key<Light> power(std::string doc) {
    return otherWay<Light>({.name = "power",
                            .doc = std::move(doc),
                            .type = colour(notNegative).type,
                            .fallback = "none",
                            .example = "[3, 2, 1]"});
}

// Where a lamp shines: the key `direction`, or `look_at` in place of it.

template <class Light>
Key<Light> lookAt(std::string beside) {
    return otherWay<Light>({.name = "look_at",
                            .doc = "instead of `direction`: a point that it shines at",
                            .type = vector().type,
                            .fallback = "none",
                            .example = "[0, 0, 0]",
                            .beside = std::move(beside)});
}

/// What lets `look_at` stand beside `direction` in no light.
inline Exclusion aimedTwice() { return {"look_at", "direction", "both say where it shines"}; }

/// Aims `direction` as the table says; it stays as it is where the table says nothing. Throws
/// Error{Input} where it points nowhere.
void checkAim(const TomlTable& table, Vec3d position, Vec3d& direction);

// What a light that is aimed needs beside an example of another key.
inline constexpr const char* aimed = "position = [1, 1, 1]\ndirection = [1, 0, 0]";
inline constexpr const char* aimedAtAPoint = "position = [1, 1, 1]\nlook_at = [0, 5, 0]";

}  // namespace woodcock::scene
