// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "woodcock/base/random.h"
#include "woodcock/scene/build.h"
#include "woodcock/surface/bsdf.h"

namespace woodcock::test {

using namespace light;
using namespace mesh;
using namespace render;
using namespace scene;
using namespace surface;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Two rectangles, the second a mirror image: a mixture of a material that emits to one side
/// and one that emits to both, all by images. And a plain emissive surface far away.
Scene emittersAndScreens() {
    SceneDescription description;
    description.camera.pose = LookAt{{0, 0, 5}, {}};
    description.materials = {{"lamp", EmissiveDescription{{{2, 1, 0.5}}, false}},
                             {"screen", EmissiveDescription{{{1, 2, 4}}, true}},
                             {"both", MixDescription{"lamp", "screen", {}}}};
    description.surfaces.resize(2);
    description.surfaces[0].material = "both";
    description.surfaces[1].material = "lamp";

    const auto image = [](std::uint64_t name) {
        RandomStream random(name);
        std::vector<float> rgb(5 * 4 * 3);
        for (float& v : rgb) v = static_cast<float>(random.uniform());
        return std::make_shared<const TextureImage>(5, 4, std::move(rgb));
    };
    LoadedScene loaded;
    loaded.textures = {image(1), image(2), image(3)};
    loaded.surfaces.resize(2);
    for (LoadedSurface& surface : loaded.surfaces)
        surface.mesh = std::make_shared<const SurfaceMesh>(rectangleMesh(2, 3));
    loaded.surfaces[0].instances = {Affine3d::translate({2, 0.5, 0}),
                                    Affine3d::translate({-2, 0, 0}) * Affine3d::scale({-1, 1, 2})};
    loaded.surfaces[1].instances = {Affine3d::translate({0, -3, 0})};
    return buildScene(description, std::move(loaded));
}

TEST(BuildEmission, SamplesSeeWhatRaysHit) {
    const Scene scene = emittersAndScreens();
    const SurfaceSet& surfaces = *scene.surfaces;
    const MeshLight& light = *scene.lights.mesh();
    ASSERT_EQ(light.triangles().size(), 6u);
    RandomStream random(4);
    std::array<int, 6> found{};
    for (int i = 0; i < 3000; ++i) {
        const auto r = [&] { return 6 * random.uniform() - 3; };
        const Vec3d from{r(), r(), r()};
        const double u0 = random.uniform();
        const LightSample s = light.sample(from, u0, random.uniform());
        const std::uint32_t triangle = s.emitter;
        SurfaceHit hit;
        if (!(s.pdf > 0) || !surfaces.geometry.intersect(from, s.direction, infinity, nullptr, hit))
            continue;
        if (surfaces.firstEmitter[hit.instance] + hit.primitive != triangle) continue;
        ++found[triangle];
        EXPECT_NEAR(hit.t / s.distance, 1, 1e-5);
        const Bsdf bsdf(surfaces.materials, surfaces.objects[hit.object].material,
                        {hit.normal, hit.shadingNormal, hit.u, hit.v});
        const Rgb emitted = bsdf.emitted(-s.direction);
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(s.weight[c] * s.pdf, emitted[c], 2e-4) << triangle;
        EXPECT_NEAR(light.pdf(from, triangle, hit.position) / s.pdf, 1, 1e-4);
    }
    for (int count : found) EXPECT_GT(count, 50);
}

}  // namespace
}  // namespace woodcock::test
