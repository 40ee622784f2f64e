// SPDX-License-Identifier: Apache-2.0
// From the scene file to volumes that move, and every mistake.
#include <gtest/gtest.h>

#include "tests/scene/built_scene.h"
#include "woodcock/base/temp_dir.h"
#include "woodcock/grid/motion.h"
#include "woodcock/proof/support/write_vdb.h"
#include "woodcock/render/needs.h"

namespace woodcock::test {

using namespace proof;
using namespace scene;

namespace {

const Affine3d place = Affine3d::scale({0.5, 0.5, 0.5});

GridSpec smoke() {
    GridSpec grid{.box = {{0, 0, 0}, {15, 15, 15}}};
    grid.value = [](Vec3i v) { return 0.1 * v.x; };
    grid.worldFromIndex = place;
    return grid;
}

GridSpec vectors(const std::string& name, Vec3d value = {1, -2, 3}) {
    GridSpec grid{.name = name, .type = VdbType::Vec3s, .box = {{-8, -8, -8}, {23, 23, 23}}};
    grid.colour = [value](Vec3i) { return value; };
    grid.worldFromIndex = place;
    grid.gridClass = "unknown";
    return grid;
}

GridSpec component(const std::string& name, double value) {
    GridSpec grid{.name = name, .box = {{-8, -8, -8}, {23, 23, 23}}};
    grid.value = [value](Vec3i) { return value; };
    grid.worldFromIndex = place;
    return grid;
}

class Velocities : public testing::Test {
protected:
    void write(const std::vector<GridSpec>& grids) const { writeVdb(dir / "a.vdb", grids); }
    /// Without the light and the camera, which the shutter stands in.
    static std::string text(const std::string& keys, const std::string& shutter,
                            const std::string& render) {
        return "[[volume]]\nfile = \"a.vdb\"\nscale = 1\n" + keys + "[render]\n" + render +
               lightAndCamera + "shutter = " + shutter + "\n";
    }
    render::Scene built(const std::string& keys, const std::string& shutter = "[0, 1]",
                        const std::string& render = "fps = 1\n") const {
        const SceneDescription description =
            parseSceneText(text(keys, shutter, render), "scene.toml", dir.path(), {});
        return buildScene(description, loadScene(description));
    }
    std::string mistake(const std::string& keys, const std::string& shutter = "[0, 1]") const {
        try {
            built(keys, shutter);
        } catch (const Error& e) {
            EXPECT_EQ(e.kind(), ErrorKind::Input);
            return e.what();
        }
        return "";
    }
    /// World units by which the middle of the smoke moves until the shutter closes.
    static Vec3d moved(const render::Scene& scene) {
        const auto& part = scene.medium.parts.at(0).description();
        if (!part.motion) return {};
        const Vec3d index{7, 7, 7};
        return part.worldFromIndex.vector(index - part.motion->source(index, 1));
    }
    static void expectMoved(const render::Scene& scene, Vec3d by) {
        const Vec3d is = moved(scene);
        for (int i = 0; i < 3; ++i) EXPECT_NEAR(is[i], by[i], 1e-6);
    }

    const TempDir dir;
};

TEST_F(Velocities, AreFoundByTheirNames) {
    for (const char* name : {"vel", "v", "Velocity"}) {
        write({smoke(), vectors(name)});
        expectMoved(built(""), {1, -2, 3});
    }
    for (const auto& names : {std::array{"vel.x", "vel.y", "vel.z"},
                              {"velocity_x", "velocity_y", "velocity_z"},
                              {"velocityX", "velocityY", "velocityZ"}}) {
        write({component(names[2], 3), smoke(), component(names[0], 1), component(names[1], -2)});
        expectMoved(built(""), {1, -2, 3});
        expectMoved(built(std::string("velocity = \"") + names[0] + "\"\n"), {1, -2, 3});
    }
    write({smoke(), vectors("wind", {4, 0, 0}), vectors("vel"), component("gust.x", 0),
           component("gust.y", 1), component("gust.z", 0)});
    expectMoved(built("velocity = \"wind\"\n"), {4, 0, 0});
    expectMoved(built("velocity = \"gust\"\n"), {0, 1, 0});
    write({smoke()});
    expectMoved(built(""), {});
}

TEST_F(Velocities, UnitScaleShutterAndTransform) {
    write({smoke(), vectors("vel")});
    expectMoved(built("", "[0, 1]", "fps = 4\n"), Vec3d{1, -2, 3} * 0.25);
    expectMoved(built("", "0.5", "fps = 4\n"), Vec3d{1, -2, 3} * 0.0625);
    expectMoved(built("", "[-1, -0.5]"), Vec3d{1, -2, 3} * -0.5);
    expectMoved(built("velocity_scale = -0.5\n"), Vec3d{-0.5, 1, -1.5});
    expectMoved(built("velocity_unit = \"frame\"\n", "[0, 1]", "fps = 4\n"), {1, -2, 3});
    expectMoved(built("transform = { rotate = [0, 0, 90], scale = 2 }\n"), {4, 2, 6});
    expectMoved(built("velocity_scale = 0\n"), {});
    expectMoved(built("", "0"), {});
    // At one moment that is not the file's, it stands elsewhere, and nothing moves.
    const render::Scene aside = built("", "[0.5, 0.5]");
    expectMoved(aside, Vec3d{1, -2, 3} * 0.5);
    EXPECT_FALSE(render::findNeeds(aside).motion);
    EXPECT_TRUE(render::findNeeds(built("")).motion);
    EXPECT_FALSE(render::findNeeds(built("", "0")).motion);
}

TEST_F(Velocities, StaggeredGridsAreReadAsSuchUnlessAskedFor) {
    GridSpec velocity = vectors("vel");
    velocity.colour = [](Vec3i v) { return Vec3d{0.01 * v.x, 0.01 * v.y, 0.01 * v.z}; };
    velocity.gridClass = "staggered";
    write({smoke(), velocity});
    // To first order; the second look-up takes a hundredth of it.
    EXPECT_NEAR(moved(built("")).x, 0.01 * 7.5, 2e-3);
    EXPECT_NEAR(moved(built("velocity_sampling = \"collocated\"\n")).x, 0.01 * 7, 2e-3);
}

TEST_F(Velocities, MoveAllGridsTogether) {
    GridSpec heat = smoke(), colour = vectors("Cd", {0.5, 0.25, 1});
    heat.name = "flame";
    write({smoke(), heat, colour, vectors("vel")});
    const render::Scene scene = built("albedo_grid = \"Cd\"\nemission = { grid = \"flame\" }\n");
    const medium::MediumPart& part = scene.medium.parts.at(0);
    EXPECT_TRUE(part.description().albedoMotion);
    const medium::EmissionPart& glow = scene.medium.emission.at(0);
    const render::Scene still =
        built("albedo_grid = \"Cd\"\nemission = { grid = \"flame\" }\n", "0");
    for (const float time : {0.0f, 0.3f, 1.0f}) {
        const Vec3d p{3.1, 3.3, 4.2}, from = p - Vec3d{1, -2, 3} * double{time};
        for (int c = 0; c < 3; ++c) {
            EXPECT_NEAR(part.sigmaS(p, time)[c], still.medium.parts[0].sigmaS(from)[c], 1e-5);
            EXPECT_NEAR(glow.value(p, time)[c], still.medium.emission[0].value(from)[c], 1e-5);
        }
    }
}

TEST_F(Velocities, Mistakes) {
    write({smoke(), vectors("vel"), component("up.x", 1)});
    EXPECT_EQ(mistake("velocity = \"vell\"\n"),
              "scene.toml:4:12: grid 'vell' not found in " + (dir / "a.vdb").string() +
                  "; did you mean 'vel'? it has: density (float), vel (vec3s), up.x (float)");
    // Also where the shutter opens for no time.
    EXPECT_NE(mistake("velocity = \"vell\"\n", "0"), "");
    EXPECT_EQ(mistake("velocity = \"density\"\n"),
              "scene.toml:4:12: grid 'density' in " + (dir / "a.vdb").string() +
                  " is of type float; velocities are a vector grid, or three scalar ones such as "
                  "vel.x, vel.y and vel.z; vector grids there: vel");
    EXPECT_NE(mistake("velocity = \"up.x\"\n").find("is of type float"), std::string::npos);
    GridSpec beside = vectors("vel");
    beside.worldFromIndex = Affine3d::translate({1000, 0, 0});
    write({smoke(), beside});
    EXPECT_NE(mistake("").find("the velocities of grid 'vel'"), std::string::npos) << mistake("");
    EXPECT_NE(mistake("").find("lie beside what they should move"), std::string::npos);
    EXPECT_EQ(mistake("", "0"), "");
    GridSpec cone = vectors("vel");
    cone.frustum = true;
    write({smoke(), cone});
    EXPECT_NE(mistake("").find("vel"), std::string::npos) << mistake("");
    write({smoke(), vectors("vel", {1e15, 0, 0})});
    EXPECT_NE(mistake("").find("velocities move a grid by up to 2e+15 voxels"), std::string::npos)
        << mistake("");
    write({smoke(), vectors("vel", {std::nan(""), 0, 0})});
    EXPECT_NE(mistake("").find("NaN"), std::string::npos) << mistake("");
}

}  // namespace
}  // namespace woodcock::test
