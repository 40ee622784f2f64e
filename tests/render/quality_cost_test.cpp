// SPDX-License-Identifier: Apache-2.0
// Qualities are named in the order of what they cost, counted and not timed.
#include <gtest/gtest.h>

#include "woodcock/base/temp_dir.h"
#include "woodcock/proof/support/write_vdb.h"
#include "woodcock/render/session.h"
#include "woodcock/scene/build.h"
#include "woodcock/scene/quality.h"
#include "woodcock/scene/scene_file.h"

namespace woodcock::test {

using namespace proof;
using namespace render;
using namespace scene;

namespace {

constexpr const char* around = R"(
[[light]]
type = "sun"
elevation = 40
azimuth = 120
irradiance = 4
[[light]]
type = "environment"
radiance = 0.3
[camera]
eye = [8, 8, 60]
look_at = [8, 8, 8]
fov = 40
[render]
resolution = [60, 50]
)";
constexpr const char* cloud = "[[volume]]\nfile = \"cloud.vdb\"\nscale = 1.5\ng = 0.8\n";
constexpr const char* glass =
    "[[material]]\nname = \"glass\"\ntype = \"dielectric\"\nior = 1.5\n"
    "[[surface]]\nmaterial = \"glass\"\nsphere = { centre = [20, 8, 8], radius = 5 }\n";

/// Steps of the inner loops, for the same samples per pixel.
double workOf(const std::string& quality, const std::string& scene, int spp,
              const std::filesystem::path& directory) {
    const SceneDescription description = parseSceneText(
        scene + around + "quality = \"" + quality + "\"\nspp = " + std::to_string(spp),
        "scene.toml", directory);
    const Scene built = buildScene(description, loadScene(description));
    const RenderCounters c = render::render(built, renderSettings(description.render)).counters;
    return static_cast<double>(c.paths + c.scatterings + c.shadowRays + c.distanceSegments +
                               c.distanceCollisions + c.shadowSegments + c.shadowCollisions +
                               c.surfaceRays);
}

TEST(QualityCost, RisesInTheOrderOfTheirNames) {
    const TempDir dir;
    GridSpec grid;
    grid.box = {{0, 0, 0}, {15, 15, 15}};
    grid.value = [](Vec3i p) { return 0.2 + 0.05 * ((p.x * 7 + p.y * 5 + p.z * 3) % 16); };
    writeVdb(dir / "cloud.vdb", {grid});
    for (const std::string& scene : {std::string(cloud), std::string(cloud) + glass})
        for (const int spp : {8, 32, 128}) {
            const auto work = [&](const std::string& quality) {
                return workOf(quality, scene, spp, dir.path());
            };
            // Of the same samples: how well plans foretell the work shows below.
            const std::string even = "\"\nadaptive = false #";
            const double draft = work("draft" + even), preview = work("preview" + even),
                         final = work("final"), reference = work("reference");
            EXPECT_LT(draft, 0.95 * preview) << spp;
            EXPECT_LT(preview, 0.9 * reference) << spp;
            // As much work, where the plan foretells it well.
            EXPECT_LT(final, 1.05 * reference) << spp;
            EXPECT_GT(final, 0.8 * reference) << spp;
        }
}

}  // namespace
}  // namespace woodcock::test
