// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "woodcock/base/error.h"
#include "woodcock/scene/build.h"
#include "woodcock/scene/scene_file.h"

namespace woodcock::test {

/// A light and a camera for what a test builds.
inline const std::string lightAndCamera = R"(
[[light]]
type = "environment"
[camera]
eye = [0, 0, 10]
look_at = [0, 0, 0]
)";

struct BuiltScene {
    render::Scene scene;
    scene::LoadedScene loaded;
};

/// Of a text without light and camera, beside the files of `base`.
inline BuiltScene buildLit(const std::string& text, const std::filesystem::path& base = ".") {
    const scene::SceneDescription description =
        scene::parseSceneText(text + lightAndCamera, "scene.toml", base, {});
    const scene::LoadedScene loaded = scene::loadScene(description);
    return {scene::buildScene(description, loaded), loaded};
}

/// What is said of the input that is wrong; empty where nothing is.
inline std::string buildMistake(const std::string& text, const std::filesystem::path& base = ".") {
    try {
        buildLit(text, base);
    } catch (const Error& e) {
        EXPECT_EQ(e.kind(), ErrorKind::Input);
        return e.what();
    }
    return "";
}

}  // namespace woodcock::test
