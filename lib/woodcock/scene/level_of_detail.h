// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "woodcock/base/vec.h"
#include "woodcock/camera/camera.h"
#include "woodcock/scene/load.h"

namespace woodcock::scene {

/// The width of a pixel in world units at the point of `box` next to the camera, as in the middle
/// of a picture without shift; 0 within the box of a perspective camera.
double pixelWidth(const camera::Camera& camera, int height, const Box3d& box);

/// Biased: halves the resolution of each grid (see coarsened()) as often as its voxels, by their
/// longest edge, stay at most description.render.levelOfDetail pixels wide where the box of what it
/// holds is next to the camera. Albedos are weighted by density where both grids have one
/// transform. What surfaces magnify is not thought of. Returns a note for each grid that changed.
std::vector<std::string> coarsenForCamera(const SceneDescription& description,
                                          const camera::Camera& camera, LoadedScene& loaded);

}  // namespace woodcock::scene
