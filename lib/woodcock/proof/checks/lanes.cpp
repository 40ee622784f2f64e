// SPDX-License-Identifier: Apache-2.0
// Paths that are traced in the lanes of vectors, with all that makes them cheap there, against
// paths that are traced one by one.
#include <fmt/format.h>

#include <cmath>
#include <fstream>

#include "woodcock/base/random.h"
#include "woodcock/proof/checks/measure.h"
#include "woodcock/proof/checks/subjects.h"
#include "woodcock/proof/support/read_back.h"
#include "woodcock/proof/support/small_pictures.h"
#include "woodcock/proof/support/write_vdb.h"

namespace woodcock::proof {

namespace {

/// A ragged ball of radius 1 with holes, of density 1 on average inside.
GridSpec raggedBall() {
    GridSpec grid;
    grid.box = {{0, 0, 0}, {23, 23, 23}};
    grid.value = [](Vec3i v) {
        const double r = length(v.as<double>() - Vec3d{11.5, 11.5, 11.5}) / 11.5;
        const double u = RandomStream(hashOf(29, v.x >> 1, v.y >> 1, v.z)).uniform();
        return r > 1 || u < 0.15 ? 0 : 1.7 * u;
    };
    const double voxel = 1 / 12.0;
    grid.worldFromIndex = Affine3d::translate({-11.5 * voxel, -11.5 * voxel, -11.5 * voxel}) *
                          Affine3d::scale({voxel, voxel, voxel});
    return grid;
}

/// A few hot voxels, in part outside of the ball, and coarser.
GridSpec heat() {
    GridSpec grid;
    grid.name = "heat";
    grid.box = {{0, 0, 0}, {9, 9, 9}};
    grid.value = [](Vec3i v) {
        const double u = RandomStream(hashOf(37, v.x, v.y, v.z)).uniform();
        return u < 0.8 ? 0 : std::pow(8, u) - 5;
    };
    grid.worldFromIndex = Affine3d::translate({-0.6, -0.9, -0.7}) * Affine3d::rotate(1, 20) *
                          Affine3d::scale({0.17, 0.2, 0.15});
    return grid;
}

/// One value in a tile whose cells are wider than what else there is.
GridSpec wideTile() {
    GridSpec grid;
    grid.tiles.push_back({{0, 0, 0}, 128, {1, 0, 0}});
    grid.worldFromIndex =
        Affine3d::translate({-1, -1, -1}) * Affine3d::scale({1 / 64.0, 1 / 64.0, 1 / 64.0});
    return grid;
}

/// A phase function of three colours, forward in red and backward in blue.
void writeColouredPhase(const Lab& lab) {
    std::ofstream file(lab.file("coloured.txt"));
    for (int i = -20; i <= 20; ++i) {
        const double cosine = i / 20.0;
        file << cosine << ' ' << 1 + 0.9 * cosine << ' ' << 1 + 0.5 * cosine * cosine << ' '
             << 1 - 0.8 * cosine << '\n';
    }
}

/// An image of a blue sky with a small sun, which is taken out of it.
void writeSunnySky(const Lab& lab) {
    constexpr int rows = 128, columns = 256;
    std::vector<float> rgb;
    for (int y = 0; y < rows; ++y)
        for (int x = 0; x < columns; ++x) {
            const bool sun = y == 38 && (x == 90 || x == 91);
            for (const float v : {0.2f, 0.3f, 0.5f}) rgb.push_back(v + (sun ? 1500.0f : 0.0f));
        }
    writeFloats(lab.file("sunny.exr"), columns, rows, 3, rgb);
}
const std::string sunnySky = "[[light]]\ntype = \"environment\"\nimage = \"sunny.exr\"\n";

const std::string ball = "[[volume]]\nfile = \"ball.vdb\"\n";
const std::string tile = "[[volume]]\nfile = \"tile.vdb\"\n";
const std::string sun =
    "[[light]]\ntype = \"sun\"\ndirection = [-0.6, -0.7, -0.4]\nirradiance = [3, 2.5, 2]\n"
    "angular_diameter = ";
const std::string deltaSun = sun + "0\n", discSun = sun + "0.53\n";
const std::string secondSun =
    "[[light]]\ntype = \"sun\"\ndirection = [0.5, -0.1, -0.8]\nirradiance = [1, 2, 3]\n";
const std::string air = "[[light]]\ntype = \"environment\"\nradiance = [0.3, 0.5, 0.7]\n";
const std::string pointLamp =
    "[[light]]\ntype = \"point\"\nposition = [0.7, 2.1, 0.5]\nintensity = [9, 6, 4]\n";
const std::string spotLamp =
    "[[light]]\ntype = \"spot\"\nposition = [-1.9, 0.4, 0.6]\nintensity = [5, 7, 9]\n"
    "look_at = [0, 0.1, 0]\ncone = 60\nblend = 0.3\n";
const std::string sphereLamp =
    "[[light]]\ntype = \"sphere\"\nposition = [0.4, 2.9, -1.2]\nradius = 0.6\n"
    "radiance = [9, 7, 5]\n";
/// It faces the medium from behind, and can be seen beside and through it.
const std::string panel =
    "[[light]]\ntype = \"rectangle\"\nposition = [0.5, 0.2, -3]\ndirection = [0, 0, 1]\n"
    "size = [2, 1]\nradiance = [4, 6, 10]\nvisible = true\n";
const std::string hidden = "visible = false\n";
const std::string coloured = "sigma_s = [4, 2, 0.5]\nsigma_a = [0.1, 0.5, 1.5]\ng = 0.5\n";
const std::string turned =
    "transform = { translate = [0.3, 0.1, -0.2], rotate = [20, 40, 60], scale = [1, 0.5, 0.8] "
    "}\n";
const std::string far = "transform = { translate = [100000, 50000, -100000] }\n";
const std::string away =
    "[camera]\neye = [100000, 50000.6, -99996.5]\nlook_at = [100000, 50000, -100000]\n"
    "fov = 40\n";

struct Subject {
    const char* name;
    std::string text;
    double effort = 1;  ///< so many times the seeds of the others
    std::optional<int> maxScatterings{};
    bool camera = true;  ///< the usual one is to be added
    /// Of what the depths to the sun and along camera rays are to be made, where they are to be
    /// wrong.
    std::string gridOf = {};
    /// The same of what is known of the radiance inside.
    std::string radianceOf = {};
};

std::string mediumOf(double sigmaS, double sigmaA, const std::string& phase) {
    return fmt::format("sigma_s = {}\nsigma_a = {}\n{}\n", sigmaS, sigmaA, phase);
}

std::vector<Subject> plainSubjects() {
    const std::string fog = ball + mediumOf(1, 0.3, "g = 0.3"), lights = deltaSun + air;
    const std::string cloud = ball + mediumOf(60, 0, "g = 0.85");
    return {
        {"thin", ball + mediumOf(0.5, 0.1, "") + lights},
        {"thick, forward", cloud + lights, 0.2},
        {"thick, isotropic", ball + mediumOf(40, 0, "") + lights, 0.1},
        {"thick, backward", ball + mediumOf(25, 0, "g = -0.6") + lights, 0.1},
        {"thick, of albedo 0.95", ball + mediumOf(38, 2, "g = 0.5") + lights, 0.5},
        {"thick, of albedo 0.99", ball + mediumOf(39.6, 0.4, "g = 0.5") + lights, 0.3},
        {"of one scattering", cloud + lights, 1, 1},
        {"of two scatterings", cloud + lights, 1, 2},
        {"of five scatterings", cloud + lights, 1, 5},
        {"thick, by a grid of a tenth of the density",
         cloud + lights,
         0.6,
         {},
         true,
         ball + mediumOf(6, 0, "g = 0.85") + lights},
        {"by a grid of thrice the density, elsewhere",
         fog + lights,
         6,
         {},
         true,
         ball + "transform = { translate = [0.4, -0.2, 0.1] }\n" + mediumOf(3, 0.9, "g = 0.3") +
             lights},
        {"thick, by the radiance of another medium",
         ball + mediumOf(38, 2, "g = 0.5") + lights,
         1,
         {},
         true,
         {},
         ball + "transform = { translate = [0.4, -0.2, 0.1] }\n" +
             "sigma_s = [30, 45, 60]\nsigma_a = [0.2, 8, 30]\n" + lights},
        {"by the radiance of another medium",
         fog + lights,
         1,
         {},
         true,
         {},
         ball + "transform = { translate = [0.4, -0.2, 0.1] }\n" + mediumOf(3, 0.1, "g = -0.3") +
             lights},
        {"in colours, by the radiance of another medium",
         ball + "sigma_s = [1, 0.7, 0.4]\nsigma_a = [0.1, 0.3, 0.6]\ng = 0.4\n" + lights,
         1,
         {},
         true,
         {},
         ball + "transform = { translate = [0.4, -0.2, 0.1] }\n" +
             "sigma_s = [0.2, 1.5, 6]\nsigma_a = [1, 0.1, 0.3]\n" + lights},
        {"barely thick, by the radiance of another medium",
         ball + mediumOf(22, 0.8, "g = 0.5") + lights,
         2,
         {},
         true,
         {},
         ball + "transform = { translate = [0.4, -0.2, 0.1] }\n" + mediumOf(60, 0.1, "g = -0.3") +
             lights},
        {"barely thick, in the sun alone", ball + mediumOf(22, 0.8, "g = 0.5") + deltaSun, 2},
        {"thick, in a disc's light", cloud + discSun + air, 0.2},
        {"in a disc's light", fog + discSun + air},
        {"in the light of two suns", fog + deltaSun + secondSun + air},
        {"in the light of an image", fog + twoColouredSky},
        {"in the light of an image with a sun", fog + sunnySky},
        {"thick, in the light of an image with a sun", cloud + sunnySky, 0.5},
        {"in the light of an image and of a sun", fog + deltaSun + twoColouredSky},
        {"in air that is not seen", cloud + deltaSun + air + hidden, 0.5},
        {"in air alone", cloud + air, 0.3},
        {"in the sun alone", cloud + deltaSun, 2},
    };
}

std::vector<Subject> otherSubjects() {
    const std::string lights = deltaSun + air;
    const std::string deep = "sigma_s = [60, 40, 20]\nsigma_a = [0, 0.5, 4]\ng = 0.7\n";
    const auto withPhase = [&](const std::string& kind, double sigma = 5) {
        return ball + mediumOf(sigma, 0.1, "phase = { type = " + kind + " }") + lights;
    };
    return {
        {"chromatic", ball + coloured + lights},
        {"chromatic and thick", ball + deep + lights, 0.3},
        {"chromatic and barely thick",
         ball + "sigma_s = [25, 12, 4]\nsigma_a = [0.5, 2, 6]\ng = 0.5\n" + lights},
        {"chromatic and thick, in the sun alone", ball + deep + deltaSun, 2},
        {"chromatic, in a disc's light", ball + deep + discSun + air + hidden, 0.3},
        {"of two parts", ball + mediumOf(3, 0.1, "g = 0.6") + ball + turned +
                             mediumOf(4, 0.5, "g = -0.3") + lights},
        {"of two thick parts",
         ball + mediumOf(30, 0.1, "g = 0.8") + ball + turned + mediumOf(40, 0, "g = -0.3") + lights,
         0.1},
        {"of parts unlike in colour", ball + coloured + ball + turned + deep + lights, 0.3},
        {"of parts unlike in phase function",
         ball + mediumOf(20, 0, "g = 0.8") + ball + turned +
             mediumOf(20, 0.1, "phase = { type = \"rayleigh\" }") + lights,
         0.2},
        {"of two lobes", withPhase("\"two_lobe\", g = 0.7, g2 = -0.4, mix = 0.3")},
        {"of Rayleigh", withPhase("\"rayleigh\"")},
        {"of droplets under a wide sun",
         ball + mediumOf(10, 0.1, "phase = { type = \"mie\", diameter = 10 }") + sun + "20\n" +
             air},
        {"of a table of colours",
         withPhase("\"table\", file = \"coloured.txt\", normalise = true")},
        {"of the nearest voxels", ball + coloured + lights + "[render]\nlookup = \"nearest\"\n"},
        {"stored as half", ball + "storage = \"half\"\n" + coloured + lights},
        {"stored in 8 bits", ball + "storage = \"fixed8\"\n" + mediumOf(30, 0, "g = 0.7") + lights,
         0.3},
        {"far from the origin",
         ball + far + mediumOf(20, 0.1, "g = 0.6") + lights + away,
         0.5,
         {},
         false},
        {"turned and stretched", ball + turned + mediumOf(20, 0.1, "g = 0.6") + lights, 0.5},
        {"of a wide tile", tile + mediumOf(10, 0.2, "g = 0.6") + lights, 0.5},
        {"of a wide tile and a ball",
         tile + mediumOf(10, 0.2, "g = 0.6") + ball + turned + coloured + discSun + air, 0.3},
    };
}

std::vector<Subject> glowingSubjects() {
    const std::string lights = deltaSun + air;
    const std::string hot = "emission = { grid = \"heat\", scale = [4, 2, 0.5] }\n";
    const std::string bright = "emission = [0.5, 1, 2]\n";
    const std::string fog = ball + mediumOf(1, 0.3, "g = 0.3"),
                      smoke = ball + mediumOf(3, 5, "g = 0.6");
    return {
        {"that glows", fog + bright + lights},
        {"that hot voxels light", fog + hot + lights},
        {"of smoke that hot voxels light", smoke + hot + lights},
        {"that glows, of one scattering", fog + hot + lights, 1, 1},
        {"that glows, of two scatterings", fog + hot + lights, 1, 2},
        {"that glows, by depths of thrice the density, elsewhere",
         fog + hot + lights,
         6,
         {},
         true,
         ball + "transform = { translate = [0.4, -0.2, 0.1] }\n" + mediumOf(3, 0.9, "g = 0.3") +
             hot + lights},
        {"that glows and is thick",
         ball + mediumOf(39, 1, "g = 0.7") + "emission = [5, 4, 3]\n" + lights, 0.4},
        {"that glows in no other light", smoke + hot + air + hidden, 4},
        {"that glows, chromatic", ball + coloured + hot + lights},
        {"that glows, of two parts", smoke + bright + ball + turned + coloured + hot + lights},
        {"that glows, of nearest voxels", fog + hot + lights + "[render]\nlookup = \"nearest\"\n"},
        {"that glows, stored in 8 bits", smoke + "storage = \"fixed8\"\n" + hot + lights},
        {"that glows, of Rayleigh",
         ball + mediumOf(2, 0.1, "phase = { type = \"rayleigh\" }") + hot + lights},
        {"that glows, of a table of colours",
         ball +
             mediumOf(2, 0.1,
                      "phase = { type = \"table\", file = \"coloured.txt\", normalise = true }") +
             hot + lights},
        {"that glows far from the origin",
         ball + far + mediumOf(2, 1, "g = 0.6") + hot + lights + away,
         1,
         {},
         false},
        {"that glows in a wide tile", tile + mediumOf(2, 1, "g = 0.6") + bright + lights},
        {"that is lit by another that only glows",
         fog + ball + "sigma_s = 0\nsigma_a = 0\n" + turned + hot + lights},
    };
}

/// Lamps outside of the medium. In some, one of them takes the place of the sun.
std::vector<Subject> lampSubjects() {
    const std::string thin = ball + mediumOf(1, 0.3, "g = 0.3"),
                      cloud = ball + mediumOf(60, 0, "g = 0.85"),
                      deep = ball + "sigma_s = [60, 40, 20]\nsigma_a = [0, 0.5, 4]\ng = 0.7\n";
    const std::string elsewhere =
        ball + "transform = { translate = [0.4, -0.2, 0.1] }\n" + mediumOf(3, 0.9, "g = 0.3") +
        "[[light]]\ntype = \"point\"\nposition = [-1.5, 1.8, 0]\nintensity = 3\n" + air;
    return {
        {"by a lamp, thin", thin + pointLamp + air},
        {"by a lamp, thick", cloud + pointLamp + air, 0.5},
        {"by a lamp, barely thick", ball + mediumOf(22, 0.8, "g = 0.5") + pointLamp + air},
        {"by a lamp alone, chromatic", deep + pointLamp, 20},
        {"by a lamp, by a grid for another one of thrice the density",
         thin + pointLamp + air,
         6,
         {},
         true,
         elsewhere},
        {"by a spot, chromatic", deep + spotLamp + air, 2},
        {"by a sphere, thin", thin + sphereLamp + air},
        {"by a sphere, thick", cloud + sphereLamp + air, 0.5},
        {"by a panel that is seen, thin", thin + panel + air},
        {"by a panel that is seen, thick", cloud + panel + air, 0.5},
        {"by several lamps", thin + pointLamp + spotLamp + sphereLamp + panel + air},
        {"by several lamps, thick", deep + panel + sphereLamp + pointLamp + air},
        {"by a sun and lamps", cloud + deltaSun + pointLamp + sphereLamp + air, 0.5},
        {"by a lamp and an image", thin + pointLamp + twoColouredSky},
        {"by a lamp, turned, of two parts",
         ball + turned + mediumOf(20, 0.1, "g = 0.6") + ball + coloured + sphereLamp + air, 0.5},
        {"by a lamp, of Rayleigh",
         ball + mediumOf(5, 0.1, "phase = { type = \"rayleigh\" }") + pointLamp + air},
        {"by a lamp, that glows",
         thin + "emission = { grid = \"heat\", scale = [4, 2, 0.5] }\n" + sphereLamp + air},
    };
}

void compare(Lab& lab, const std::vector<Subject>& subjects) {
    writeVdb(lab.file("ball.vdb"), {raggedBall(), heat()});
    writeVdb(lab.file("tile.vdb"), {wideTile()});
    writeTwoColouredSky(lab);
    writeColouredPhase(lab), writeSunnySky(lab);
    for (const Subject& subject : subjects) {
        const auto seen = [&](const std::string& text) {
            return sceneIn(lab, text + (subject.camera ? "[camera]\neye = [0, 0.6, 3.5]\n"
                                                         "look_at = [0, 0, 0]\nfov = 40\n"
                                                       : ""));
        };
        const render::Scene scene = seen(subject.text);
        const render::Scene other = seen(subject.gridOf.empty() ? subject.text : subject.gridOf);
        const render::LightDepths depths(other, {}, render::ApproximateMedia(other, {}));
        SmallPicture picture{
            .samples = 1, .maxScatterings = subject.maxScatterings, .lightDepths = &depths};
        const auto cameraDepths = render::CameraDepths::make(other, picture.side, picture.side);
        picture.cameraDepths = cameraDepths.get();
        const render::Scene elsewhere =
            seen(subject.radianceOf.empty() ? subject.text : subject.radianceOf);
        const auto radiance = render::RadianceLattice::make(elsewhere);
        picture.radiance = radiance.get();
        const std::string name = std::string("picture ") + subject.name;
        Case used{.name = name + ", traced in lanes", .expected = 1};
        used.measured = inLanes(scene, picture);
        lab.add(used);
        const int seeds = static_cast<int>(lab.pick(600, 15000) * subject.effort);
        const SmallPictureMeans lanes = meansOf(scene, picture, lab.seed(name), seeds);
        picture.lanes = false;
        const SmallPictureMeans each = meansOf(scene, picture, lab.seed(name + " each"), seeds);
        const auto add = [&](const std::string& what, const Moments& a, const Moments& b,
                             double noise = 1) {
            Case one = caseOf(name + ", " + what, b.mean(),
                              {a.mean(), std::hypot(a.standardError(), b.standardError())},
                              {noise * lab.pick(5e-2, 1e-2), 0});
            one.note = "one by one";
            one.allowance = 1e-6 * b.mean();
            lab.add(one);
        };
        for (std::size_t c = 0; c < 3; ++c)
            add(fmt::format("channel {}", c), lanes.radiance[c], each.radiance[c]);
        for (std::size_t q = 0; q < 4; ++q)
            add(fmt::format("quarter {}", q), lanes.quarters[q], each.quarters[q], 2);
        add("alpha", lanes.alpha, each.alpha);
    }
}

}  // namespace

std::vector<Check> lanes() {
    return {{Kind::Sampling, "lanes and paths one by one",
             [](Lab& lab) { compare(lab, plainSubjects()); }},
            {Kind::Sampling, "lanes in all kinds of media",
             [](Lab& lab) { compare(lab, otherSubjects()); }},
            {Kind::Sampling, "lanes in media that glow",
             [](Lab& lab) { compare(lab, glowingSubjects()); }},
            {Kind::Sampling, "lanes in the light of lamps",
             [](Lab& lab) { compare(lab, lampSubjects()); }}};
}

}  // namespace woodcock::proof
