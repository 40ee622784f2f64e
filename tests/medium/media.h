// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "woodcock/proof/support/plain_medium.h"

namespace woodcock::test {

inline const std::array<float, 3> haze{0.05f, 0.025f, 0.1f};

/// Sheared, mirrored, turned and shifted; voxels about half a unit wide.
inline Affine3d awkwardTransform() {
    return Affine3d::translate({100, -7, 3}) * Affine3d::rotate(1, 25) *
           Affine3d{{Vec3d{0.5, 0, 0.1}, Vec3d{0.2, -0.5, 0}, Vec3d{0, 0.1, 0.7}}, {}};
}

inline proof::PlainMedium greyMedium() {
    return proof::PlainMedium(
        {{.grid = proof::mixedGrid(1), .absorption = Rgb(0.05f), .scattering = Rgb(0.15f)}});
}

/// A sparse table, large tiles, a background that never ends, awkward voxels.
inline proof::PlainMedium hazyMedium() {
    return proof::PlainMedium({{.grid = proof::scatteredGrid(2, 1, {0.05f}),
                                .worldFromIndex = awkwardTransform(),
                                .absorption = Rgb(0.05f),
                                .scattering = Rgb(0.2f)}});
}

/// Overlapping parts of every kind, all different in every channel.
inline proof::PlainMedium chromaticMedium() {
    const Affine3d turned = awkwardTransform() * Affine3d::rotate(0, 50);
    return proof::PlainMedium(
        {{.grid = proof::mixedGrid(3),
          .worldFromIndex = awkwardTransform(),
          .absorption = {0.05f, 0.3f, 0},
          .scattering = {0.3f, 0.1f, 0.02f},
          .g = 0.5},
         {.grid = proof::mixedGrid(4, 3, haze),
          .worldFromIndex = turned,
          .absorption = {0, 0.1f, 0.2f},
          .scattering = {0.1f, 0.2f, 0.3f},
          .albedo = proof::mixedGrid(5, 3, {0.5f, 0.25f, 1}),
          .albedoWorldFromIndex = awkwardTransform() * Affine3d::scale({2, 2, 2}),
          .g = -0.3},
         {.grid = {},
          .box = {{-2.3, -3.2, -4.1}, {5.2, 4.3, 3.4}},
          .worldFromIndex = turned,
          .absorption = {0.01f, 0.02f, 0},
          .scattering = {0, 0.05f, 0.1f}}});
}

/// Only absorbs, and differently in each channel.
inline proof::PlainMedium tintedGlass() {
    return proof::PlainMedium({{.grid = proof::mixedGrid(6, 3),
                                .absorption = {0.4f, 0.1f, 0.02f},
                                .scattering = Rgb(0.0f)}});
}

}  // namespace woodcock::test
