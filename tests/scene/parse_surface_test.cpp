// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>

#include "woodcock/scene/check_surfaces.h"
#include "woodcock/scene/scene_file.h"

namespace woodcock::test {

using namespace scene;

namespace {

SceneDescription parse(const std::string& text, const std::vector<std::string>& overrides = {}) {
    return parseSceneText(text, "scene.toml", ".", overrides);
}
const std::string glass = "[[material]]\nname = \"glass\"\ntype = \"dielectric\"\n";

template <class Kind>
Kind material(const std::string& lines) {
    const auto scene = parse("[[surface]]\nplane = {}\n[[material]]\nname = \"m\"\n" + lines);
    EXPECT_EQ(scene.materials.at(0).name, "m");
    return std::get<Kind>(scene.materials.at(0).material);
}
SurfaceDescription surface(const std::string& lines) {
    return parse(glass + "[[surface]]\n" + lines).surfaces.at(0);
}

TEST(ParseMaterial, Diffuse) {
    EXPECT_EQ(material<DiffuseDescription>("type = \"diffuse\"").colour.colour, Rgb(0.8f));
    EXPECT_EQ(material<DiffuseDescription>("type = \"diffuse\"\ncolour = [0, 0.5, 1]").colour,
              (TextureDescription{Rgb(0, 0.5f, 1), {}, {}}));
    EXPECT_EQ(material<DiffuseDescription>(
                  "type = \"diffuse\"\n"
                  "colour = { image = \"w.png\", colour_space = \"raw\", times = [0.5, 1, 2] }")
                  .colour,
              (TextureDescription{Rgb(0.5f, 1, 2), "w.png", "raw"}));
}

TEST(ParseMaterial, Conductor) {
    const auto plain = material<ConductorDescription>("type = \"conductor\"\nroughness = 0.25");
    EXPECT_EQ(plain, (ConductorDescription{{Rgb(0.9f), {}, {}}, {}, 0.25}));
    const auto gold = material<ConductorDescription>(
        "type = \"conductor\"\neta = [0.14, 0.38, 1.4]\nk = [3.9, 2.5, 0]");
    ASSERT_TRUE(gold.etaK);
    EXPECT_EQ(gold.etaK->first, Rgb(0.14f, 0.38f, 1.4f));
    EXPECT_EQ(gold.etaK->second, Rgb(3.9f, 2.5f, 0));
}

TEST(ParseMaterial, Dielectric) {
    EXPECT_EQ(material<DielectricDescription>("type = \"dielectric\""),
              (DielectricDescription{1.5, 0}));
    EXPECT_EQ(material<DielectricDescription>("type = \"dielectric\"\nior = 1\nroughness = 1"),
              (DielectricDescription{1, 1}));
    EXPECT_EQ(
        material<DielectricDescription>("type = \"dielectric\"\nior = 0.75\nior_below_one = true"),
        (DielectricDescription{0.75, 0}));
}

TEST(ParseMaterial, EmissiveInterfaceAndMix) {
    EXPECT_EQ(material<EmissiveDescription>(
                  "type = \"emissive\"\nradiance = [5, 4, 3]\nboth_sides = true"),
              (EmissiveDescription{{Rgb(5, 4, 3), {}, {}}, true}));
    material<InterfaceDescription>("type = \"interface\"");
    const auto mix = material<MixDescription>(
        "type = \"mix\"\nfirst = \"a\"\nsecond = \"b\"\nweight = { image = \"mask.png\" }\n"
        "[[material]]\nname = \"a\"\ntype = \"diffuse\"\n"
        "[[material]]\nname = \"b\"\ntype = \"interface\"");
    EXPECT_EQ(mix, (MixDescription{"a", "b", {Rgb(1), "mask.png", {}}}));
}

TEST(ParseSurface, Shapes) {
    EXPECT_EQ(std::get<MeshShape>(surface("file = \"a.obj\"").shape), (MeshShape{"a.obj", ""}));
    EXPECT_EQ(std::get<MeshShape>(surface("file = \"a.vdb\"\nlevel_set = \"ls\"").shape),
              (MeshShape{"a.vdb", "ls"}));
    EXPECT_EQ(std::get<SphereShape>(surface("sphere = {}").shape), (SphereShape{{0, 0, 0}, 1}));
    EXPECT_EQ(std::get<SphereShape>(surface("sphere = { centre = [1, 2, 3], radius = 0.5 }").shape),
              (SphereShape{{1, 2, 3}, 0.5}));
    EXPECT_EQ(std::get<BoxShape>(surface("box = { min = [0, 1, 2], max = [1, 2, 4] }").shape),
              (BoxShape{{{0, 1, 2}, {1, 2, 4}}}));
    EXPECT_EQ(std::get<DiskShape>(surface("disk = { radius = 3 }").shape), (DiskShape{3}));
    EXPECT_FALSE(std::get<PlaneShape>(surface("plane = {}").shape).size);
    EXPECT_EQ(std::get<PlaneShape>(surface("plane = { size = [2, 3] }").shape).size,
              (std::array<double, 2>{2, 3}));
    EXPECT_EQ(std::get<LatheShape>(
                  surface("lathe = { profile = [[0, 0], [1, 0.5], [0, 1]], segments = 8 }").shape),
              (LatheShape{{{0, 0}, {1, 0.5}, {0, 1}}, 8}));
}

TEST(ParseSurface, SmoothingIsAnAngleOrAWord) {
    EXPECT_FALSE(surface("file = \"a.obj\"").smooth);
    EXPECT_FALSE(surface("file = \"a.obj\"\nsmooth = \"file\"").smooth);
    EXPECT_EQ(surface("file = \"a.obj\"\nsmooth = \"flat\"").smooth, 0);
    EXPECT_EQ(surface("file = \"a.obj\"\nsmooth = 30").smooth, 30);
}

TEST(ParseSurface, InstancesAreTransformsMatricesOrAFile) {
    EXPECT_TRUE(surface("sphere = {}").instances.empty());
    EXPECT_EQ(surface("sphere = {}\ninstances = \"trees.txt\"").instanceFile, "trees.txt");
    const auto both = surface(
        "sphere = {}\ntransform = { translate = [0, 1, 0] }\ninstances = [{ scale = 2 }, "
        "[[1, 0, 0, 5], [0, 1, 0, 6], [0, 0, 1, 7], [0, 0, 0, 1]]]");
    EXPECT_EQ(both.worldFromObject, Affine3d::translate({0, 1, 0}));
    EXPECT_EQ(both.instances,
              (std::vector{Affine3d::scale({2, 2, 2}), Affine3d::translate({5, 6, 7})}));
}

TEST(ParseSurface, MediumByCoefficients) {
    const auto s = surface(
        "sphere = {}\nmaterial = \"glass\"\npriority = -3\n"
        "medium = { sigma_a = [1, 2, 3], sigma_s = 4, g = 0.5 }");
    EXPECT_EQ(s.interior, (InteriorDescription{Rgb(1, 2, 3), Rgb(4), 0.5f}));
    EXPECT_EQ(s.priority, -3);
    EXPECT_EQ(surface("sphere = {}\nmaterial = \"glass\"\nmedium = { scale = 4, albedo = 0.75 }")
                  .interior,
              (InteriorDescription{Rgb(1), Rgb(3), 0}));
    EXPECT_EQ(
        surface("sphere = {}\nmaterial = \"glass\"\nmedium = { emission = [1, 2, 3] }").interior,
        (InteriorDescription{Rgb(0), Rgb(0), 0, {}, Rgb(1, 2, 3)}));
}

TEST(ParseSurface, MediumByColourAtADistance) {
    const auto s = surface(
        "sphere = {}\nmaterial = \"glass\"\n"
        "medium = { colour = [0.5, 0.25, 1], distance = 2, sigma_s = 0.1 }");
    ASSERT_TRUE(s.interior);
    // Beer and Lambert: what is left after the distance is the colour.
    const double expected[3] = {0.5, 0.25, 1};
    for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(std::exp(-2.0 * s.interior->sigmaA[c]), expected[c], 1e-7);
    EXPECT_FALSE(std::signbit(s.interior->sigmaA[2]));
    EXPECT_EQ(s.interior->sigmaS, Rgb(0.1f));
}

TEST(ParseSurface, Compositing) {
    EXPECT_TRUE(surface("plane = {}").cameraVisible);
    EXPECT_TRUE(surface("plane = {}\nholdout = true").holdout);
    EXPECT_TRUE(surface("plane = {}\nshadow_catcher = true").shadowCatcher);
    EXPECT_TRUE(surface("plane = {}\nmatte = true").matte);
    EXPECT_FALSE(surface("plane = {}\ncamera_visible = false").cameraVisible);
}

TEST(ParseSurface, RenderAndOutput) {
    const auto scene = parse(
        "[[surface]]\nplane = {}\n[render]\nmax_bounces = 7\ntransparent_shadows = true\n"
        "[output]\nlayers = [\"normal\", \"depth\"]");
    EXPECT_EQ(scene.render.maxBounces, 7);
    EXPECT_TRUE(scene.render.approximations.transparentShadows);
    EXPECT_EQ(scene.output.layers, (std::vector<std::string>{"normal", "depth"}));
}

TEST(ParseSurface, VolumeInsideASurface) {
    const auto scene = parse(glass +
                             "[[surface]]\nname = \"ball\"\nsphere = {}\nmaterial = \"glass\"\n"
                             "[[volume]]\nfile = \"a.vdb\"\ninside = \"ball\"");
    EXPECT_EQ(scene.volumes.at(0).inside, "ball");
}

TEST(ParseSurface, OverridesReachMaterialsAndSurfaces) {
    const auto scene = parse(
        glass + "[[surface]]\nsphere = {}\nmaterial = \"glass\"",
        {"material[0].ior=1.33", "surface[0].sphere.radius=3", "surface[0].instances=places.txt"});
    EXPECT_EQ(std::get<DielectricDescription>(scene.materials[0].material).ior, 1.33);
    EXPECT_EQ(std::get<SphereShape>(scene.surfaces[0].shape).radius, 3);
    EXPECT_EQ(scene.surfaces[0].instanceFile, "places.txt");
}

TEST(SurfaceNature, FollowsFromTheMaterial) {
    const auto scene = parse(
        "[[material]]\nname = \"water\"\ntype = \"dielectric\"\nior = 1.33\n"
        "[[material]]\nname = \"air\"\ntype = \"interface\"\n"
        "[[material]]\nname = \"leaf\"\ntype = \"diffuse\"\n"
        "[[material]]\nname = \"lamp\"\ntype = \"emissive\"\n"
        "[[material]]\nname = \"cutout\"\ntype = \"mix\"\nfirst = \"air\"\nsecond = \"leaf\"\n"
        "[[material]]\nname = \"glow\"\ntype = \"mix\"\nfirst = \"lamp\"\nsecond = \"water\"\n"
        "[[surface]]\nsphere = {}\nmaterial = \"water\"\n"
        "[[surface]]\nsphere = {}\nmaterial = \"air\"\n"
        "[[surface]]\nsphere = {}\nmaterial = \"leaf\"\n"
        "[[surface]]\nsphere = {}\n"
        "[[surface]]\nplane = { size = [1, 1] }\nmaterial = \"cutout\"\n"
        "[[surface]]\nsphere = {}\nmaterial = \"cutout\"\nmedium = { sigma_a = 1 }\n"
        "[[surface]]\nsphere = {}\nmaterial = \"glow\"\n");
    const auto expect = [&](size_t i, bool letsIn, bool encloses, bool emits, double ior) {
        const SurfaceNature nature = natureOf(scene, i);
        EXPECT_EQ(nature.letsLightIn, letsIn) << i;
        EXPECT_EQ(nature.encloses, encloses) << i;
        EXPECT_EQ(nature.emits, emits) << i;
        EXPECT_EQ(nature.ior, ior) << i;
    };
    expect(0, true, true, false, 1.33);
    expect(1, true, true, false, 1);
    expect(2, false, false, false, 1);
    expect(3, false, false, false, 1);
    expect(4, true, false, false, 1);  // a sheet with holes
    expect(5, true, true, false, 1);
    expect(6, true, true, true, 1.33);
}

}  // namespace
}  // namespace woodcock::test
