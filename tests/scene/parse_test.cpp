// SPDX-License-Identifier: Apache-2.0
#include "woodcock/scene/scene_file.h"

#include <gtest/gtest.h>

#include <cstdlib>

#include "tests/support/paths.h"
#include "woodcock/base/error.h"

namespace woodcock::test {

using namespace grid;
using namespace render;
using namespace scene;
namespace {

SceneDescription parse(const std::string& text, const std::vector<std::string>& overrides = {}) {
    return parseSceneText(text, "scene.toml", ".", overrides);
}
VolumeDescription volume(const std::string& lines) {
    return parse("[[volume]]\nfile = \"a.vdb\"\n" + lines).volumes.at(0);
}
template <class Light>
Light light(const std::string& lines) {
    const auto scene = parse("[[volume]]\nfile = \"a.vdb\"\n[[light]]\n" + lines);
    return std::get<Light>(scene.lights.at(0).light);
}
SceneDescription section(const std::string& lines) {
    return parse("[[volume]]\nfile = \"a.vdb\"\n" + lines);
}
void expectNear(Vec3d a, Vec3d b) {
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(a[i], b[i], 1e-12) << "component " << i;
}

TEST(Parse, LeavesDefaultsAndTheProgramsChoicesOpen) {
    const SceneDescription scene = parse("[[volume]]\nfile = \"a.vdb\"");
    SceneDescription expected;
    expected.volumes.resize(1);
    expected.volumes[0].file = "a.vdb";
    expected.places = {{"volume", "scene.toml:1:1"},
                       {"volume[0]", "scene.toml:1:1"},
                       {"volume[0].file", "scene.toml:2:8"}};
    EXPECT_EQ(scene, expected);
    EXPECT_FALSE(std::get<DensityCoefficients>(scene.volumes[0].coefficients).scale);
    EXPECT_FALSE(scene.camera.pose);
}

TEST(Parse, DensityWithScaleAndAlbedo) {
    const VolumeDescription v = volume(
        "density = \"smoke\"\nscale = 3\nalbedo = [0.5, 0.25, 1]\nalbedo_grid = \"Cd\"\n"
        "g = -0.5\nstorage = \"half\"\nrepair = true");
    const auto& c = std::get<DensityCoefficients>(v.coefficients);
    EXPECT_EQ(c.density, "smoke");
    EXPECT_EQ(c.scale, Rgb(3.0f));
    EXPECT_EQ(c.albedo, (Vec3d{0.5, 0.25, 1.0}));
    EXPECT_EQ(c.albedoGrid, "Cd");
    EXPECT_EQ(v.g, -0.5f);
    EXPECT_EQ(v.storage, Storage::Half);
    EXPECT_TRUE(v.repair);
}

TEST(Parse, SeparateCoefficients) {
    const auto c = std::get<SeparateCoefficients>(
        volume("sigma_a = { grid = \"soot\", scale = [1, 2, 3] }\nsigma_s = 4").coefficients);
    EXPECT_EQ(c.sigmaA, (GridCoefficient{"soot", Rgb(1, 2, 3)}));
    EXPECT_EQ(c.sigmaS, (GridCoefficient{"", Rgb(4)}));
    const auto named =
        std::get<SeparateCoefficients>(volume("density = \"d\"\nsigma_s = [1, 2, 3]").coefficients);
    EXPECT_FALSE(named.sigmaA);
    EXPECT_EQ(named.sigmaS, (GridCoefficient{"d", Rgb(1, 2, 3)}));
    const auto unscaled =
        std::get<SeparateCoefficients>(volume("sigma_a = { grid = \"soot\" }").coefficients);
    EXPECT_EQ(unscaled.sigmaA, (GridCoefficient{"soot", Rgb(1)}));
}

TEST(Parse, HomogeneousBoxes) {
    const std::string box = "[[volume]]\nbox = { min = [-1, -2, -3], max = [1, 2, 3] }\n";
    const auto a =
        std::get<HomogeneousBox>(parse(box + "sigma_s = [1, 2, 3]").volumes[0].coefficients);
    EXPECT_EQ(a.box, (Box3d{{-1, -2, -3}, {1, 2, 3}}));
    EXPECT_EQ(a.sigmaA, Rgb(0));
    EXPECT_EQ(a.sigmaS, Rgb(1, 2, 3));
    const auto b =
        std::get<HomogeneousBox>(parse(box + "scale = 4\nalbedo = 0.75").volumes[0].coefficients);
    EXPECT_EQ(b.sigmaA, Rgb(1));
    EXPECT_EQ(b.sigmaS, Rgb(3));
}

TEST(Parse, TransformScalesThenRotatesThenTranslates) {
    const Affine3d m =
        volume("transform = { translate = [10, 20, 30], rotate = [0, 90, 0], scale = [2, 3, 4] }")
            .worldFromObject;
    // A right-handed quarter turn about y takes x to -z and z to x.
    expectNear(m.point({1, 1, 1}), {10 + 4, 20 + 3, 30 - 2});
    // About x first: y to z; then about z, which leaves z alone.
    const Affine3d n = volume("transform = { rotate = [90, 0, 90] }").worldFromObject;
    expectNear(n.point({0, 1, 0}), {0, 0, 1});
    expectNear(n.point({1, 0, 0}), {0, 1, 0});
    expectNear(volume("transform = { scale = 2 }").worldFromObject.point({1, 2, 3}), {2, 4, 6});
}

TEST(Parse, MatrixRowsMapColumns) {
    const Affine3d m =
        volume("matrix = [[1, 2, 3, 4], [0, 1, 5, 6], [0, 0, 1, 7], [0, 0, 0, 1]]").worldFromObject;
    EXPECT_EQ(m.point({1, 10, 100}), (Vec3d{325, 516, 107}));
}

TEST(Parse, SunStandsWhereItsAnglesSay) {
    const auto direction = [](const std::string& lines) {
        return light<SunDescription>("type = \"sun\"\n" + lines).direction;
    };
    expectNear(direction("elevation = 90"), {0, -1, 0});
    expectNear(direction("elevation = 0"), {0, 0, 1});                 // stands at -z
    expectNear(direction("elevation = 0\nazimuth = 90"), {-1, 0, 0});  // stands at +x
    expectNear(direction("elevation = 30\nazimuth = 180"), {0, -0.5, -std::sqrt(0.75)});
    expectNear(direction("elevation = 90\nup = \"z\""), {0, 0, -1});
    expectNear(direction("elevation = 0\nup = \"z\""), {0, -1, 0});
    expectNear(direction("elevation = 0\nazimuth = 90\nup = \"z\""), {-1, 0, 0});
    EXPECT_EQ(direction("direction = [0, -3, 4]"), (Vec3d{0, -3, 4}));
}

TEST(Parse, Lights) {
    const auto sun = light<SunDescription>(
        "type = \"sun\"\ndirection = [0, -1, 0]\nirradiance = [3, 2, 1]\n"
        "angular_diameter = 0.5\nvisible = true");
    EXPECT_EQ(sun.irradiance, Rgb(3, 2, 1));
    EXPECT_EQ(sun.angularDiameter, 0.5);
    EXPECT_TRUE(sun.visible);

    const auto environment = light<EnvironmentDescription>(
        "type = \"environment\"\nradiance = 0.5\nimage = \"sky.exr\"\nrotation = 30\nup = \"z\"\n"
        "visible = false");
    EXPECT_EQ(environment.radiance, Rgb(0.5f));
    EXPECT_EQ(environment.image, "sky.exr");
    EXPECT_EQ(environment.rotation, 30);
    EXPECT_EQ(environment.up, UpAxis::Z);
    EXPECT_FALSE(environment.visible);

    const auto point =
        light<PointDescription>("type = \"point\"\nposition = [1, 2, 3]\nintensity = [1, 2, 3]");
    EXPECT_EQ(point.position, (Vec3d{1, 2, 3}));
    EXPECT_EQ(point.intensity, Rgb(1, 2, 3));

    const auto sphere = light<SphereDescription>(
        "type = \"sphere\"\nposition = [1, 2, 3]\nradius = 2\nradiance = 7\nvisible = false");
    EXPECT_EQ(sphere.radius, 2);
    EXPECT_EQ(sphere.radiance, Rgb(7));
    EXPECT_FALSE(sphere.visible);
}

TEST(Parse, PowerIsWhatTheLightSendsOut) {
    // 4 pi steradians of intensity; 4 pi r^2 of area, each of pi x radiance.
    EXPECT_NEAR(light<PointDescription>("type = \"point\"\nposition = [0, 0, 0]\npower = 12.566371")
                    .intensity[0],
                1, 1e-6);
    EXPECT_NEAR(light<SphereDescription>(
                    "type = \"sphere\"\nposition = [0, 0, 0]\nradius = 2\npower = 157.913670")
                    .radiance[2],
                1, 1e-6);
}

TEST(Parse, Cameras) {
    const auto lookAt =
        section("[camera]\neye = [0, 1, 5]\nlook_at = [0, 0, 0]\nup = [0, 0, 1]\nfov = 30").camera;
    EXPECT_EQ(std::get<LookAt>(*lookAt.pose), (LookAt{{0, 1, 5}, {0, 0, 0}, {0, 0, 1}}));
    EXPECT_EQ(lookAt.fovY, 30);

    const auto matrix = section(
                            "[camera]\ntype = \"orthographic\"\nheight = 3\nmatrix = "
                            "[[0, 0, 2, 4], [0, 2, 0, 5], [-2, 0, 0, 6], [0, 0, 0, 1]]")
                            .camera;
    EXPECT_EQ(matrix.kind, CameraDescription::Kind::Orthographic);
    EXPECT_EQ(matrix.height, 3);
    const auto pose = std::get<Affine3d>(*matrix.pose);
    expectNear(pose.column[0], {0, 0, -1});  // freed of its scale
    expectNear(pose.column[2], {1, 0, 0});
    EXPECT_EQ(pose.translation, (Vec3d{4, 5, 6}));

    const auto shifted = section("[camera]\nshift = [0.25, -1]").camera;
    EXPECT_EQ(shifted.shift, (std::array<double, 2>{0.25, -1}));
    EXPECT_EQ(section("[camera]\nfov = 20").camera.shift, (std::array<double, 2>{0, 0}));
    EXPECT_EQ(section("[camera]\nfov = 20").camera.shutter, camera::Shutter{});
    EXPECT_EQ(section("[camera]\nshutter = 0.5").camera.shutter, (camera::Shutter{-0.25, 0.25}));
    EXPECT_EQ(section("[camera]\nshutter = [0, 1]").camera.shutter, (camera::Shutter{0, 1}));
    const auto angleOnly = section("[camera]\nfov = 20").camera;
    EXPECT_FALSE(angleOnly.pose);
    EXPECT_EQ(angleOnly.fovY, 20);
}

TEST(Parse, FocalLengthAndSensorGiveTheAngle) {
    // A sensor twice as high as the lens is long: 90 degrees.
    EXPECT_NEAR(section("[camera]\nfocal_length = 12\nsensor_height = 24").camera.fovY, 90, 1e-12);
    // 36 mm wide at 2:1 is 18 mm high.
    EXPECT_NEAR(section("[camera]\nfocal_length = 9\nsensor_width = 36\n[render]\nresolution = "
                        "[200, 100]")
                    .camera.fovY,
                90, 1e-12);
}

TEST(Parse, RenderSettings) {
    const auto render =
        section(
            "[render]\nresolution = [320, 200]\nspp = 7\nseed = 9223372036854775807\n"
            "max_scatterings = 0\ntime_limit = \"2m\"\nnoise = \"1%\"\nmajorant_scale = 2")
            .render;
    EXPECT_EQ(render.width, 320);
    EXPECT_EQ(render.height, 200);
    EXPECT_EQ(render.spp, 7);
    EXPECT_EQ(render.seed, 9223372036854775807u);
    EXPECT_EQ(render.maxScatterings, 0);
    EXPECT_EQ(render.timeLimit, 120);
    EXPECT_DOUBLE_EQ(render.noise, 0.01);
    EXPECT_EQ(render.majorantScale, 2);
    const auto numbers = section("[render]\ntime_limit = 1.5\nnoise = 0.02").render;
    EXPECT_EQ(numbers.timeLimit, 1.5);
    EXPECT_EQ(numbers.noise, 0.02);
}

TEST(Parse, BiasedChoices) {
    const RenderDescription none = section("[render]\nspp = 1").render;
    EXPECT_EQ(none.approximations, Approximations());
    const RenderDescription render =
        section(
            "[render]\nmarch_step = 0.5\nmarch_estimate = \"exponential\"\nsimilarity_after = 0\n"
            "clamp = 10\ntransparent_shadows = true\nstorage = \"half\"\nlookup = \"nearest\"\n"
            "level_of_detail = 1.5\nadaptive = true")
            .render;
    const Approximations& a = render.approximations;
    EXPECT_EQ(a.marchStep, 0.5);
    EXPECT_FALSE(a.jackknife);
    EXPECT_EQ(a.similarityAfter, 0);
    EXPECT_EQ(a.clamp, 10);
    EXPECT_TRUE(a.transparentShadows);
    EXPECT_EQ(render.storage, Storage::Half);
    EXPECT_EQ(render.lookup, Lookup::Nearest);
    EXPECT_EQ(render.levelOfDetail, 1.5);
    EXPECT_EQ(render.adaptive, true);
    EXPECT_EQ(section("[render]\noctaves = 4").render.approximations.octaves, 4);
}

TEST(Parse, OutputSettings) {
    const SceneDescription scene = parse(
        "ocio = \"config.ocio\"\n[[volume]]\nfile = \"a.vdb\"\n[output]\nfiles = [\"a.exr\", "
        "\"b/c.PNG\"]\nlayers = [\"depth\", \"transmittance\", \"samples\", \"error\"]\nhalf = "
        "true\ndisplay = \"sRGB\"\nview = \"Filmic\"\nlook = \"Contrast\"\nexposure = -1.5");
    EXPECT_EQ(scene.ocio, "config.ocio");
    EXPECT_EQ(scene.output.files, (std::vector<std::filesystem::path>{"a.exr", "b/c.PNG"}));
    EXPECT_EQ(scene.output.layers,
              (std::vector<std::string>{"depth", "transmittance", "samples", "error"}));
    EXPECT_TRUE(scene.output.half);
    EXPECT_EQ(scene.output.display, "sRGB");
    EXPECT_EQ(scene.output.view, "Filmic");
    EXPECT_EQ(scene.output.look, "Contrast");
    EXPECT_EQ(scene.output.exposure, -1.5);
}

TEST(Parse, PathsAreRelativeToTheSceneAndExpanded) {
    ASSERT_EQ(setenv("WOODCOCK_TEST_SHOT", "shot7", 1), 0);
    const std::string home = std::getenv("HOME") ? std::getenv("HOME") : "";
    ASSERT_EQ(setenv("HOME", "/home/ada", 1), 0);
    const auto file = [](const std::string& written) {
        return parseSceneText("[[volume]]\nfile = '" + written + "'", "s.toml", "jobs/a", {})
            .volumes[0]
            .file;
    };
    EXPECT_EQ(file("smoke.vdb"), "jobs/a/smoke.vdb");
    EXPECT_EQ(file("../b/smoke.vdb"), "jobs/b/smoke.vdb");
    EXPECT_EQ(file("/abs/smoke.vdb"), "/abs/smoke.vdb");
    EXPECT_EQ(file("$WOODCOCK_TEST_SHOT/a.vdb"), "jobs/a/shot7/a.vdb");
    EXPECT_EQ(file("${WOODCOCK_TEST_SHOT}b.vdb"), "jobs/a/shot7b.vdb");
    EXPECT_EQ(file("cost$$.vdb"), "jobs/a/cost$.vdb");
    EXPECT_EQ(file("~/a.vdb"), "/home/ada/a.vdb");
    EXPECT_EQ(file("~b/a.vdb"), "jobs/a/~b/a.vdb");
    ASSERT_EQ(setenv("HOME", home.c_str(), 1), 0);
}

TEST(Parse, ReadsFiles) {
    const TempDir dir;
    writeText(dir / "scene.toml", "[[volume]]\nfile = \"a.vdb\"");
    const SceneDescription scene = parseScene(dir / "scene.toml");
    EXPECT_EQ(scene.volumes.at(0).file, dir / "a.vdb");
    EXPECT_EQ(scene.places.at("volume[0].file"), (dir / "scene.toml").string() + ":2:8");
}

TEST(Overrides, ReplaceAndAddValues) {
    const std::string text =
        "[[volume]]\nfile = \"a.vdb\"\nscale = [1, 2, 3]\n[[light]]\ntype = \"environment\"\n";
    const SceneDescription scene = parse(
        text, {"volume[0].scale[1]=5", "volume[0].file=b c.vdb", "volume[0].g = 0.5",
               "light[0].radiance=[1,0,0]", "camera.fov=30", "render.spp=16",
               "render.time_limit=2m", "volume[0].transform.translate=[1,2,3]", "ocio=\"x.ocio\""});
    const VolumeDescription& v = scene.volumes[0];
    EXPECT_EQ(std::get<DensityCoefficients>(v.coefficients).scale, Rgb(1, 5, 3));
    EXPECT_EQ(v.file, "b c.vdb");
    EXPECT_EQ(v.g, 0.5f);
    EXPECT_EQ(v.worldFromObject, Affine3d::translate({1, 2, 3}));
    EXPECT_EQ(std::get<EnvironmentDescription>(scene.lights[0].light).radiance, Rgb(1, 0, 0));
    EXPECT_EQ(scene.camera.fovY, 30);
    EXPECT_EQ(scene.render.spp, 16);
    EXPECT_EQ(scene.render.timeLimit, 120);
    EXPECT_EQ(scene.ocio, "x.ocio");
}

TEST(Overrides, LaterOnesWin) {
    EXPECT_EQ(parse("[[volume]]\nfile = \"a\"", {"render.spp=2", "render.spp=3"}).render.spp, 3);
}

TEST(Overrides, PathsCountFromTheWorkingDirectory) {
    const auto scene =
        parseSceneText("[[volume]]\nfile = \"a.vdb\"", "s.toml", "jobs", {"volume[0].file=b.vdb"});
    EXPECT_EQ(scene.volumes[0].file, "b.vdb");
}

TEST(Overrides, CannotSmuggleOtherKeysIn) {
    EXPECT_THROW(parse("[[volume]]\nfile = \"a\"", {"render.spp=1\nseed = 3"}), Error);
}

}  // namespace
}  // namespace woodcock::test
