// SPDX-License-Identifier: Apache-2.0
#include "woodcock/scene/build.h"

#include <gtest/gtest.h>

#include "tests/scene/built_scene.h"
#include "tests/support/paths.h"
#include "woodcock/base/error.h"
#include "woodcock/base/temp_dir.h"
#include "woodcock/scene/defaults.h"
#include "woodcock/scene/scene_file.h"

namespace woodcock::test {

using namespace light;
using namespace medium;
using namespace render;
using namespace scene;
using namespace surface;

namespace {

const std::string materials = R"(
[[material]]
name = "glass"
type = "dielectric"
ior = 1.4
[[material]]
name = "air"
type = "interface"
[[material]]
name = "lamp"
type = "emissive"
radiance = [3, 2, 1]
)";
BuiltScene build(const std::string& text, const std::filesystem::path& base = ".") {
    return buildLit(materials + text, base);
}
std::string loadMistake(const std::string& text, const std::filesystem::path& base = ".") {
    return buildMistake(materials + text, base);
}
const MeshLight* emitterOf(const Scene& scene) {
    for (const Light& light : scene.lights.lights())
        if (const auto* mesh = std::get_if<MeshLight>(&light)) return mesh;
    return nullptr;
}
double areaOf(const MeshLight::Triangle& t) {
    return length(cross(t.corner[1] - t.corner[0], t.corner[2] - t.corner[0])) / 2;
}
double areaOf(std::span<const MeshLight::Triangle> triangles) {
    double area = 0;
    for (const auto& t : triangles) area += areaOf(t);
    return area;
}

/// A tetrahedron at the origin, as OBJ; faces outwards or inwards, with all sides or without one.
std::string tetrahedron(bool outwards, bool closed) {
    std::string obj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n";
    const char* const out[] = {"f 1 3 2\n", "f 1 2 4\n", "f 1 4 3\n", "f 2 3 4\n"};
    const char* const in[] = {"f 1 2 3\n", "f 1 4 2\n", "f 1 3 4\n", "f 2 4 3\n"};
    for (int i = 0; i < (closed ? 4 : 3); ++i) obj += outwards ? out[i] : in[i];
    return obj;
}

TEST(BuildSurfaces, ASceneWithoutSurfacesHasNone) {
    const BuiltScene built =
        build("[[volume]]\nbox = { min = [0, 0, 0], max = [1, 1, 1] }\nscale = 1");
    EXPECT_EQ(built.scene.surfaces, nullptr);
    EXPECT_TRUE(built.scene.interiorMedia.empty());
}

TEST(BuildSurfaces, PlacesShapesWhereTheyAreDescribed) {
    const BuiltScene built = build(
        "[[surface]]\nname = \"ball\"\nsphere = { centre = [1, 2, 3], radius = 2 }\n"
        "transform = { translate = [10, 0, 0] }\ninstances = [{ scale = 3 }, {}]\n"
        "[[surface]]\nbox = { min = [-1, 0, 5], max = [0, 3, 6] }\n"
        "[[surface]]\nplane = { size = [4, 6] }\n");
    const SurfaceSet& set = *built.scene.surfaces;
    ASSERT_EQ(set.geometry.instances().size(), 4u);
    // The scale is about the origin and before the move: the centre goes to 10 + 3 x 1.
    EXPECT_EQ(set.geometry.instances()[0].worldFromObject.point({0, 0, 0}), (Vec3d{13, 6, 9}));
    EXPECT_EQ(set.geometry.instances()[0].worldFromObject.point({1, 0, 0}), (Vec3d{19, 6, 9}));
    EXPECT_EQ(set.geometry.instances()[1].worldFromObject.point({0, 0, 0}), (Vec3d{11, 2, 3}));
    ASSERT_EQ(set.objects.size(), 3u);
    EXPECT_EQ(set.objects[0].name, "ball");
    EXPECT_EQ(set.objects[1].name, "surface[1]");
    SurfaceHit hit;
    ASSERT_TRUE(set.geometry.intersect({-0.5, 1, 20}, {0, 0, -1}, 1e9, nullptr, hit));
    EXPECT_NEAR(hit.position.z, 6, 1e-6);
    EXPECT_EQ(hit.object, 1u);
    ASSERT_TRUE(set.geometry.intersect({1.9, 5, -2.9}, {0, -1, 0}, 1e9, nullptr, hit));
    EXPECT_EQ(hit.object, 2u);
    EXPECT_FALSE(set.geometry.intersect({2.1, 5, -2.9}, {0, -1, 0}, 1e9, nullptr, hit));
    EXPECT_TRUE(std::holds_alternative<DiffuseMaterial>(set.materials[set.objects[1].material]));
}

TEST(BuildSurfaces, MediaAndPriorities) {
    const BuiltScene built = build(
        "[[surface]]\nname = \"a\"\nsphere = {}\nmaterial = \"glass\"\npriority = 3\n"
        "transform = { scale = [1, 5, 1] }\nmedium = { sigma_a = [1, 2, 3], sigma_s = 1, g = 0.5 "
        "}\n"
        "[[surface]]\nsphere = {}\nmaterial = \"glass\"\n"
        "[[surface]]\nsphere = {}\nmaterial = \"air\"\n"
        "[[surface]]\nsphere = {}\n"
        "[[volume]]\nbox = { min = [0, 0, 0], max = [1, 1, 1] }\nscale = 7\ninside = \"a\"\n"
        "[[volume]]\nbox = { min = [0, 0, 0], max = [1, 1, 1] }\nscale = 9\n");
    const Scene& scene = built.scene;
    const auto& objects = scene.surfaces->objects;
    ASSERT_EQ(scene.medium.parts.size(), 1u);
    EXPECT_EQ(scene.medium.parts[0].scattering(), Rgb(9));

    EXPECT_TRUE(objects[0].holdsMedium);
    EXPECT_EQ(objects[0].ior, 1.4);
    EXPECT_EQ(objects[0].priority, 3);
    ASSERT_GE(objects[0].medium, 1u);
    const Medium& inside = scene.interiorMedia[objects[0].medium - 1];
    ASSERT_EQ(inside.parts.size(), 2u);
    EXPECT_EQ(inside.parts[0].scattering(), Rgb(7));
    EXPECT_EQ(inside.parts[1].absorption(), Rgb(1, 2, 3));
    EXPECT_EQ(inside.parts[1].phase().meanCosine(), 0.5);
    // All of the sphere, which is stretched.
    const Box3d box = inside.parts[1].worldBounds();
    for (const double y : {-5.0, 5.0}) EXPECT_TRUE(box.contains({0, y, 0}));

    // Glass and air without a medium hold a vacuum, not what is around them.
    EXPECT_TRUE(scene.interiorMedia[objects[1].medium - 1].parts.empty());
    EXPECT_EQ(objects[2].medium, objects[1].medium);
    EXPECT_EQ(objects[2].ior, 1);
    EXPECT_FALSE(objects[3].holdsMedium);
    EXPECT_EQ(objects[3].medium, 0u);
}

TEST(BuildSurfaces, BelowAnInfinitePlaneTheMediumReachesFar) {
    const BuiltScene built = build(
        "[[surface]]\nplane = {}\nmaterial = \"glass\"\nmedium = { sigma_a = 1 }\n"
        "transform = { translate = [0, 500, 0] }");
    const Medium& sea = built.scene.interiorMedia.at(0);
    for (const Vec3d& p : {Vec3d{0, -1e9, 0}, Vec3d{1e9, 499, -1e9}})
        EXPECT_EQ(sea.parts.at(0).sigmaT(p), Rgb(1));
    EXPECT_TRUE(built.scene.surfaces->geometry.bounds().empty());
}

TEST(BuildSurfaces, EmittersHaveTheAreaOfTheirShapes) {
    const BuiltScene sphere = build("[[surface]]\nsphere = { radius = 2 }\nmaterial = \"lamp\"");
    ASSERT_NE(emitterOf(sphere.scene), nullptr);
    EXPECT_NEAR(areaOf(emitterOf(sphere.scene)->triangles()), 4 * pi * 4, 1e-4);
    for (const auto& t : emitterOf(sphere.scene)->triangles()) {
        EXPECT_EQ(t.radiance, Rgb(3, 2, 1));
        const Vec3d normal = cross(t.corner[1] - t.corner[0], t.corner[2] - t.corner[0]);
        EXPECT_GT(dot(normal, t.corner[0]), 0);
        for (const Vec3d& p : t.corner) EXPECT_NEAR(length(p), 2, 2e-3);
    }
    const BuiltScene disk = build("[[surface]]\ndisk = { radius = 3 }\nmaterial = \"lamp\"");
    EXPECT_NEAR(areaOf(emitterOf(disk.scene)->triangles()), pi * 9, 1e-4);
    for (const auto& t : emitterOf(disk.scene)->triangles())
        EXPECT_GT(cross(t.corner[1] - t.corner[0], t.corner[2] - t.corner[0]).y, 0);
}

TEST(BuildSurfaces, EmittersAreCountedByInstance) {
    const BuiltScene built = build(
        "[[surface]]\nsphere = {}\n"
        "[[surface]]\nbox = { min = [0, 0, 0], max = [1, 1, 1] }\nmaterial = \"lamp\"\n"
        "instances = [{}, { scale = [-2, 2, 2] }]\n"
        "[[surface]]\nplane = { size = [1, 1] }\nmaterial = \"lamp\"");
    const SurfaceSet& set = *built.scene.surfaces;
    EXPECT_EQ(set.firstEmitter, (std::vector<std::uint32_t>{SurfaceObject::dark, 0, 12, 24}));
    const auto triangles = emitterOf(built.scene)->triangles();
    ASSERT_EQ(triangles.size(), 26u);
    EXPECT_NEAR(areaOf(triangles.subspan(12, 12)), 24, 1e-6);
    // Outwards of the mirrored box as well, and where rays find the same triangle.
    const Vec3d centre{-1, 1, 1};
    for (size_t i = 12; i < 24; ++i) {
        const auto& t = triangles[i];
        const Vec3d middle = (t.corner[0] + t.corner[1] + t.corner[2]) / 3;
        const Vec3d normal = normalize(cross(t.corner[1] - t.corner[0], t.corner[2] - t.corner[0]));
        EXPECT_GT(dot(normal, middle - centre), 0);
        SurfaceHit hit;
        ASSERT_TRUE(set.geometry.intersect(middle + normal * 0.1, -normal, 0.2, nullptr, hit));
        EXPECT_EQ(set.firstEmitter[hit.instance] + hit.primitive, i);
    }
}

TEST(BuildSurfaces, OpenMeshesCannotHoldGlass) {
    const TempDir dir;
    writeText(dir / "open.obj", tetrahedron(true, false));
    writeText(dir / "inwards.obj", tetrahedron(false, true));
    const std::string mistake =
        loadMistake("[[surface]]\nfile = \"open.obj\"\nmaterial = \"glass\"", dir.path());
    EXPECT_NE(mistake.find("scene.toml:14:8: "), std::string::npos) << mistake;
    EXPECT_NE(mistake.find("open.obj is not closed (3 open edges, the first one at ("),
              std::string::npos)
        << mistake;
    EXPECT_EQ(loadMistake("[[surface]]\nfile = \"open.obj\"", dir.path()), "");

    const BuiltScene built =
        build("[[surface]]\nfile = \"inwards.obj\"\nmaterial = \"glass\"", dir.path());
    ASSERT_EQ(built.loaded.notes.size(), 1u);
    EXPECT_NE(built.loaded.notes[0].find("inwards.obj faces inwards: turned over"),
              std::string::npos);
    SurfaceHit hit;
    ASSERT_TRUE(
        built.scene.surfaces->geometry.intersect({0.2, 0.2, -5}, {0, 0, 1}, 1e9, nullptr, hit));
    EXPECT_NEAR(hit.normal.z, -1, 1e-9);
    EXPECT_TRUE(build("[[surface]]\nfile = \"inwards.obj\"", dir.path()).loaded.notes.empty());
}

TEST(BuildSurfaces, MissingFilesHaveAPlace) {
    const std::string mesh = loadMistake("[[surface]]\nfile = \"missing.obj\"");
    EXPECT_EQ(mesh.substr(0, 17), "scene.toml:14:8: ") << mesh;
    EXPECT_NE(mesh.find("missing.obj"), std::string::npos) << mesh;
    const std::string places = loadMistake("[[surface]]\nsphere = {}\ninstances = \"none.txt\"");
    EXPECT_EQ(places.substr(0, 18), "scene.toml:15:13: ") << places;
    EXPECT_NE(places.find("none.txt"), std::string::npos) << places;
}

/// One texel of full red, one of black, eight bits each.
const std::string twoTexels = "P3\n2 1\n255\n255 0 0 0 0 0\n";

std::string textured(const std::string& material) {
    return "[[surface]]\nplane = { size = [2, 2] }\nmaterial = \"w\"\n[[material]]\nname = "
           "\"w\"\n" +
           material;
}

TEST(BuildSurfaces, TexturesAreReadAndMultiplied) {
    const TempDir dir;
    writeText(dir / "two.ppm", twoTexels);
    const BuiltScene built = build(
        textured("type = \"diffuse\"\ncolour = { image = \"two.ppm\", colour_space = \"data\", "
                 "times = [0.5, 1, 1] }"),
        dir.path());
    const SurfaceSet& set = *built.scene.surfaces;
    const auto& diffuse = std::get<DiffuseMaterial>(set.materials[set.objects[0].material]);
    EXPECT_EQ(diffuse.colour.at(0.25, 0.5), Rgb(0.5f, 0, 0));
    EXPECT_EQ(diffuse.colour.at(0.75, 0.5), Rgb(0.0f));
}

TEST(BuildSurfaces, TexturesMustNotMakeLight) {
    const TempDir dir;
    writeText(dir / "two.ppm", twoTexels);
    const auto file = (dir / "two.ppm").string();
    EXPECT_EQ(loadMistake(textured("type = \"diffuse\"\n"
                                   "colour = { image = \"two.ppm\", times = 1.25 }"),
                          dir.path()),
              "scene.toml:19:39: material[3].colour reaches 1.25 with " + file +
                  ", but a colour is at most 1; give times = 1 or less");
    EXPECT_EQ(loadMistake(textured("type = \"emissive\"\n"
                                   "radiance = { image = \"two.ppm\", times = 1.25 }"),
                          dir.path()),
              "");
    const std::string missing =
        loadMistake(textured("type = \"diffuse\"\ncolour = { image = \"none.png\" }"));
    EXPECT_EQ(missing.substr(0, 18), "scene.toml:19:20: ") << missing;
    EXPECT_NE(missing.find("none.png"), std::string::npos) << missing;
}

TEST(BuildSurfaces, EmissionOfATextureIsItsMeanOverEachTriangle) {
    const TempDir dir;
    writeText(dir / "two.ppm", twoTexels);
    const BuiltScene built = build(textured("type = \"emissive\"\n"
                                            "radiance = { image = \"two.ppm\", times = 8 }"),
                                   dir.path());
    const auto triangles = emitterOf(built.scene)->triangles();
    ASSERT_EQ(triangles.size(), 2u);
    // Both together are the whole image, half of which is red.
    EXPECT_NEAR(triangles[0].radiance[0] + triangles[1].radiance[0], 8, 0.2);
    EXPECT_EQ(triangles[0].radiance[1], 0);
}

TEST(BuildSurfaces, MixturesEmitTheirShare) {
    const BuiltScene built = build(
        "[[surface]]\nsphere = {}\nmaterial = \"m\"\n[[material]]\nname = \"m\"\n"
        "type = \"mix\"\nfirst = \"lamp\"\nsecond = \"air\"\nweight = 0.25");
    EXPECT_EQ(emitterOf(built.scene)->triangles()[0].radiance, Rgb(2.25f, 1.5f, 0.75f));
}

TEST(BuildSurfaces, AVolumeFillsOneInstance) {
    const TempDir dir;
    writeText(dir / "two.txt", "0 0 0\n1 2 3\n");
    EXPECT_EQ(loadMistake("[[surface]]\nname = \"a\"\nsphere = {}\nmaterial = \"glass\"\n"
                          "instances = \"two.txt\"\n[[volume]]\n"
                          "box = { min = [0, 0, 0], max = [1, 1, 1] }\nscale = 1\ninside = \"a\"",
                          dir.path()),
              "scene.toml:21:10: 'a' stands in 2 places; a volume fills a surface that stands in "
              "one");
}

TEST(CompleteScene, FramesSurfacesAlone) {
    SceneDescription scene = parseSceneText(
        "[[surface]]\nsphere = { centre = [100, 0, 0], radius = 2 }\n[[surface]]\nplane = {}",
        "scene.toml", ".");
    const LoadedScene loaded = loadScene(scene);
    const auto notes = completeScene(scene, loaded);
    ASSERT_EQ(notes.size(), 2u);
    EXPECT_EQ(notes[0].substr(0, 27), "chosen to frame the scene (");
    const auto& pose = std::get<LookAt>(*scene.camera.pose);
    EXPECT_NEAR(pose.target.x, 100, 1);
    EXPECT_LT(length(pose.eye - pose.target), 20);
    EXPECT_EQ(scene.lights.size(), 3u);
}

TEST(CompleteScene, ChoosesNoLightWhereSurfacesEmit) {
    SceneDescription scene = parseSceneText(
        materials + "[[surface]]\nsphere = {}\nmaterial = \"lamp\"", "scene.toml", ".");
    const LoadedScene loaded = loadScene(scene);
    EXPECT_EQ(completeScene(scene, loaded).size(), 1u);
    EXPECT_TRUE(scene.lights.empty());
}

}  // namespace
}  // namespace woodcock::test
