// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "woodcock/base/error.h"
#include "woodcock/scene/scene_file.h"

namespace woodcock::test {

/// What is wrong with a scene's text, as the user reads it; empty when nothing is.
inline std::string mistakeIn(const std::string& text,
                             const std::vector<std::string>& overrides = {}) {
    try {
        scene::parseSceneText(text, "scene.toml", ".", overrides);
    } catch (const Error& e) {
        EXPECT_EQ(e.kind(), ErrorKind::Input);
        return e.what();
    }
    return "";
}

}  // namespace woodcock::test
