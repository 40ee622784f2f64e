// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "woodcock/base/toml_reader.h"
#include "woodcock/scene/description.h"

namespace woodcock {

// The sections of a scene file, one function each. Of scene/ only; all throw Error{Input}.

VolumeDescription parseVolume(const TomlTable& table, const std::filesystem::path& base);
MaterialDescription parseMaterial(const TomlTable& table, const std::filesystem::path& base);
SurfaceDescription parseSurface(const TomlTable& table, const std::filesystem::path& base);
LightDescription parseLight(const TomlTable& table, const std::filesystem::path& base);
/// All [[light]] sections.
std::vector<LightDescription> parseLights(const TomlTable& scene,
                                          const std::filesystem::path& base);
/// `aspect` is the image's width over its height: a sensor's width needs it.
CameraDescription parseCamera(const TomlTable& table, double aspect);
RenderDescription parseRender(const TomlTable& table);
OutputDescription parseOutput(const TomlTable& table, const std::filesystem::path& base);

}  // namespace woodcock
