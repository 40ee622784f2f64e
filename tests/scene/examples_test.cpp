// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cstdlib>

#include "tests/support/paths.h"
#include "woodcock/render/session.h"
#include "woodcock/scene/build.h"
#include "woodcock/scene/defaults.h"
#include "woodcock/scene/scene_file.h"

namespace woodcock::test {

using namespace render;
using namespace scene;

namespace {

std::vector<std::filesystem::path> exampleFiles() {
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::directory_iterator(sourceDir() / "data/scenes"))
        if (entry.path().extension() == ".toml") files.push_back(entry.path());
    return files;
}

bool needsFiles(const SceneDescription& scene) {
    for (const VolumeDescription& volume : scene.volumes)
        if (!volume.file.empty()) return true;
    return false;
}

TEST(ExampleScenes, Parse) {
    ASSERT_EQ(setenv("WOODCOCK_SKY", "sky.hdr", 1), 0);
    const auto files = exampleFiles();
    EXPECT_GE(files.size(), 5u);
    for (const auto& file : files) EXPECT_NO_THROW(parseScene(file)) << file;
}

TEST(ExampleScenes, RenderWhereTheyNeedNoFile) {
    ASSERT_EQ(setenv("WOODCOCK_SKY", "sky.hdr", 1), 0);
    int rendered = 0;
    for (const auto& file : exampleFiles()) {
        SceneDescription description = parseScene(file);
        if (needsFiles(description)) continue;
        LoadedScene loaded = loadScene(description);
        completeScene(description, loaded);
        RenderSettings settings;
        settings.width = 32;
        settings.height = 27;
        settings.endSample = 4;
        const RenderResult result =
            render::render(buildScene(description, std::move(loaded)), settings);
        EXPECT_EQ(result.film.nonFiniteCount(), 0u);
        EXPECT_GT(result.film.alpha(16, 13), 0.2f) << file;
        // A ground reaches into the corner.
        if (description.surfaces.empty()) {
            EXPECT_LT(result.film.alpha(0, 0), 0.05f) << file;
        }
        double light = 0;
        for (int y = 0; y < 27; ++y)
            for (int x = 0; x < 32; ++x) light += result.film.radiance(x, y).mean();
        EXPECT_GT(light / (32 * 27), 0.01) << file;
        ++rendered;
    }
    EXPECT_GE(rendered, 1);
}

}  // namespace
}  // namespace woodcock::test
