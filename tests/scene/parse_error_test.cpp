// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cstdlib>

#include "tests/support/paths.h"
#include "tests/support/scene_mistake.h"
#include "woodcock/base/error.h"
#include "woodcock/base/nearest_name.h"
#include "woodcock/image/layers.h"
#include "woodcock/scene/scene_file.h"

namespace woodcock::test {

using namespace scene;
namespace {

std::string volumeMistake(const std::string& lines) {
    return mistakeIn("[[volume]]\nfile = \"a.vdb\"\n" + lines);
}
std::string lightMistake(const std::string& lines) {
    return mistakeIn("[[volume]]\nfile = \"a.vdb\"\n[[light]]\n" + lines);
}
std::string sectionMistake(const std::string& lines) {
    return mistakeIn("[[volume]]\nfile = \"a.vdb\"\n" + lines);
}

TEST(ParseErrors, NamePlaceValueAndRange) {
    EXPECT_EQ(volumeMistake("    g = 1.5"),
              "scene.toml:3:9: volume[0].g is 1.5; it must lie strictly between -1 and 1");
    EXPECT_EQ(volumeMistake("g = -1"),
              "scene.toml:3:5: volume[0].g is -1; it must lie strictly between -1 and 1");
    EXPECT_EQ(volumeMistake("g = 0.99995"),
              "scene.toml:3:5: volume[0].g is 0.99995; it must lie between -0.9999 and 0.9999");
    EXPECT_EQ(volumeMistake("g = nan"), "scene.toml:3:5: volume[0].g is nan; it must be finite");
    EXPECT_EQ(volumeMistake("g = 0.9999"), "");
}

TEST(ParseErrors, NameTheNearestKnownKey) {
    EXPECT_EQ(
        volumeMistake("albdo = 1"),
        "scene.toml:3:1: unknown key 'albdo' in [[volume]]; did you mean 'albedo'? known "
        "keys: name, file, box, frame_start, offset, outside, missing, density, scale, albedo, "
        "albedo_grid, sigma_a, sigma_s, emission, blackbody, group, g, phase, transform, matrix, "
        "velocity, velocity_scale, velocity_unit, velocity_sampling, inside, storage, "
        "background, repair");
    EXPECT_EQ(
        sectionMistake("[rendr]\nspp = 1"),
        "scene.toml:3:2: unknown key 'rendr' in the scene; did you mean 'render'? known keys: "
        "volume, material, surface, light, camera, render, output, ocio");
    EXPECT_EQ(lightMistake("type = \"point\"\nposition = [0, 0, 0]\nradius = 1"),
              "scene.toml:6:1: unknown key 'radius' in a [[light]] of type point; known keys: "
              "group, type, "
              "position, intensity, power, ies, direction, look_at, roll, up");
}

TEST(ParseErrors, ReportTheFirstUnknownKeyOfTheFile) {
    EXPECT_EQ(volumeMistake("zeta = 1\nalpha = 2").substr(0, 35),
              "scene.toml:3:1: unknown key 'zeta' ");
}

TEST(ParseErrors, OfSyntaxHavePlaces) {
    EXPECT_EQ(mistakeIn("[[volume]]\nfile = = 3").substr(0, 16), "scene.toml:2:8: ");
    EXPECT_EQ(mistakeIn("ocio = \"a\nb\"").substr(0, 13), "scene.toml:1:");
    EXPECT_EQ(mistakeIn("ocio = \"\xff\"").substr(0, 13), "scene.toml:1:");
    EXPECT_EQ(mistakeIn("[render]\nspp = 1\nspp = 2").substr(0, 13), "scene.toml:3:");
}

TEST(ParseErrors, OfTypes) {
    EXPECT_EQ(mistakeIn("[[volume]]\nfile = 3"),
              "scene.toml:2:8: volume[0].file is an integer; expected a string");
    EXPECT_EQ(volumeMistake("g = \"0.5\""),
              "scene.toml:3:5: volume[0].g is a string; expected a number");
    EXPECT_EQ(volumeMistake("scale = true"),
              "scene.toml:3:9: volume[0].scale is a boolean; expected a number or [r, g, b]");
    EXPECT_EQ(volumeMistake("scale = [1, 2]"),
              "scene.toml:3:9: volume[0].scale has 2 elements; expected a number or [r, g, b]");
    EXPECT_EQ(volumeMistake("scale = [1, 2, \"x\"]"),
              "scene.toml:3:16: volume[0].scale[2] is a string; expected a number");
    EXPECT_EQ(volumeMistake("repair = 1"),
              "scene.toml:3:10: volume[0].repair is an integer; expected true or false");
    EXPECT_EQ(volumeMistake("transform = [1, 0, 0]"),
              "scene.toml:3:13: volume[0].transform is an array; expected a table");
    EXPECT_EQ(volumeMistake("density = \"\""),
              "scene.toml:3:11: volume[0].density is empty; give a name or leave the key out");
    EXPECT_EQ(mistakeIn("volume = 3"),
              "scene.toml:1:10: volume is an integer; expected a list of [[volume]] tables");
    EXPECT_EQ(mistakeIn("[volume]\nfile = \"a.vdb\""),
              "scene.toml:1:1: volume is a single table; write [[volume]] in double brackets, as "
              "there can be several");
    EXPECT_EQ(mistakeIn("volume = [3]"),
              "scene.toml:1:11: volume[0] is an integer; expected a table");
    EXPECT_EQ(volumeMistake("g = 2024-01-01"),
              "scene.toml:3:5: volume[0].g is a date or time; expected a number");
}

TEST(ParseErrors, OfVolumes) {
    EXPECT_EQ(mistakeIn(""),
              "scene.toml: the scene has no [[volume]] and no [[surface]]; the least is\n"
              "[[volume]]\nfile = \"smoke.vdb\"");
    EXPECT_EQ(
        mistakeIn("[[volume]]\ng = 0"),
        "scene.toml:1:1: volume[0] has neither file nor box; give file = \"smoke.vdb\" or box "
        "= { min = [0, 0, 0], max = [1, 1, 1] }");
    EXPECT_EQ(
        volumeMistake("sigma_s = 1\nscale = 2"),
        "scene.toml:3:11: volume[0].sigma_s cannot be used together with scale; give one of them: "
        "sigma_a and "
        "sigma_s say what scale and albedo say (sigma_t = scale x density, sigma_s = albedo x "
        "sigma_t)");
    EXPECT_EQ(volumeMistake("albedo_grid = \"Cd\"\nsigma_a = 1").substr(0, 71),
              "scene.toml:4:11: volume[0].sigma_a cannot be used together with albedo_");
    EXPECT_EQ(volumeMistake("scale = -1"),
              "scene.toml:3:9: volume[0].scale is -1; it must not be negative");
    EXPECT_EQ(
        volumeMistake("scale = 1e39"),
        "scene.toml:3:9: volume[0].scale is 1e+39; it must be at most 3.4028234663852886e+38");
    EXPECT_EQ(volumeMistake("sigma_a = [0, -0.5, 0]"),
              "scene.toml:3:15: volume[0].sigma_a[1] is -0.5; it must not be negative");
    EXPECT_EQ(volumeMistake("sigma_a = { scale = 2 }"),
              "scene.toml:3:11: volume[0].sigma_a has no grid; give one, such as grid = "
              "\"absorption\"");
    EXPECT_EQ(volumeMistake("sigma_a = { grid = \"a\", skale = 2 }"),
              "scene.toml:3:25: unknown key 'skale' in volume[0].sigma_a; did you mean 'scale'? "
              "known keys: grid, scale");
    EXPECT_EQ(volumeMistake("albedo = [1, 1, 1.01]"),
              "scene.toml:3:17: volume[0].albedo[2] is 1.01; it must lie between 0 and 1");
    EXPECT_EQ(
        volumeMistake("storage = \"double\""),
        "scene.toml:3:11: unknown storage 'double'; known: auto, half, float, fixed16, fixed8");
}

TEST(ParseErrors, OfBoxes) {
    const std::string box = "[[volume]]\nbox = { min = [0, 0, 0], max = [1, 1, 1] }\n";
    EXPECT_EQ(mistakeIn(box),
              "scene.toml:1:1: volume[0] is a box of nothing; give sigma_a and "
              "sigma_s, or scale and albedo, or emission");
    EXPECT_EQ(mistakeIn(box + "albedo = 1"),
              "scene.toml:3:10: volume[0].albedo needs a scale: here sigma_t = scale");
    EXPECT_EQ(mistakeIn(box + "scale = 1\ndensity = \"d\""),
              "scene.toml:4:11: volume[0].density needs a file: a box holds constant coefficients "
              "and no grids");
    EXPECT_EQ(mistakeIn(box + "file = \"a.vdb\"\nscale = 1").substr(0, 80),
              "scene.toml:2:7: volume[0].box cannot be used together with file; give one of the");
    EXPECT_EQ(mistakeIn("[[volume]]\nbox = { min = [0, 0, 0], max = [1, 0, 1] }\nscale = 1"),
              "scene.toml:2:36: volume[0].box.max[1] is 0; it must exceed min[1], which is 0");
    EXPECT_EQ(mistakeIn("[[volume]]\nbox = { min = [0, 0, 0] }\nscale = 1"),
              "scene.toml:2:7: volume[0].box has no max; give one, such as max = [1, 1, 1]");
}

TEST(ParseErrors, OfTransforms) {
    EXPECT_EQ(volumeMistake("transform = { scale = [1, 0, 1] }"),
              "scene.toml:3:23: volume[0].transform.scale is zero; it would flatten the volume");
    EXPECT_EQ(volumeMistake("transform = { scale = 1e-60 }"),
              "scene.toml:3:13: volume[0].transform has an axis 1e-60 long; 1e-50 to 1e+50 is "
              "possible");
    EXPECT_EQ(
        volumeMistake("matrix = [[1, 0, 0, 0], [0, 1, 0, 0], [1, 1, 0, 0], [0, 0, 0, 1]]"),
        "scene.toml:3:10: volume[0].matrix is singular: it flattens space (its determinant is "
        "0)");
    EXPECT_EQ(
        volumeMistake("matrix = [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [5, 0, 0, 1]]"),
        "scene.toml:3:10: volume[0].matrix is not affine: its last row is [5, 0, 0, 1] instead "
        "of [0, 0, 0, 1] (the translation is the last column)");
    EXPECT_EQ(
        volumeMistake("matrix = [[1, 0, 0], [0, 1, 0], [0, 0, 1]]"),
        "scene.toml:3:10: volume[0].matrix has 3 elements; expected four rows of four numbers");
    EXPECT_EQ(volumeMistake("matrix = [[1, 0, 0, inf], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]"),
              "scene.toml:3:21: volume[0].matrix[0][3] is inf; it must be finite");
    EXPECT_EQ(volumeMistake("transform = {}\nmatrix = []").substr(0, 73),
              "scene.toml:3:13: volume[0].transform cannot be used together with matrix;");
}

TEST(ParseErrors, OfPaths) {
    ASSERT_EQ(unsetenv("WOODCOCK_TEST_UNSET"), 0);
    EXPECT_EQ(mistakeIn("[[volume]]\nfile = \"$WOODCOCK_TEST_UNSET/a.vdb\""),
              "scene.toml:2:8: volume[0].file is '$WOODCOCK_TEST_UNSET/a.vdb': the environment "
              "variable WOODCOCK_TEST_UNSET is not set; set it, or give a path without it");
    EXPECT_EQ(
        mistakeIn("[[volume]]\nfile = \"a$.vdb\""),
        "scene.toml:2:8: volume[0].file is 'a$.vdb': '$' must be followed by a variable's name "
        "(write $$ for a dollar)");
}

TEST(ParseErrors, OfLights) {
    EXPECT_EQ(lightMistake("type = \"sunn\""),
              "scene.toml:4:8: unknown light type 'sunn'; known: sun, point, spot, sphere, "
              "rectangle, disk, environment, sky");
    EXPECT_EQ(lightMistake("radiance = 1"),
              "scene.toml:3:1: light[0] has no type; give one, such as type = \"sun\"");
    EXPECT_EQ(lightMistake("type = \"sun\""),
              "scene.toml:3:1: light[0] is a sun without direction or elevation; give direction = "
              "[0, -1, 0] (the way its light travels) or elevation = 40, azimuth = 120");
    EXPECT_EQ(lightMistake("type = \"sun\"\ndirection = [0, 0, 0]"),
              "scene.toml:5:13: light[0].direction is [0, 0, 0], which points nowhere");
    EXPECT_EQ(lightMistake("type = \"sun\"\ndirection = [0, -1, 0]\nelevation = 3"),
              "scene.toml:6:13: light[0].elevation cannot be used together with direction; give "
              "one of them: both "
              "say where the sun stands");
    EXPECT_EQ(lightMistake("type = \"sun\"\nelevation = 91"),
              "scene.toml:5:13: light[0].elevation is 91; it must lie between -90 and 90");
    EXPECT_EQ(lightMistake("type = \"sun\"\nelevation = 9\nangular_diameter = 91"),
              "scene.toml:6:20: light[0].angular_diameter is 91; it must lie between 0 and 90");
    EXPECT_EQ(
        lightMistake("type = \"sun\"\nelevation = 9\nvisible = true"),
        "scene.toml:6:11: light[0].visible is true, but parallel rays cannot be seen; give the "
        "sun an angular_diameter, such as 0.53");
    EXPECT_EQ(lightMistake("type = \"sun\"\nelevation = 9\nup = \"x\""),
              "scene.toml:6:6: unknown up axis 'x'; known: y, z");
    EXPECT_EQ(lightMistake("type = \"environment\"\nradiance = [1, -2, 3]"),
              "scene.toml:5:16: light[0].radiance[1] is -2; it must not be negative");
    EXPECT_EQ(lightMistake("type = \"sphere\"\nposition = [0, 0, 0]\nradius = 0"),
              "scene.toml:6:10: light[0].radius is 0; it must be positive");
    EXPECT_EQ(lightMistake("type = \"sphere\"\nradius = 1"),
              "scene.toml:3:1: light[0] has no position; give one, such as position = [0, 2, 0]");
    EXPECT_EQ(lightMistake("type = \"point\"\nposition = [0, 0, 0]\nintensity = 1\npower = 1"),
              "scene.toml:7:9: light[0].power cannot be used together with intensity; give one of "
              "them: power = 4 "
              "pi x intensity");
}

TEST(ParseErrors, OfCameras) {
    const std::string eye = "[camera]\neye = [0, 0, 5]\n";
    EXPECT_EQ(sectionMistake(eye + "look_at = [0, 0, 5]"),
              "scene.toml:5:11: camera.look_at gives no direction to look in from eye");
    EXPECT_EQ(sectionMistake(eye + "look_at = [0, 9, 5]"),
              "scene.toml:5:11: camera.look_at needs an up: [0, 1, 0] is no direction across the "
              "view; give another up, such as [0, 0, 1]");
    EXPECT_EQ(sectionMistake(eye + "look_at = [0, 0, 0]\nup = [0, 0, 2]"),
              "scene.toml:6:6: camera.up = [0, 0, 2] is no direction across the view; give another "
              "up, such as [0, 0, 1]");
    EXPECT_EQ(sectionMistake("[camera]\nup = [0, 0, 0]"),
              "scene.toml:4:6: camera.up is [0, 0, 0], which points nowhere");
    EXPECT_EQ(sectionMistake("[camera]\nfov = 180"),
              "scene.toml:4:7: camera.fov is 180; it must lie strictly between 0 and 180");
    EXPECT_EQ(sectionMistake("[camera]\nfov = 30\nfocal_length = 50"),
              "scene.toml:5:16: camera.focal_length cannot be used together with fov; give one of "
              "them: the angle "
              "follows from the focal length and the sensor");
    EXPECT_EQ(
        sectionMistake("[camera]\nfocal_length = 50"),
        "scene.toml:4:16: camera.focal_length needs a sensor_height or sensor_width beside it, "
        "in millimetres");
    EXPECT_EQ(
        sectionMistake("[camera]\nsensor_width = 36"),
        "scene.toml:4:16: camera.sensor_width needs a focal_length beside it, in millimetres");
    EXPECT_EQ(sectionMistake("[camera]\ntype = \"fisheye\""),
              "scene.toml:4:8: unknown camera type 'fisheye'; known: perspective, orthographic");
    EXPECT_EQ(sectionMistake("[camera]\ntype = \"orthographic\"\nfov = 30"),
              "scene.toml:5:1: unknown key 'fov' in an orthographic [camera]; known keys: type, "
              "height, shift, orbit, eye, look_at, up, matrix, shutter");
    EXPECT_EQ(sectionMistake("[camera]\nshutter = -0.5"),
              "scene.toml:4:11: camera.shutter is -0.5; it must lie between 0 and 1000");
    EXPECT_EQ(sectionMistake("[camera]\nshutter = [0.25, -0.25]"),
              "scene.toml:4:11: camera.shutter closes at -0.25, before it opens at 0.25; give "
              "[open, close]");
    EXPECT_EQ(sectionMistake("[camera]\nshutter = [0.25]"),
              "scene.toml:4:11: camera.shutter has 1 element; expected [open, close], in frames");
    EXPECT_EQ(
        sectionMistake(
            "[camera]\nmatrix = [[1, 1, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]"),
        "scene.toml:4:10: camera.matrix is sheared or scaled unevenly; a camera's axes must be "
        "orthogonal and equally long");
    EXPECT_EQ(sectionMistake(
                  "[camera]\nmatrix = [[-1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]"),
              "scene.toml:4:10: camera.matrix mirrors the picture (its determinant is negative)");
}

TEST(ParseErrors, OfRenderSettings) {
    EXPECT_EQ(sectionMistake("[render]\nresolution = [0, 540]"),
              "scene.toml:4:15: render.resolution[0] is 0; it must lie between 1 and 65536");
    EXPECT_EQ(sectionMistake("[render]\nresolution = [65537, 1]"),
              "scene.toml:4:15: render.resolution[0] is 65537; it must lie between 1 and 65536");
    EXPECT_EQ(sectionMistake("[render]\nresolution = [9]"),
              "scene.toml:4:14: render.resolution has 1 element; expected [width, height]");
    EXPECT_EQ(sectionMistake("[render]\nresolution = 540"),
              "scene.toml:4:14: render.resolution is an integer; expected [width, height]");
    EXPECT_EQ(sectionMistake("[render]\nspp = 0"),
              "scene.toml:4:7: render.spp is 0; it must lie between 1 and 2147483647");
    EXPECT_EQ(sectionMistake("[render]\nfps = 0"),
              "scene.toml:4:7: render.fps is 0; it must be positive");
    EXPECT_EQ(sectionMistake("[render]\nspp = 1.5"),
              "scene.toml:4:7: render.spp is a float; expected an integer");
    EXPECT_EQ(sectionMistake("[render]\nseed = -1"),
              "scene.toml:4:8: render.seed is -1; it must not be negative");
    EXPECT_EQ(
        sectionMistake("[render]\nmax_scatterings = -1"),
        "scene.toml:4:19: render.max_scatterings is -1; it must lie between 0 and 2147483647");
    EXPECT_EQ(sectionMistake("[render]\nmarch_estimate = \"jackknife\""),
              "scene.toml:4:18: render.march_estimate needs march_step: tracking takes no steps");
    EXPECT_EQ(sectionMistake("[render]\noctaves = 3\nsimilarity_after = 2"),
              "scene.toml:4:11: render.octaves cannot be used together with similarity_after: "
              "octaves have no paths "
              "that go on");
    EXPECT_EQ(sectionMistake("[render]\nmajorant_scale = 0.5"),
              "scene.toml:4:18: render.majorant_scale is 0.5; it must lie between 1 and 1000");
    EXPECT_EQ(sectionMistake("[render]\nmajorant_scale = 1001"),
              "scene.toml:4:18: render.majorant_scale is 1001; it must lie between 1 and 1000");
    EXPECT_EQ(sectionMistake("[render]\ntime_limit = -3"),
              "scene.toml:4:14: render.time_limit is -3; it must not be negative");
    EXPECT_EQ(sectionMistake("[render]\ntime_limit = \"2x\"").substr(0, 66),
              "scene.toml:4:14: render.time_limit: '2x' is not a duration; expect");
    EXPECT_EQ(sectionMistake("[render]\nnoise = 5"),
              "scene.toml:4:9: render.noise is 5; it must lie between 0 and 1");
    EXPECT_EQ(sectionMistake("[render]\nnoise = \"one\"").substr(0, 56),
              "scene.toml:4:9: render.noise: 'one' is not a fraction; e");
}

TEST(ParseErrors, OfOutputs) {
    EXPECT_EQ(sectionMistake("[output]\nfiles = \"a.exr\""),
              "scene.toml:4:9: output.files is a string; expected a list of files, such as "
              "[\"smoke.exr\"]");
    EXPECT_EQ(sectionMistake("[output]\nfiles = [\"a.exr\", \"b.tga\"]").substr(0, 48),
              "scene.toml:4:19: output.files[1]: cannot write '");
    EXPECT_EQ(sectionMistake("[output]\nlayers = [\"deep\"]"),
              "scene.toml:4:11: output.layers[0]: unknown layer 'deep'; known layers: " +
                  joinNames(image::layerNames()));
    EXPECT_EQ(sectionMistake("[output]\nlayers = \"depth:half\""),
              "scene.toml:4:10: output.layers: the layer 'depth' is float always: half precision "
              "would harm it");
    EXPECT_EQ(sectionMistake("[output]\nlayers = [\"depth\", \"depth\"]"),
              "scene.toml:4:10: output.layers: the layer 'depth' is named twice");
    EXPECT_EQ(sectionMistake("[output]\nexposure = inf"),
              "scene.toml:4:12: output.exposure is inf; it must be finite");
    EXPECT_EQ(sectionMistake("[output]\nexposure = 101"),
              "scene.toml:4:12: output.exposure is 101; it must lie between -100 and 100");
}

std::string overrideMistake(const std::string& assignment) {
    return mistakeIn("[[volume]]\nfile = \"a.vdb\"\n[render]\nspp = 3\n", {assignment});
}

TEST(ParseErrors, OfOverridesNameTheOverride) {
    EXPECT_EQ(overrideMistake("volume[0].g=1.5"),
              "--set volume[0].g=1.5: volume[0].g is 1.5; it must lie strictly between -1 and 1");
    EXPECT_EQ(overrideMistake("volume[0].scale=[1,-2,3]"),
              "--set volume[0].scale=[1,-2,3]: volume[0].scale[1] is -2; it must not be negative");
    EXPECT_EQ(overrideMistake("volume[3].scale=2"),
              "--set volume[3].scale=2: the scene has 1 volume, volume[0]");
    EXPECT_EQ(mistakeIn("light = []\n[[volume]]\nfile = \"a.vdb\"\n", {"light[0].radiance=2"}),
              "--set light[0].radiance=2: the scene has no light of its own; --write-scene saves "
              "the chosen ones");
    EXPECT_EQ(mistakeIn("[[volume]]\nfile=\"a\"\n[[volume]]\nfile=\"a\"", {"volume[2].g=0"}),
              "--set volume[2].g=0: the scene has 2 volumes, volume[0] to volume[1]");
    EXPECT_EQ(overrideMistake("volume.scale=2"),
              "--set volume.scale=2: volume is a list; say which, as in volume[0].scale");
    EXPECT_EQ(overrideMistake("render[0].spp=2"), "--set render[0].spp=2: render is not a list");
    EXPECT_NE(overrideMistake("render.spp=\xff\x0e").find("invalid utf-8"), std::string::npos);
    EXPECT_EQ(overrideMistake("render.spp.x=2"),
              "--set render.spp.x=2: render.spp is a single value and has no key 'x'");
    EXPECT_EQ(overrideMistake("render.sppp=2").substr(0, 73),
              "--set render.sppp=2: unknown key 'sppp' in [render]; did you mean 'spp'? ");
    EXPECT_EQ(overrideMistake("camra.fov=2").substr(0, 76),
              "--set camra.fov=2: unknown key 'camra' in the scene; did you mean 'camera'? ");
    EXPECT_EQ(overrideMistake("render.spp=many"),
              "--set render.spp=many: render.spp is a string; expected an integer");
}

TEST(ParseErrors, OfMalformedOverridesAreTheUsersWords) {
    for (const char* text : {"", "volume", "=2", "volume[0]scale=2", "volume[x].g=1", "[0].g=1",
                             "volume[0=1", ".g=1", "volume..g=1", "volume[-1].g=1"}) {
        try {
            parseSceneText("[[volume]]\nfile = \"a.vdb\"", "scene.toml", ".", {text});
            ADD_FAILURE() << "accepted: " << text;
        } catch (const Error& e) {
            EXPECT_EQ(e.kind(), ErrorKind::Usage) << text;
            EXPECT_EQ(e.what(), "--set " + std::string(text) +
                                    ": expected KEY=VALUE, such as volume[0].scale=2");
        }
    }
}

TEST(ParseErrors, OfFiles) {
    const TempDir dir;
    const auto mistake = [](const std::filesystem::path& file) -> std::string {
        try {
            parseScene(file);
        } catch (const Error& e) {
            EXPECT_EQ(e.kind(), ErrorKind::Input);
            return e.what();
        }
        return "";
    };
    EXPECT_EQ(mistake(dir / "no.toml"),
              "scene file '" + (dir / "no.toml").string() + "' does not exist");
    EXPECT_EQ(mistake(dir.path()), "scene file '" + dir.path().string() + "' is a directory");
    writeText(dir / "big.toml", std::string((4 << 20) + 1, '#'));
    EXPECT_EQ(mistake(dir / "big.toml"), "scene file '" + (dir / "big.toml").string() +
                                             "' is larger than 4 MB: is it a scene file?");
    writeText(dir / "bad.toml", "[[volume]]\nfile = \"a.vdb\"\n\n  g = 2");
    EXPECT_EQ(mistake(dir / "bad.toml"),
              (dir / "bad.toml").string() +
                  ":4:7: volume[0].g is 2; it must lie strictly between -1 and 1");
}

}  // namespace
}  // namespace woodcock::test
