// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "tests/support/scene_mistake.h"
#include "woodcock/base/error.h"
#include "woodcock/scene/scene_file.h"

namespace woodcock::test {
namespace {

/// Its lines start at line 3 of the file.
std::string materialMistake(const std::string& lines) {
    return mistakeIn("[[material]]\nname = \"m\"\n" + lines + "\n[[surface]]\nplane = {}");
}
/// From line 8 on; there are the materials glass and paint.
std::string surfaceMistake(const std::string& lines) {
    return mistakeIn(
        "[[material]]\nname = \"glass\"\ntype = \"dielectric\"\n"
        "[[material]]\nname = \"paint\"\ntype = \"diffuse\"\n[[surface]]\n" +
        lines);
}

TEST(SurfaceErrors, OfMaterials) {
    EXPECT_EQ(materialMistake("type = \"glas\""),
              "scene.toml:3:8: unknown material type 'glas'; known: diffuse, conductor, "
              "dielectric, interface, emissive, mix");
    EXPECT_EQ(materialMistake("type = \"diffuse\"\ncolor = 1"),
              "scene.toml:4:1: unknown key 'color' in a [[material]] of type diffuse; did you mean "
              "'colour'? known keys: name, type, colour");
    EXPECT_EQ(materialMistake("type = \"diffuse\"\ncolour = [0, 1.5, 0]"),
              "scene.toml:4:14: material[0].colour[1] is 1.5; it must lie between 0 and 1");
    EXPECT_EQ(materialMistake("type = \"conductor\"\ncolour = 1.01"),
              "scene.toml:4:10: material[0].colour is 1.01; it must lie between 0 and 1");
    EXPECT_EQ(materialMistake("type = \"emissive\"\nradiance = -1"),
              "scene.toml:4:12: material[0].radiance is -1; it must not be negative");
    EXPECT_EQ(materialMistake("type = \"diffuse\"\ncolour = { image = \"a.png\", gain = 2 }"),
              "scene.toml:4:29: unknown key 'gain' in material[0].colour; known keys: image, "
              "colour_space, times");
    EXPECT_EQ(materialMistake("type = \"conductor\"\neta = 1.5"),
              "scene.toml:4:7: material[0].eta needs a k beside it, such as k = [3.9, 2.5, 2.1]");
    EXPECT_EQ(materialMistake("type = \"conductor\"\neta = 1.5\nk = 1\ncolour = 1"),
              "scene.toml:4:7: material[0].eta cannot be used together with colour; give one of "
              "them: both say how "
              "much light the metal reflects");
    EXPECT_EQ(materialMistake("type = \"dielectric\"\nroughness = 1.5"),
              "scene.toml:4:13: material[0].roughness is 1.5; it must lie between 0 and 1");
    EXPECT_EQ(mistakeIn("[[surface]]\nplane = {}\n[[material]]\ntype = \"diffuse\""),
              "scene.toml:3:1: material[0] has no name; give one, such as name = \"glass\"");
}

TEST(SurfaceErrors, AnIndexBelowOneNeedsAReason) {
    EXPECT_EQ(materialMistake("type = \"dielectric\"\nior = 0.75"),
              "scene.toml:4:7: material[0].ior is 0.75: inside, light would be faster than in "
              "vacuum. A bubble of air in glass is a surface of its own, with ior = 1 and a higher "
              "priority; if it is meant all the same, say ior_below_one = true");
    EXPECT_NE(materialMistake("type = \"dielectric\"\nior = 0.75\nior_below_one = false"), "");
    EXPECT_EQ(materialMistake("type = \"dielectric\"\nior = 0\nior_below_one = true"),
              "scene.toml:4:7: material[0].ior is 0; it must lie strictly between 0 and 100");
}

TEST(SurfaceErrors, OfMixtures) {
    const std::string mix = "type = \"mix\"\nfirst = \"m\"\nsecond = \"b\"\n";
    EXPECT_EQ(materialMistake(mix),
              "scene.toml:4:9: material[0].first is 'm', a mix itself; a mix is of two other "
              "materials");
    EXPECT_EQ(materialMistake("type = \"mix\"\nfirst = \"pant\"\nsecond = \"b\"\n"
                              "[[material]]\nname = \"paint\"\ntype = \"diffuse\""),
              "scene.toml:4:9: material[0].first is 'pant', but no material has this name; did you "
              "mean 'paint'? materials: m, paint");
    EXPECT_EQ(
        materialMistake("type = \"mix\"\nfirst = \"a\"\nsecond = \"b\"\n"
                        "[[material]]\nname = \"a\"\ntype = \"dielectric\"\n"
                        "[[material]]\nname = \"b\"\ntype = \"dielectric\"\nior = 1.3"),
        "scene.toml:1:1: material[0] mixes dielectrics of ior 1.5 and 1.3, but what is inside "
        "has one");
}

TEST(SurfaceErrors, OfNames) {
    EXPECT_EQ(surfaceMistake("plane = {}\nmaterial = \"glas\""),
              "scene.toml:9:12: surface[0].material is 'glas', but no material has this name; did "
              "you mean 'glass'? materials: glass, paint");
    EXPECT_EQ(mistakeIn("[[surface]]\nplane = {}\nmaterial = \"red\""),
              "scene.toml:3:12: surface[0].material is 'red', but no material has this name; "
              "materials: none");
    EXPECT_EQ(surfaceMistake("plane = {}\n[[material]]\nname = \"paint\"\ntype = \"diffuse\""),
              "scene.toml:10:8: material[2].name is 'paint', which is the name of material[1] "
              "already");
    EXPECT_EQ(surfaceMistake("name = \"a\"\nplane = {}\n[[surface]]\nname = \"a\"\nplane = {}"),
              "scene.toml:11:8: surface[1].name is 'a', which is the name of surface[0] already");
    EXPECT_EQ(surfaceMistake("plane = {}\n[[surface]]\nplane = {}"), "");
}

TEST(SurfaceErrors, OfShapes) {
    EXPECT_EQ(
        surfaceMistake("name = \"a\""),
        "scene.toml:7:1: surface[0] has no shape; give one of file, sphere, box, disk, plane, "
        "lathe, facets, such as file = \"mesh.obj\" or sphere = { centre = [0, 0, 0], radius = 1 "
        "}");
    EXPECT_EQ(surfaceMistake("file = \"a.obj\"\ndisk = {}"),
              "scene.toml:9:8: surface[0].disk cannot be used together with file; give one of "
              "them: a surface has "
              "one shape, and others are surfaces too");
    EXPECT_EQ(surfaceMistake("sphere = { center = [0, 0, 0] }"),
              "scene.toml:8:12: unknown key 'center' in surface[0].sphere; did you mean 'centre'? "
              "known keys: centre, radius");
    EXPECT_EQ(surfaceMistake("sphere = { radius = 0 }"),
              "scene.toml:8:21: surface[0].sphere.radius is 0; it must be positive");
    EXPECT_EQ(surfaceMistake("plane = { size = [1] }"),
              "scene.toml:8:18: surface[0].plane.size has 1 element; expected [width, depth]");
    EXPECT_EQ(surfaceMistake("lathe = { profile = [[0, 1]] }"),
              "scene.toml:8:21: surface[0].lathe.profile has 1 points; a lathe needs two at least");
    EXPECT_EQ(surfaceMistake("lathe = { profile = [[0, 1], [-1, 2]] }"),
              "scene.toml:8:31: surface[0].lathe.profile[1][0] is -1; it must not be negative");
    EXPECT_EQ(surfaceMistake("file = \"a.obj\"\nlevel_set = \"x\""),
              "scene.toml:9:13: surface[0].level_set names a grid of a VDB file, but file is "
              "'a.obj'");
    EXPECT_EQ(surfaceMistake("disk = {}\nlevel_set = \"x\""),
              "scene.toml:9:13: surface[0].level_set needs a file: it names a grid of a VDB file");
    EXPECT_EQ(
        surfaceMistake("disk = {}\nsmooth = 30"),
        "scene.toml:9:10: surface[0].smooth is for surfaces of a file or a lathe; the normals "
        "of other shapes are exact");
    EXPECT_EQ(surfaceMistake("lathe = { profile = [[0, 0], [1, 1]] }\nsmooth = \"file\""),
              "scene.toml:9:10: surface[0].smooth is \"file\", but the surface is a lathe");
    EXPECT_EQ(surfaceMistake("disk = {}\ntransform = { scale = [1, 0, 1] }"),
              "scene.toml:9:23: surface[0].transform.scale is zero; it would flatten the surface");
    EXPECT_EQ(
        surfaceMistake("disk = {}\ninstances = []"),
        "scene.toml:9:13: surface[0].instances is empty; leave it out, and the surface stands "
        "there once");
}

TEST(SurfaceErrors, OfMedia) {
    const std::string ball = "sphere = {}\nmaterial = \"glass\"\n";
    EXPECT_EQ(surfaceMistake(ball + "medium = {}"),
              "scene.toml:10:10: surface[0].medium holds nothing; give sigma_a and sigma_s, scale "
              "and albedo, colour and distance, or emission, or leave it out");
    EXPECT_EQ(surfaceMistake(ball + "medium = { colour = [1, 0, 1], distance = 1 }"),
              "scene.toml:10:21: surface[0].medium.colour is 0 in its green channel, which would "
              "need infinite absorption; give what little comes through, such as 0.001");
    EXPECT_EQ(
        surfaceMistake(ball + "medium = { colour = 0.5 }"),
        "scene.toml:10:21: surface[0].medium.colour needs a distance beside it: how far light "
        "goes to become so");
    EXPECT_EQ(surfaceMistake(ball + "medium = { distance = 0.5, sigma_a = 1 }"),
              "scene.toml:10:23: surface[0].medium.distance needs a colour beside it: what light "
              "becomes over that distance");
    EXPECT_EQ(surfaceMistake(ball + "medium = { colour = 0.5, distance = 0 }"),
              "scene.toml:10:37: surface[0].medium.distance is 0; it must be positive");
    EXPECT_EQ(surfaceMistake(ball + "medium = { emission = -1 }"),
              "scene.toml:10:23: surface[0].medium.emission is -1; it must not be negative");
    const std::string sea = "plane = {}\nmaterial = \"glass\"\n";
    EXPECT_EQ(
        surfaceMistake(sea + "medium = { emission = 1, sigma_a = [1, 0, 1] }"),
        "scene.toml:10:23: surface[0].medium.emission would be infinitely bright: it fills all "
        "below a plane and absorbs nothing in its green channel; give it a sigma_a, or the "
        "plane a size");
    EXPECT_EQ(surfaceMistake(sea + "medium = { emission = [1, 0, 1], sigma_a = [1, 0, 1] }"), "");
    EXPECT_EQ(surfaceMistake(ball + "medium = { colour = 0.5, distance = 1e-300 }"),
              "scene.toml:10:37: surface[0].medium.distance is 1e-300: too short for a float's "
              "sigma_a");
    EXPECT_EQ(surfaceMistake(ball + "medium = { colour = 0.5, distance = 1, sigma_a = 1 }"),
              "scene.toml:10:21: surface[0].medium.colour cannot be used together with sigma_a; "
              "give one of them: "
              "both say how much the medium absorbs");
    EXPECT_EQ(surfaceMistake("sphere = {}\nmaterial = \"paint\"\nmedium = { sigma_a = 1 }"),
              "scene.toml:10:10: surface[0].medium can never be seen: 'paint', of type diffuse, "
              "lets no light in; a dielectric or an interface does");
    EXPECT_EQ(
        surfaceMistake("sphere = {}\nmedium = { sigma_a = 1 }"),
        "scene.toml:9:10: surface[0].medium can never be seen: the default material, diffuse, "
        "lets no light in; a dielectric or an interface does");
}

TEST(SurfaceErrors, WhatIsOpenEnclosesNothing) {
    EXPECT_EQ(surfaceMistake("disk = {}\nmaterial = \"glass\""),
              "scene.toml:8:8: surface[0].disk encloses nothing, so its material, 'glass', cannot "
              "tell inside from outside; give a closed shape, such as a thin box");
    EXPECT_EQ(surfaceMistake("plane = { size = [1, 1] }\nmaterial = \"glass\""),
              "scene.toml:8:9: surface[0].plane encloses nothing, so its material, 'glass', cannot "
              "tell inside from outside; give a closed shape, such as a thin box, or an infinite "
              "plane");
    EXPECT_EQ(surfaceMistake("plane = {}\nmaterial = \"glass\"\nmedium = { sigma_a = 1 }"), "");
}

TEST(SurfaceErrors, AnInfinitePlaneCannotEmit) {
    EXPECT_EQ(surfaceMistake("plane = {}\nmaterial = \"lamp\"\n[[material]]\nname = \"lamp\"\n"
                             "type = \"emissive\""),
              "scene.toml:8:9: surface[0].plane is infinite and would emit without end ('lamp' is "
              "emissive); give it a size");
}

TEST(SurfaceErrors, OfVolumesInside) {
    const std::string volume = "\n[[volume]]\nfile = \"a.vdb\"\ninside = \"ball\"";
    const std::string ball = "name = \"ball\"\nsphere = {}\n";
    EXPECT_EQ(surfaceMistake("name = \"bell\"\nsphere = {}\nmaterial = \"glass\"" + volume),
              "scene.toml:13:10: volume[0].inside is 'ball', but no surface has this name; did you "
              "mean 'bell'? surfaces: bell");
    EXPECT_EQ(surfaceMistake(ball + "material = \"paint\"" + volume),
              "scene.toml:13:10: volume[0].inside is 'ball', where it can never be seen: 'paint', "
              "of type diffuse, lets no light in; a dielectric or an interface does");
    EXPECT_EQ(
        surfaceMistake(ball + "material = \"glass\"\ninstances = [{}, { scale = 2 }]" + volume),
        "scene.toml:14:10: volume[0].inside is 'ball', which stands in 2 places; a volume "
        "fills a surface that stands in one");
    EXPECT_EQ(surfaceMistake(ball + "material = \"glass\"" + volume), "");
}

TEST(SurfaceErrors, OfContradictoryCompositing) {
    EXPECT_EQ(surfaceMistake("disk = {}\nmatte = true\nholdout = true"),
              "scene.toml:9:9: surface[0].matte is true, but so is holdout: each says what the "
              "camera sees of the surface, and they contradict each other");
    EXPECT_EQ(surfaceMistake("disk = {}\nmatte = true\ncamera_visible = false"),
              "scene.toml:9:9: surface[0].matte is true, but so is camera_visible = false: each "
              "says what the camera sees of the surface, and they contradict each other");
}

TEST(SurfaceErrors, OfOverrides) {
    EXPECT_EQ(mistakeIn("[[surface]]\nplane = {}", {"surface[1].matte=true"}),
              "--set surface[1].matte=true: the scene has 1 surface, surface[0]");
    EXPECT_EQ(mistakeIn("[[surface]]\nplane = {}", {"material[0].ior=2"}),
              "--set material[0].ior=2: the scene has no material");
}

}  // namespace
}  // namespace woodcock::test
