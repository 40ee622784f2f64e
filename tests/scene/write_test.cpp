// SPDX-License-Identifier: Apache-2.0
#include "woodcock/scene/scene_file.h"

#include <gtest/gtest.h>

#include <cmath>

#include "woodcock/base/error.h"

namespace woodcock::test {

using namespace grid;
using namespace scene;

namespace {

/// As read back, without the places that only a file gives.
SceneDescription readBack(const SceneDescription& scene) {
    SceneDescription read = parseSceneText(writeScene(scene), "written.toml", ".");
    read.places.clear();
    return read;
}

VolumeDescription fileVolume(
    std::variant<DensityCoefficients, SeparateCoefficients, HomogeneousBox> coefficients) {
    VolumeDescription volume;
    volume.file = "dir/smoke \"1\" $5.vdb";
    volume.coefficients = std::move(coefficients);
    return volume;
}

void addSurfaces(SceneDescription& scene) {
    const TextureDescription image{Rgb(0.1f, 0.2f, 0.3f), "dir/wood \"1\" $5.png", "srgb"};
    scene.materials = {
        {"red \"1\"", DiffuseDescription{image}},
        {"plain", DiffuseDescription{{Rgb(0.1f, 0.2f, 1.0f / 3), {}, {}}}},
        {"metal", ConductorDescription{{Rgb(1), "metal.exr", {}}, {}, 1.0 / 3}},
        {"gold", ConductorDescription{{Rgb(0.9f), {}, {}}, {{Rgb(0.1f), Rgb(3, 2, 1)}}, 0}},
        {"glass", DielectricDescription{4.0 / 3, 0.1}},
        {"bubble", DielectricDescription{0.75, 0}},
        {"air", InterfaceDescription{}},
        {"lamp", EmissiveDescription{image, true}},
        {"rust", MixDescription{"gold", "plain", image}},
    };
    SurfaceDescription ball;
    ball.name = "ball \"1\"";
    ball.shape = SphereShape{{1.0 / 3, -1e7, 0}, 1.0 / 7};
    ball.material = "glass";
    ball.interior = {Rgb(0.1f, 1e-12f, 3e12f), Rgb(0.7f), 0.1f, {}, Rgb(0.1f, 0, 1.0f / 3)};
    ball.priority = -5;
    SurfaceDescription mesh;
    mesh.shape = MeshShape{"dir/a $5.obj", {}};
    mesh.material = "rust";
    mesh.smooth = 100.0 / 3;
    mesh.worldFromObject = Affine3d::translate({1, 2, 1.0 / 3}) * Affine3d::rotate(0, 21);
    mesh.instances = {Affine3d::rotate(1, 33), Affine3d(), Affine3d::scale({1e-7, 2, 3})};
    mesh.matte = true;
    SurfaceDescription levelSet;
    levelSet.shape = MeshShape{"a.vdb", "ls"};
    levelSet.smooth = 0;
    levelSet.instanceFile = "dir/places.txt";
    levelSet.cameraVisible = false;
    SurfaceDescription box;
    box.shape = BoxShape{{{-1.0 / 3, 0, 0}, {1, 2, 3}}};
    box.holdout = true;
    SurfaceDescription disk;
    disk.shape = DiskShape{1.0 / 3};
    disk.shadowCatcher = true;
    SurfaceDescription plane, rectangle, lathe;
    plane.shape = PlaneShape{};
    rectangle.shape = PlaneShape{{{1.0 / 3, 2}}};
    lathe.shape = LatheShape{{{0, 0}, {1.0 / 3, 1e-7}, {0, 2}}, 7};
    scene.surfaces = {ball, mesh, levelSet, box, disk, plane, rectangle, lathe};
    scene.volumes.at(0).inside = ball.name;
}

/// Every field away from its default, with numbers that need all their digits.
SceneDescription fullScene() {
    SceneDescription scene;
    scene.ocio = "~odd/config.ocio";

    VolumeDescription volume = fileVolume(
        DensityCoefficients{"name[2]", Rgb(0.1f, 1e-12f, 3e12f), Vec3d{0.3, 0, 1 - 1e-7}, "Cd"});
    volume.g = 0.1f;
    volume.worldFromObject = {{Vec3d{0.1, 0.2, 1.0 / 3}, {-1e-7, 2, 0}, {0.5, 0, 1e7}},
                              {1e7 + 1.0 / 3, -0.1, 5}};
    volume.storage = Storage::Half;
    volume.repair = true;
    scene.volumes.push_back(volume);
    scene.volumes.push_back(fileVolume(DensityCoefficients{}));
    scene.volumes.back().storage = Storage::Float;
    scene.volumes.push_back(fileVolume(SeparateCoefficients{GridCoefficient{"soot", Rgb(0.7f)},
                                                            GridCoefficient{"", Rgb(1, 2, 3)}}));
    VolumeDescription box;
    box.coefficients =
        HomogeneousBox{{{-1.0 / 3, 0, 0}, {1, 2, 3}}, Rgb(0.1f, 0.2f, 0.3f), Rgb(0.7f)};
    scene.volumes.push_back(box);

    scene.lights = {
        {SunDescription{{1.0 / 3, -2, 3}, Rgb(3, 2, 1), 0.53, true}},
        {SunDescription{SunPlace{100.0 / 3, -7.7, UpAxis::Z}.direction(), Rgb(1), 0.0, false,
                        SunPlace{100.0 / 3, -7.7, UpAxis::Z}}},
        {EnvironmentDescription{Rgb(0.1f), "sky.hdr", UpAxis::Z, 33.3, false}},
        {PointDescription{{1, 2, 1.0 / 3}, Rgb(0.1f, 0.2f, 0.3f)}},
        {SphereDescription{{1, 2, 3}, 1.0 / 7, Rgb(9), false}},
    };
    scene.camera = {CameraDescription::Kind::Perspective,
                    LookAt{{1.0 / 3, 2, 3}, {0, 0.1, 0}, {0, 0, 1}},
                    33.3,
                    {},
                    {},
                    {1.0 / 3, -2},
                    100.0 / 3};
    addSurfaces(scene);
    scene.render = {.width = 321,
                    .height = 123,
                    .spp = 7,
                    .seed = 42,
                    .maxScatterings = 0,
                    .maxBounces = 9,
                    .approximations = {.marchStep = 0.3,
                                       .jackknife = false,
                                       .similarityAfter = 0,
                                       .clamp = 1.0 / 3,
                                       .transparentShadows = true},
                    .storage = Storage::Half,
                    .lookup = Lookup::Nearest,
                    .levelOfDetail = 1.25,
                    .adaptive = true,
                    .timeLimit = 1.5,
                    .noise = 0.01,
                    .majorantScale = 2.5};
    scene.output = {.files = {"a.exr", "b.png"},
                    .layers = {"error", "depth"},
                    .mattes = {"material"},
                    .mattesFile = "m.exr",
                    .deep = "deep.exr",
                    .deepError = 0.02,
                    .half = true,
                    .multipart = true,
                    .display = "d",
                    .view = "v\\w",
                    .look = "l\n",
                    .exposure = -0.5};
    return scene;
}

TEST(WriteScene, ReadsBackEqual) {
    const SceneDescription scene = fullScene();
    EXPECT_EQ(readBack(scene), scene) << writeScene(scene);
}

TEST(WriteScene, ReadsBackEqualWithAnOrthographicMatrixCamera) {
    SceneDescription scene = fullScene();
    scene.camera = {
        CameraDescription::Kind::Orthographic,
        Affine3d::translate({1, 2, 1.0 / 3}) * Affine3d::rotate(1, 33) * Affine3d::rotate(0, 21),
        40, 1.0 / 3};
    EXPECT_EQ(readBack(scene), scene) << writeScene(scene);
}

TEST(WriteScene, ReadsBackEqualWhereEverythingIsLeftToTheProgram) {
    SceneDescription scene;
    scene.volumes.push_back(fileVolume(DensityCoefficients{}));
    EXPECT_EQ(readBack(scene), scene) << writeScene(scene);
}

TEST(WriteScene, ReadsBackEqualWithAPartOfAPose) {
    SceneDescription scene = fullScene();
    scene.camera.pose.reset();
    scene.camera.given = {Vec3d{1, 2, 1.0 / 3}, {}, Vec3d{0, 0, 1}};
    EXPECT_EQ(readBack(scene), scene) << writeScene(scene);
    scene.camera.given = {{}, Vec3d{1, 2, 1.0 / 3}, {}};
    EXPECT_EQ(readBack(scene), scene) << writeScene(scene);
}

TEST(WriteScene, ZeroKeepsItsSign) {
    SceneDescription scene = fullScene();
    scene.lights = {{SunDescription{{-0.0, -1, 0}, Rgb(1), 0, false}}};
    const SceneDescription read = readBack(scene);
    const Vec3d direction = std::get<SunDescription>(read.lights.at(0).light).direction;
    EXPECT_TRUE(std::signbit(direction.x));
    EXPECT_FALSE(std::signbit(direction.z));
    EXPECT_EQ(sceneDigest(read), sceneDigest(scene));
}

TEST(WriteScene, PathsFollowTheDirectoryOfTheText) {
    SceneDescription scene;
    scene.volumes.resize(2);
    scene.volumes[0].file = "data/a.vdb";
    scene.volumes[1].file = "/abs/b.vdb";
    const auto read = parseSceneText(writeScene(scene, "scenes/new"), "x.toml", "scenes/new");
    EXPECT_EQ(read.volumes[0].file, "data/a.vdb");
    EXPECT_EQ(read.volumes[1].file, "/abs/b.vdb");
}

TEST(WriteScene, PathsOfSurfacesFollowTheDirectoryOfTheText) {
    SceneDescription scene = fullScene();
    const auto read = parseSceneText(writeScene(scene, "scenes/new"), "x.toml", "scenes/new");
    EXPECT_EQ(read.materials, scene.materials);
    EXPECT_EQ(read.surfaces, scene.surfaces);
}

TEST(WriteScene, RefusesASeedThatTomlCannotHold) {
    SceneDescription scene = fullScene();
    scene.render.seed = std::uint64_t{1} << 63;
    EXPECT_THROW(writeScene(scene), Error);
}

TEST(SceneDigest, IsTheSameForEveryWayOfWriting) {
    const auto parse = [](const char* text) { return parseSceneText(text, "x", ".", {}); };
    const auto a = parse("[[volume]]\nfile = \"a.vdb\"\nscale = 2.0 # thick\ng = 0.5");
    const auto b = parse("volume = [{g = 5e-1, scale = [2, 2, 2], file = './a.vdb'}]");
    EXPECT_EQ(sceneDigest(a), sceneDigest(b));
    EXPECT_EQ(sceneDigest(a).size(), 16u);
}

TEST(SceneDigest, OfASunIsOfItsDirection) {
    const std::string sun = "[[volume]]\nfile = \"a.vdb\"\n[[light]]\ntype = \"sun\"\n";
    EXPECT_EQ(sceneDigest(parseSceneText(sun + "elevation = 90", "x", ".")),
              sceneDigest(parseSceneText(sun + "elevation = 90\nup = \"y\"", "x", ".")));
    EXPECT_NE(sceneDigest(parseSceneText(sun + "elevation = 80", "x", ".")),
              sceneDigest(parseSceneText(sun + "elevation = 80\nazimuth = 1", "x", ".")));
    const Vec3d d = SunPlace{80, 1}.direction();
    EXPECT_EQ(sceneDigest(parseSceneText(sun + "elevation = 80\nazimuth = 1", "x", ".")),
              sceneDigest(parseSceneText(
                  sun + fmt::format("direction = [{}, {}, {}]", d.x, d.y, d.z), "x", ".")));
}

TEST(SceneDigest, ChangesWithAllThatTheImageShows) {
    const SceneDescription scene = fullScene();
    const std::string digest = sceneDigest(scene);
    const auto changed = [&](auto change) {
        SceneDescription other = scene;
        change(other);
        return sceneDigest(other) != digest;
    };
    using S = SceneDescription&;
    EXPECT_TRUE(changed([](S s) { s.volumes[0].file = "other.vdb"; }));
    EXPECT_TRUE(changed([](S s) { s.volumes[0].g = 0.2f; }));
    EXPECT_TRUE(changed([](S s) { s.volumes[1].repair = true; }));
    EXPECT_TRUE(changed([](S s) { std::get<SunDescription>(s.lights[0].light).visible = false; }));
    EXPECT_TRUE(changed([](S s) { s.lights.pop_back(); }));
    EXPECT_TRUE(changed([](S s) { s.volumes[0].inside.clear(); }));
    EXPECT_TRUE(changed([](S s) { s.materials.back().name = "other"; }));
    EXPECT_TRUE(changed(
        [](S s) { std::get<DiffuseDescription>(s.materials[0].material).colour.image = "x"; }));
    EXPECT_TRUE(changed([](S s) { s.surfaces[0].priority = 4; }));
    EXPECT_TRUE(changed([](S s) { s.surfaces[0].interior->g = 0.2f; }));
    EXPECT_TRUE(changed([](S s) { s.surfaces[2].instanceFile = "x"; }));
    EXPECT_TRUE(changed([](S s) { s.render.maxBounces = 10; }));
    EXPECT_TRUE(changed([](S s) { s.render.approximations.transparentShadows = false; }));
    EXPECT_TRUE(changed([](S s) { s.render.approximations.marchStep = 0; }));
    EXPECT_TRUE(changed([](S s) { s.render.approximations.octaves = 3; }));
    EXPECT_TRUE(changed([](S s) { s.render.storage = Storage::Float; }));
    EXPECT_TRUE(changed([](S s) { s.render.lookup = Lookup::Trilinear; }));
    EXPECT_TRUE(changed([](S s) { s.render.levelOfDetail = 0; }));
    EXPECT_TRUE(changed([](S s) { s.camera.fovY = 30; }));
    EXPECT_TRUE(changed([](S s) { s.camera.shift = {0, 0.5}; }));
    EXPECT_TRUE(changed([](S s) { s.render.width = 1; }));
    EXPECT_TRUE(changed([](S s) { s.render.maxScatterings.reset(); }));

    EXPECT_FALSE(changed([](S s) { s.output = {}; }));
    EXPECT_FALSE(changed([](S s) { s.ocio.clear(); }));
    EXPECT_FALSE(changed([](S s) { s.render.spp = 1; }));
    EXPECT_FALSE(changed([](S s) { s.render.seed = 1; }));
    EXPECT_FALSE(changed([](S s) { s.render.timeLimit = 1; }));
    EXPECT_FALSE(changed([](S s) { s.render.noise = 1; }));
    EXPECT_FALSE(changed([](S s) { s.places["volume[0].file"] = "elsewhere"; }));
}

}  // namespace
}  // namespace woodcock::test
