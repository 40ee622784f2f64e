// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "woodcock/base/vec.h"
#include "woodcock/scene/defaults.h"
#include "woodcock/scene/description.h"
#include "woodcock/scene/load.h"

namespace woodcock::scene {

// What completeScene() does for the camera.

/// World points whose convex hull holds all of the scene's volumes but for their faintest wisps
/// (below 1 % of a grid's largest value), and all surfaces but infinite planes; to frame them
/// tighter than their boxes would. The corners of the unit cube where there is nothing to see.
std::vector<Vec3d> sceneOutline(const SceneDescription& description, const LoadedScene& loaded);

/// The same of what is seen from far off in the direction `towards` (from the scene to the eye):
/// without the blocks of a volume behind and before which, and in which, there is so little that
/// rays have an optical depth of less than 0.1. What glows is told by its values, as above.
std::vector<Vec3d> seenOutline(const SceneDescription& description, const LoadedScene& loaded,
                               Vec3d towards);

Vec3d upVector(UpAxis up);

/// From the scene to a camera whose place is open: a three-quarter view, from a little above where
/// it is for a picture, and from higher up in the plain look.
Vec3d usualView(UpAxis up, Look look);

// `points` are those of sceneOutline().

/// Places a camera that the scene leaves open, `towards` it as usualView() says, so that all points
/// are seen; where it is to be turned (orbit), from every side. Returns why it stands so; nothing
/// where there was no choice. Throws Error{Input} on an eye that cannot look at the volumes.
std::optional<std::string> chooseCamera(SceneDescription& scene, std::vector<Vec3d> points,
                                        UpAxis up, Vec3d towards);

/// Turns a placed camera by its `orbit`, which is then done: around what it looks at; one that a
/// matrix places, around the points' middle.
void turnCamera(CameraDescription& camera, const std::vector<Vec3d>& points);

// Numbers that people can read, where any near the exact one will do.

/// `v` to a multiple of 10^exponent.
inline double roundTo(double v, int exponent) {
    const double power = std::pow(10, std::abs(exponent));
    return exponent < 0 ? std::round(v * power) / power : std::round(v / power) * power;
}
inline Vec3d roundTo(Vec3d v, int exponent) {
    return {roundTo(v.x, exponent), roundTo(v.y, exponent), roundTo(v.z, exponent)};
}
inline int magnitude(double v) { return static_cast<int>(std::floor(std::log10(v))); }

}  // namespace woodcock::scene
