// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "woodcock/scene/description.h"

namespace woodcock::scene {

/// Reads and checks a scene file; nothing that it names is opened. Relative paths in it are
/// relative to its directory. Each of `overrides` ("volume[0].scale=2", "render.spp=16") replaces
/// one value before the check; a relative path in an override is relative to the working directory.
/// Throws Error{Input} with file, line, column, the value and what was expected, for the first
/// mistake; Error{Usage} for an override that is no KEY=VALUE.
SceneDescription parseScene(const std::filesystem::path& file,
                            const std::vector<std::string>& overrides = {});

/// The same of a text in memory; `name` stands for the file in messages.
SceneDescription parseSceneText(std::string_view text, const std::string& name,
                                const std::filesystem::path& baseDirectory,
                                const std::vector<std::string>& overrides = {});

/// The scene file that parses back to an equal description; what is at its default is left out.
/// Relative paths of `scene` count from the working directory; the text is made to lie in
/// `directory`. Throws Error{Usage} where TOML cannot say it (a seed of 2^63 or more).
std::string writeScene(const SceneDescription& scene, const std::filesystem::path& directory = ".");

/// One section of it, with its heading; paths as they are.
std::string writeVolume(const VolumeDescription& volume);
std::string writeCamera(const CameraDescription& camera);
std::string writeLight(const LightDescription& light);
std::string writeMaterial(const MaterialDescription& material);
std::string writeSurface(const SurfaceDescription& surface);
std::string writeOutput(const OutputDescription& output);

/// 16 hex digits that tell scenes apart: over all that determines what the image shows, whatever
/// way the file was written. Left out are the output, the number of samples, the seed and the
/// limits of time and noise. Identifies; secures nothing.
std::string sceneDigest(const SceneDescription& scene);

/// 16 hex digits that tell apart what the files of a scene hold, wherever they lie: over the size
/// of each, and its first and last 64 KiB. A volume that is baked anew has another, as its file
/// names itself or differs in size. Throws Error{Input} where a file cannot be read.
std::string filesDigest(const SceneDescription& scene);

/// The files that a scene reads, but for the OpenColorIO config: of volumes, lights, materials and
/// surfaces.
std::vector<std::filesystem::path*> sceneFiles(SceneDescription& scene);

}  // namespace woodcock::scene
