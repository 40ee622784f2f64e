// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "woodcock/scene/description.h"

namespace woodcock::scene {

/// The scene file that parses back to an equal description; what is at its default is left out.
/// Relative paths of `scene` count from the working directory; the text is made to lie in
/// `directory`. Throws Error{Usage} where TOML cannot say it (a seed of 2^63 or more).
std::string writeScene(const SceneDescription& scene, const std::filesystem::path& directory = ".");

/// One section of it, with its heading; paths as they are.
std::string writeVolume(const VolumeDescription& volume);
std::string writeCamera(const CameraDescription& camera);
std::string writeLight(const LightDescription& light);

/// 16 hex digits that tell scenes apart: over all that determines what the image shows, whatever
/// way the file was written. Left out are the output, the number of samples, the seed and the
/// limits of time and noise. Identifies; secures nothing.
std::string sceneDigest(const SceneDescription& scene);

}  // namespace woodcock::scene
