// SPDX-License-Identifier: Apache-2.0
#include "woodcock/scene/defaults.h"

#include <gtest/gtest.h>

#include "tests/support/paths.h"
#include "woodcock/medium/optical_depth.h"
#include "woodcock/proof/support/write_vdb.h"
#include "woodcock/scene/build.h"
#include "woodcock/scene/scene_file.h"

namespace woodcock::test {

using namespace camera;
using namespace medium;
using namespace proof;
using namespace render;
using namespace scene;

namespace {

/// A ball of even density, 24 voxels wide.
GridSpec ball(const Affine3d& worldFromIndex) {
    GridSpec grid;
    grid.box = {{0, 0, 0}, {24, 24, 24}};
    grid.value = [](Vec3i v) {
        return length(v.as<double>() - Vec3d{12, 12, 12}) < 12 ? 0.25 : 0.0;
    };
    grid.worldFromIndex = worldFromIndex;
    return grid;
}

struct Completed {
    SceneDescription description;
    LoadedScene loaded;
    std::vector<std::string> notes;

    explicit Completed(const std::string& text, const std::filesystem::path& base = ".",
                       Look look = Look::Picture)
        : description(parseSceneText(text, "scene.toml", base)),
          loaded(loadScene(description)),
          notes(completeScene(description, loaded, look)) {}
    Scene scene() const { return buildScene(description, loaded); }
};

std::string box(const std::string& lower, const std::string& upper) {
    return "[[volume]]\nbox = { min = " + lower + ", max = " + upper + " }\nscale = 1\n";
}

/// The smallest box around the points on the film, in half heights and half widths of the picture
/// from its centre: within [-1, 1] lies what is in the picture. Fails where one is behind the
/// camera.
Box3d onFilm(const Completed& c, const std::vector<Vec3d>& points) {
    const Camera camera = c.scene().camera;
    const Affine3d cameraFromWorld = camera.worldFromCamera.inverse();
    const double aspect = double(c.description.render.width) / c.description.render.height;
    Box3d film;
    for (const Vec3d& point : points) {
        const Vec3d p = cameraFromWorld.point(point);
        EXPECT_LT(p.z, 0);
        const double half = camera.kind == Camera::Kind::Orthographic
                                ? camera.height / 2
                                : -p.z * std::tan(camera.fovY * pi / 360);
        film.add(Vec3d{p.x / (half * aspect), p.y / half, 0});
    }
    return film;
}

/// All is in the picture, with a margin of 8 % of it on either side of the tighter axis.
void expectFramed(const Completed& c, const std::vector<Vec3d>& points, double slack = 0.01) {
    const Box3d film = onFilm(c, points);
    const std::string scene = writeScene(c.description);
    for (int axis = 0; axis < 2; ++axis) {
        EXPECT_GT(film.lower[axis], -0.845) << scene;
        EXPECT_LT(film.upper[axis], 0.845) << scene;
    }
    EXPECT_NEAR(std::max(film.upper.x - film.lower.x, film.upper.y - film.lower.y), 1.68, slack)
        << scene;
}

std::vector<Vec3d> cornersOfBoxes(const SceneDescription& description) {
    std::vector<Vec3d> points;
    for (const VolumeDescription& volume : description.volumes)
        for (int i = 0; i < 8; ++i)
            points.push_back(std::get<HomogeneousBox>(volume.coefficients).box.corner(i));
    return points;
}

TEST(Defaults, FrameTheWholeVolumeTightly) {
    const std::vector<std::string> boxes{
        box("[0, 0, 0]", "[1, 1, 1]"),
        box("[-100, 0, -1]", "[100, 1, 1]"),
        box("[0, -500, 0]", "[1, 500, 1]"),
        box("[1e7, 1e7, 1e7]", "[1.0000001e7, 1.0000002e7, 1.0000001e7]"),
        box("[0, 0, 0]", "[1e-6, 1e-6, 1e-6]"),
        box("[0, 0, 0]", "[1e12, 1e6, 1e6]"),
        box("[0, 0, 0]", "[1, 1, 1]") + box("[5, 5, 5]", "[6, 7, 8]"),
    };
    const std::vector<std::string> cameras{"", "[camera]\nfov = 5\n",
                                           "[camera]\ntype = \"orthographic\"\n",
                                           "[render]\nresolution = [100, 700]\n"};
    for (const std::string& volumes : boxes)
        for (const std::string& camera : cameras) {
            const Completed c(volumes + camera);
            expectFramed(c, cornersOfBoxes(c.description));
        }
}

TEST(Defaults, KeepAWideAngleAwayFromTheVolume) {
    const Completed c(box("[0, 0, 0]", "[1, 1, 1]") + "[camera]\nfov = 150\n");
    const auto corners = cornersOfBoxes(c.description);
    expectFramed(c, corners, 1.68);
    for (const Vec3d& corner : corners)
        EXPECT_GT(length(c.scene().camera.worldFromCamera.translation - corner), 0.3);
}

TEST(Defaults, FrameWhatIsThereOfAGrid) {
    // Two balls at far corners of their box, with a wisp in a third one.
    const TempDir dir;
    const auto inBall = [](Vec3i v, double centre) {
        return length(v.as<double>() - Vec3d{1, 1, 1} * centre) < 20;
    };
    GridSpec grid;
    grid.box = {{0, 0, 0}, {127, 127, 127}};
    grid.value = [&](Vec3i v) {
        return inBall(v, 20) || inBall(v, 107) ? 0.5 : v == Vec3i{0, 127, 0} ? 0.001 : 0;
    };
    grid.worldFromIndex =
        Affine3d::translate({5, 6, 7}) * Affine3d::rotate(1, 30) * Affine3d::scale({0.1, 0.2, 0.1});
    writeVdb(dir / "a.vdb", {grid});
    std::vector<Vec3d> occupied;
    for (int i = 0; i < 128 * 128 * 128; ++i) {
        const Vec3i v{i & 127, i >> 7 & 127, i >> 14};
        if (inBall(v, 20) || inBall(v, 107))
            occupied.push_back(grid.worldFromIndex.point(v.as<double>()));
    }
    for (const char* camera : {"", "[camera]\ntype = \"orthographic\"\n"})
        // The outline is made of blocks of 8 voxels, some of which the balls only touch.
        expectFramed(Completed("[[volume]]\nfile = \"a.vdb\"\n" + std::string(camera), dir.path()),
                     occupied, 0.2);
}

TEST(Defaults, FitAnOrthographicPictureToAGivenPose) {
    const Completed c(
        box("[0, 0, 0]", "[4, 1, 1]") +
        "[camera]\ntype = \"orthographic\"\neye = [2, 0.5, 9]\nlook_at = [2, 0.5, 0]\n"
        "[render]\nresolution = [200, 100]\n");
    // 4 wide at 2:1 is a height of 2, and 84 % of the picture are filled.
    EXPECT_NEAR(*c.description.camera.height, 2 / 0.84, 0.01);
}

TEST(Defaults, LookFromAGivenEyeAtTheVolumes) {
    for (const char* type : {"", "type = \"orthographic\"\n"}) {
        const Completed c(box("[0, 0, 0]", "[4, 2, 1]") + "[camera]\neye = [9, 3, 7]\n" + type);
        const auto& pose = std::get<LookAt>(*c.description.camera.pose);
        EXPECT_EQ(pose.eye, (Vec3d{9, 3, 7}));
        EXPECT_EQ(pose.target, (Vec3d{2, 1, 0.5}));
        EXPECT_EQ(pose.up, (Vec3d{0, 1, 0}));
        EXPECT_NO_THROW(c.scene());
    }
}

TEST(Defaults, FrameTheVolumesAroundAGivenTarget) {
    for (const char* type : {"", "type = \"orthographic\"\n"})
        for (const char* target : {"[0, 0, 0]", "[2, 1, 0.5]", "[30, 0, 40]", "[-30, 0, -40]"}) {
            const Completed c(box("[0, 0, 0]", "[4, 2, 1]") + "[camera]\nlook_at = " + target +
                              "\n" + type);
            const Camera camera = c.scene().camera;
            const Box3d film = onFilm(c, cornersOfBoxes(c.description));
            for (int axis = 0; axis < 2; ++axis) {
                EXPECT_GT(film.lower[axis], -0.85) << target;
                EXPECT_LT(film.upper[axis], 0.85) << target;
            }
            const Vec3d middle = std::get<LookAt>(*c.description.camera.pose).target;
            const Vec3d seen = camera.worldFromCamera.inverse().point(middle);
            EXPECT_NEAR(seen.x / seen.z, 0, 1e-9) << target;
            EXPECT_NEAR(seen.y / seen.z, 0, 1e-9) << target;
            EXPECT_LT(seen.z, 0) << target;
        }
}

TEST(Defaults, KeepAGivenUp) {
    for (const Vec3d up : {Vec3d{0, 0, 1}, {0, -1, 0}, {1, 0, 0}, {0.55, 0.35, 1}, {1, -1, 1}}) {
        const Completed c(box("[0, 0, 0]", "[4, 2, 1]") +
                          fmt::format("[camera]\nup = [{}, {}, {}]\n", up.x, up.y, up.z));
        expectFramed(c, cornersOfBoxes(c.description));
        EXPECT_GT(dot(c.scene().camera.worldFromCamera.column[1], up), 0.3);
    }
}

TEST(Defaults, RefuseAnEyeThatCannotLookAtTheVolumes) {
    for (const char* eye : {"[2, 9, 0.5]", "[2, 1, 0.5]"}) {
        try {
            Completed(box("[0, 0, 0]", "[4, 2, 1]") + "[camera]\neye = " + eye + "\n");
            ADD_FAILURE() << eye;
        } catch (const Error& e) {
            EXPECT_EQ(std::string(e.what()),
                      "scene.toml:5:7: camera.eye looks at the scene's centre, [2, 1, 0.5], "
                      "along up, [0, 1, 0], or stands in it; give a look_at or another up");
        }
    }
}

TEST(Defaults, LookDownALittleWithYUp) {
    for (const auto& [look, least, most] :
         {std::tuple(Look::Picture, 0.02, 0.15), {Look::Plain, 0.1, 0.5}}) {
        const Completed c(box("[0, 0, 0]", "[1, 1, 1]"), ".", look);
        const Affine3d camera = c.scene().camera.worldFromCamera;
        EXPECT_GT(camera.column[2].y, least);  // backwards is up: the view goes down
        EXPECT_LT(camera.column[2].y, most);
        EXPECT_GT(camera.column[1].y, 0.8);
        EXPECT_GT(std::abs(camera.column[2].x), 0.3);  // from the side as well
    }
}

TEST(Defaults, FrameWhatIsSeen) {
    // A ball, and far beside it a sheet. It is a tenth as dense, so no wisp, but a voxel thick.
    const TempDir dir;
    GridSpec grid;
    grid.box = {{0, 0, 0}, {239, 95, 95}};
    const auto inBall = [](Vec3i v) { return length(v.as<double>() - Vec3d{48, 48, 48}) < 44; };
    grid.value = [&](Vec3i v) { return inBall(v) ? 1 : v.x > 180 && v.z == 50 ? 0.1 : 0; };
    writeVdb(dir / "a.vdb", {grid});
    std::vector<Vec3d> ball;
    for (int i = 0; i < 96 * 96 * 96; ++i) {
        const Vec3i v{i % 96, i / 96 % 96, i / 96 / 96};
        if (inBall(v)) ball.push_back(v.as<double>());
    }
    // A ray straight through the sheet has a depth of 0.01, then one of 5.
    const std::string thin = "[[volume]]\nfile = \"a.vdb\"\nscale = 0.1\n";
    expectFramed(Completed(thin, dir.path()), ball, 0.4);
    const std::string thick = "[[volume]]\nfile = \"a.vdb\"\nscale = 50\n";
    EXPECT_LT(onFilm(Completed(thick, dir.path()), ball).size().x, 0.8);
}

TEST(Defaults, BlendersVolumesStandOnZ) {
    const TempDir dir;
    GridSpec grid = ball({});
    grid.metadata = {{"creator", "Blender/OpenVDBWriter"}};
    writeVdb(dir / "blender.vdb", {grid});
    writeVdb(dir / "other.vdb", {ball({})});
    const std::string blender = "[[volume]]\nfile = \"blender.vdb\"\n";
    const Completed z(blender, dir.path());
    EXPECT_GT(z.scene().camera.worldFromCamera.column[1].z, 0.8);
    EXPECT_LT(std::get<SunDescription>(z.description.lights[0].light).direction.z, -0.3);
    const Completed both(blender + "[[volume]]\nfile = \"other.vdb\"\n", dir.path());
    EXPECT_GT(both.scene().camera.worldFromCamera.column[1].y, 0.8);
}

TEST(Defaults, ScaleGivesATypicalRayItsOpticalDepth) {
    for (const double voxel : {1.0, 1e-3, 1e4}) {
        const TempDir dir;
        writeVdb(dir / "a.vdb",
                 {ball(Affine3d::translate({3, 4, 5}) * Affine3d::scale(Vec3d{1, 1, 1} * voxel))});
        for (const auto& [look, depthOfLook] : {std::pair(Look::Picture, 20), {Look::Plain, 10}}) {
            const Completed c("[[volume]]\nfile = \"a.vdb\"\n", dir.path(), look);
            const Scene scene = c.scene();
            // Through a ball of radius r, half of parallel rays that are spread evenly over its
            // disc pass within r sqrt(1/2) of the centre: the median chord is r sqrt(2).
            const Vec3d centre = Vec3d{3, 4, 5} + Vec3d{12, 12, 12} * voxel;
            const Vec3d start = centre + Vec3d{0, 12 * std::sqrt(0.5), -30} * voxel;
            const Rgb depth = exactOpticalDepth(scene.medium, start, {0, 0, 1}, 0, 60 * voxel);
            EXPECT_NEAR(depth[0], depthOfLook, 0.1 * depthOfLook) << "voxel " << voxel;
        }
    }
}

TEST(Defaults, LightFromTheCamerasUpperLeft) {
    const std::string volume = box("[0, 0, 0]", "[1, 1, 1]");
    for (const Look look : {Look::Picture, Look::Plain})
        for (const char* camera : {"", "[camera]\neye = [-5, 1, 0.5]\nlook_at = [0.5, 0.5, 0.5]\n",
                                   "[camera]\neye = [0.5, 9, 0.5]\nlook_at = [0.5, 0.5, 0.5]\n"
                                   "up = [1, 0, 0]\n"}) {
            const Completed c(volume + camera, ".", look);
            const auto& lights = c.description.lights;
            ASSERT_EQ(lights.size(), look == Look::Picture ? 3u : 2u);
            const Vec3d sun = -normalize(std::get<SunDescription>(lights[0].light).direction);
            const Affine3d pose = c.scene().camera.worldFromCamera;
            EXPECT_NEAR(std::asin(sun.y) * 180 / pi, 40, 1e-9);
            EXPECT_LT(dot(sun, pose.column[0]), -0.5);
            if (look == Look::Picture) {  // on the camera's side
                EXPECT_GT(dot(sun, pose.column[2]), 0);
            }
            const auto place = std::get<SunDescription>(lights[0].light).place.value();
            EXPECT_EQ(place.azimuth, std::round(place.azimuth));
            EXPECT_GE(place.azimuth, 0);
            EXPECT_LT(place.azimuth, 360);
            EXPECT_TRUE(std::get<EnvironmentDescription>(lights[1].light).visible);
        }
}

TEST(Defaults, KeepTheFillApartFromTheBackdrop) {
    const Completed c(box("[0, 0, 0]", "[1, 1, 1]"));
    const auto& backdrop = std::get<EnvironmentDescription>(c.description.lights.at(1).light);
    const auto& fill = std::get<EnvironmentDescription>(c.description.lights.at(2).light);
    EXPECT_TRUE(backdrop.visible);
    EXPECT_FALSE(fill.visible);
    // The backdrop is dark, darker away from the horizon, and lights less than the fill.
    EXPECT_LT(backdrop.radiance.maximum(), 0.15);
    EXPECT_LT(backdrop.above.value().maximum(), backdrop.radiance.maximum() / 2);
    EXPECT_LT(backdrop.below.value().maximum(), backdrop.radiance.maximum() / 2);
    EXPECT_GT(fill.radiance.mean(), backdrop.above->mean());
}

TEST(Defaults, OfThePlainLookAreThoseOfComparisons) {
    const std::string scene =
        writeScene(Completed(box("[0, 0, 0]", "[1, 1, 1]"), ".", Look::Plain).description);
    for (const char* line :
         {"azimuth = 241", "irradiance = [5.2, 4.4, 3.4]", "radiance = [0.12, 0.19, 0.32]",
          "eye = [1.452, 1.002, 2.444]", "look_at = [0.432, 0.353, 0.589]"})
        EXPECT_NE(scene.find(line), std::string::npos) << line << scene;
    EXPECT_EQ(defaultSceneText({"a.vdb"}, Look::Plain), "[[volume]]\nfile = \"a.vdb\"\ng = 0.6\n");
}

TEST(Defaults, ChooseOnlyWhatIsOpen) {
    const std::string text = box("[0, 0, 0]", "[1, 1, 1]") +
                             "[[light]]\ntype = \"environment\"\n"
                             "[camera]\neye = [0, 0, 5]\nlook_at = [0, 0, 0]\n";
    const Completed c(text);
    EXPECT_TRUE(c.notes.empty());
    EXPECT_EQ(c.description, parseSceneText(text, "scene.toml", "."));
}

TEST(Defaults, AreFixedByTheSceneTheyWrite) {
    const TempDir dir;
    writeVdb(dir / "a.vdb", {ball({})});
    const auto text = defaultSceneText({dir / "a.vdb", dir / "a.vdb"});
    Completed chosen(text, "");
    EXPECT_EQ(chosen.description.volumes.size(), 2u);
    EXPECT_EQ(chosen.notes.size(), 4u);  // two scales, the camera, the lights
    const Completed again(writeScene(chosen.description));
    EXPECT_TRUE(again.notes.empty());
    EXPECT_EQ(sceneDigest(again.description), sceneDigest(chosen.description));
}

TEST(Defaults, NotesAreTheTomlThatFixesThem) {
    const Completed c(box("[0, 0, 0]", "[1, 1, 1]"));
    ASSERT_EQ(c.notes.size(), 2u);
    std::string toml = box("[0, 0, 0]", "[1, 1, 1]");
    for (const std::string& note : c.notes) toml += note.substr(note.find('\n') + 1) + "\n";
    const Completed fixed(toml);
    EXPECT_TRUE(fixed.notes.empty()) << toml;
    EXPECT_EQ(sceneDigest(fixed.description), sceneDigest(c.description));
}

TEST(Defaults, OfFilesAloneAreNotedAsTheWholeScene) {
    const TempDir dir;
    GridSpec smoke = ball({}), heat = ball({});
    smoke.name = "Smoke";
    heat.name = "heat";
    writeVdb(dir / "a.vdb", {heat, smoke});
    writeVdb(dir / "$b.vdb", {ball(Affine3d::translate({9, 0, 0}))});
    SceneDescription scene =
        parseSceneText(defaultSceneText({dir / "a.vdb", dir / "$b.vdb"}), "", "");
    scene.places.clear();
    std::string toml;
    for (const std::string& note : completeScene(scene, loadScene(scene)))
        toml += note.substr(note.find('\n') + 1);
    for (const char* line :
         {"density = \"Smoke\"", "density = \"density\"", "albedo = 0.97", "scale = "})
        EXPECT_NE(toml.find(line), std::string::npos) << toml;
    SceneDescription printed = parseSceneText(toml, "printed.toml", "");
    SceneDescription written = parseSceneText(writeScene(scene), "written.toml", "");
    printed.places.clear(), written.places.clear();
    EXPECT_EQ(printed, written) << toml;
    EXPECT_EQ(sceneDigest(printed), sceneDigest(scene));
}

/// A scene around fire.vdb alone, as a command line makes it.
SceneDescription completedFire(const TempDir& dir, Look look = Look::Picture,
                               const std::vector<std::string>& overrides = {}) {
    SceneDescription scene =
        parseSceneText(defaultSceneText({dir / "fire.vdb"}, look), "line", "", overrides);
    std::erase_if(scene.places, [](const auto& place) { return place.second.starts_with("line"); });
    LoadedScene loaded = loadScene(scene);
    completeScene(scene, loaded, look);
    loadChosen(scene, loaded);
    buildScene(scene, loaded);  // what was chosen can be drawn
    return scene;
}

TEST(Defaults, FireGlows) {
    const TempDir dir;
    GridSpec smoke = ball({}), flame = ball({}), hot = ball({});
    flame.name = "Flames", hot.name = "temperature";
    hot.value = [](Vec3i v) { return v.x / 24.0 * 2.94; };
    const auto glow = [&](const std::vector<GridSpec>& grids, Look look = Look::Picture,
                          const std::vector<std::string>& overrides = {}) {
        writeVdb(dir / "fire.vdb", grids);
        return completedFire(dir, look, overrides).volumes[0];
    };
    EXPECT_FALSE(glow({smoke}).blackbody);
    EXPECT_FALSE(glow({smoke, flame, hot}, Look::Plain).blackbody);
    // The largest value, 2.94 or 0.25, is 2000 K.
    EXPECT_EQ(glow({smoke, flame, hot}).blackbody.value().temperature, "temperature");
    EXPECT_EQ(glow({smoke, flame, hot}).blackbody.value().scale, 680);
    EXPECT_EQ(glow({smoke, flame}).blackbody.value().temperature, "Flames");
    EXPECT_EQ(glow({smoke, flame}).blackbody.value().scale, 8000);
    hot.value = [](Vec3i v) { return v.x / 24.0 * 1500; };
    EXPECT_EQ(glow({smoke, hot}).blackbody.value().scale, 1);  // kelvins
    // What the user says stands.
    const auto albedo = [](const VolumeDescription& volume) {
        return std::get<DensityCoefficients>(volume.coefficients).albedo.x;
    };
    EXPECT_LT(albedo(glow({smoke, hot})), albedo(glow({smoke})));
    EXPECT_EQ(albedo(glow({smoke, hot}, Look::Picture, {"volume[0].albedo=0.9"})), 0.9);
    EXPECT_EQ(glow({smoke, hot}, Look::Picture, {"volume[0].blackbody={ scale = 2 }"})
                  .blackbody.value()
                  .scale,
              2);
}

TEST(Defaults, AGridOfColoursIsTheAlbedo) {
    const TempDir dir;
    GridSpec smoke = ball({}), colour = ball({});
    colour.name = "Cd";
    colour.type = VdbType::Vec3s;
    const auto completed = [&](double brightest, Look look, std::vector<std::string> overrides) {
        colour.colour = [=](Vec3i v) { return Vec3d{0.2, 0.5, 1} * (v.x / 24.0 * brightest); };
        writeVdb(dir / "fire.vdb", {smoke, colour});
        return completedFire(dir, look, overrides).volumes[0];
    };
    const auto gridOf = [](const VolumeDescription& volume) {
        return std::get<DensityCoefficients>(volume.coefficients).albedoGrid;
    };
    EXPECT_EQ(gridOf(completed(0.9, Look::Picture, {})), "Cd");
    EXPECT_EQ(gridOf(completed(0.9, Look::Plain, {})), "");
    // An albedo lies between 0 and 1.
    EXPECT_EQ(gridOf(completed(1.5, Look::Picture, {})), "");
    EXPECT_EQ(gridOf(completed(1.5, Look::Picture, {"volume[0].repair=true"})), "Cd");
    EXPECT_EQ(gridOf(completed(0, Look::Picture, {})), "");  // nobody has coloured it
    EXPECT_EQ(gridOf(completed(-0.5, Look::Picture, {})), "");
    // What the user says stands.
    EXPECT_EQ(gridOf(completed(0.9, Look::Picture, {"volume[0].albedo_grid=density"})), "density");
    // So does a scene file.
    EXPECT_EQ(
        gridOf(Completed("[[volume]]\nfile = \"fire.vdb\"\n", dir.path()).description.volumes[0]),
        "");
}

TEST(Defaults, CoefficientsInAFileAreTakenAsTheyAre) {
    const TempDir dir;
    GridSpec absorption = ball({}), scattering = ball({}), density = ball({});
    absorption.name = "sigma_a", scattering.name = "sigma_s";
    const auto text = [&](const std::vector<GridSpec>& grids, Look look = Look::Picture) {
        writeVdb(dir / "fire.vdb", grids);
        const std::string all = defaultSceneText({dir / "fire.vdb"}, look);
        return all.substr(all.find("vdb\"\n") + 5);
    };
    EXPECT_EQ(text({scattering, absorption}),
              "sigma_a = { grid = \"sigma_a\" }\nsigma_s = { grid = \"sigma_s\" }\n");
    EXPECT_EQ(text({scattering}, Look::Plain), "sigma_s = { grid = \"sigma_s\" }\ng = 0.6\n");
    EXPECT_EQ(text({scattering, density}), "albedo = 0.97\n");
    text({scattering, absorption});
    const SceneDescription scene = completedFire(dir);  // and it can be drawn
    const auto& sigma = std::get<SeparateCoefficients>(scene.volumes[0].coefficients);
    EXPECT_EQ(sigma.sigmaS, (GridCoefficient{"sigma_s", Rgb(1)}));
    EXPECT_EQ(defaultSceneText({dir / "missing.vdb"}),
              "[[volume]]\nfile = \"" + (dir / "missing.vdb").string() + "\"\nalbedo = 0.97\n");
}

TEST(Defaults, FireIsAsBrightAtEverySizeAndLightIsDimBesideIt) {
    const TempDir dir;
    const auto fire = [&](double size, bool burns) {
        GridSpec smoke = ball(Affine3d::scale(Vec3d{1, 1, 1} * size)), hot = smoke;
        hot.name = "temperature";
        writeVdb(dir / "fire.vdb", burns ? std::vector{smoke, hot} : std::vector{smoke});
        return completedFire(dir);
    };
    // Half as long a way through it asks for twice the light.
    const auto intensity = [&](double size) {
        return fire(size, true).volumes[0].blackbody.value().intensity;
    };
    EXPECT_NEAR(intensity(0.01) / intensity(0.1), 10, 1e-6);
    const auto sun = [](const SceneDescription& scene) {
        return std::get<SunDescription>(scene.lights.at(0).light).irradiance.mean();
    };
    EXPECT_LT(sun(fire(1, true)), 0.5f * sun(fire(1, false)));
}

TEST(Defaults, ComeFromAnotherFrameWhereOneIsGiven) {
    const TempDir dir;
    writeVdb(dir / "a.vdb", {ball({})});
    writeVdb(dir / "b.vdb", {ball(Affine3d::scale({3, 3, 3}))});
    const auto scene = [&](const char* file) {
        return parseSceneText(defaultSceneText({dir / file}), "", "");
    };
    SceneDescription a = scene("a.vdb"), b = scene("b.vdb");
    const LoadedScene other = loadScene(b);
    completeScene(a, other), completeScene(b, other);
    EXPECT_EQ(a.volumes[0].file, dir / "a.vdb");
    b.volumes[0].file = a.volumes[0].file;
    EXPECT_EQ(writeScene(a), writeScene(b));
}

TEST(Defaults, NameTheDensityThatWasFound) {
    const TempDir dir;
    GridSpec smoke = ball({});
    smoke.name = "Smoke";
    writeVdb(dir / "a.vdb", {smoke});
    const Completed c(
        "[[volume]]\nfile = \"a.vdb\"\nscale = 2\n[[volume]]\nfile = \"a.vdb\"\nsigma_s = 3\n",
        dir.path());
    ASSERT_EQ(c.notes.size(), 4u);
    EXPECT_EQ(c.notes[0], "chosen for volume[0]:\ndensity = \"Smoke\"\n");
    EXPECT_EQ(c.notes[1], "chosen for volume[1]:\ndensity = \"Smoke\"\n");
    const auto& separate = std::get<SeparateCoefficients>(c.description.volumes[1].coefficients);
    EXPECT_EQ(separate.sigmaS, (GridCoefficient{"Smoke", Rgb(3)}));
}

TEST(Defaults, SurviveAVolumeWithoutDensity) {
    const TempDir dir;
    GridSpec grid;
    grid.voxels = {{{0, 0, 0}, {0, 0, 0}, true}};
    writeVdb(dir / "a.vdb", {grid});
    const Completed c("[[volume]]\nfile = \"a.vdb\"\n", dir.path());
    EXPECT_EQ(std::get<DensityCoefficients>(c.description.volumes[0].coefficients).scale, Rgb(1));
    EXPECT_NO_THROW(c.scene());
}

}  // namespace
}  // namespace woodcock::test
