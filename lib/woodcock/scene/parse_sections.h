// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "woodcock/scene/description.h"
#include "woodcock/scene/toml_reader.h"

namespace woodcock {

// The sections of a scene file, one function each. Of scene/ only; all throw Error{Input}.

VolumeDescription parseVolume(const SceneTable& table, const std::filesystem::path& base);
LightDescription parseLight(const SceneTable& table, const std::filesystem::path& base);
/// `aspect` is the image's width over its height: a sensor's width needs it.
CameraDescription parseCamera(const SceneTable& table, double aspect);
RenderDescription parseRender(const SceneTable& table);
OutputDescription parseOutput(const SceneTable& table, const std::filesystem::path& base);

}  // namespace woodcock
