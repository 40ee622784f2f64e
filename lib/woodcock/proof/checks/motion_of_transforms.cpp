// SPDX-License-Identifier: Apache-2.0
// What moves by its keys while the shutter is open: cameras, volumes, surfaces and what they hold.
// The expected numbers are integrals over the shutter of what a still picture shows.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "woodcock/proof/checks/cells.h"
#include "woodcock/proof/checks/measure.h"
#include "woodcock/proof/checks/stills.h"
#include "woodcock/proof/checks/subjects.h"
#include "woodcock/proof/support/statistics.h"

namespace woodcock::proof {

namespace {

const std::string light = "[[light]]\ntype = \"environment\"\nradiance = 1\n";
const std::string shutter = "shutter = 1\n";  // from frame -0.5 to 0.5

std::string cubeOfFog(double sigma, const std::string& more) {
    return fmt::format(
        "[[volume]]\nbox = {{ min = [0, -1, -0.5], max = [1, 1, 0.5] }}\nsigma_a = {}\n{}", sigma,
        more);
}

/// It passes x = 0 from -1 to 0: for a quarter of the shutter.
const std::string passesBy =
    "transform = { translate = { keys = [[-0.5, [-3, 0, 0]], [0.5, [1, 0, 0]]] } }\n";

Case coverage(const Lab& lab, const std::string& name, double expected, const std::string& scene) {
    const Precision precision{lab.pick(1e-2, 2e-3), lab.pick(2e-3, 5e-4)};
    const render::Scene built = sceneIn(lab, scene);
    const image::Film film = evenFilm(
        lab, name, built, {.maxScatterings = 0},
        [&](const image::Film& pilot) { return evenAlpha(pilot).error / precision.of(expected); });
    Case c = caseOf(name, expected, evenAlpha(film), precision);
    c.allowance = 2e-4;  // of the way that is made of straight pieces
    return c;
}

Case brightness(const Lab& lab, const std::string& name, double expected,
                const std::string& scene) {
    const Precision precision{lab.pick(1e-2, 2e-3), lab.pick(2e-3, 5e-4)};
    return caseOf(name, expected, evenPicture(lab, name, sceneIn(lab, scene), precision, {0})[0],
                  precision);
}

const std::string alongZ = pencilCamera({0, 0, 5}, {0, 0, -1}) + shutter;

/// Transmittance, alpha and emission of a box that passes a line.
void addPassing(Lab& lab) {
    const double opacity = -std::expm1(-2.0);
    lab.add(coverage(lab, "alpha of a cube of fog that passes", opacity / 4,
                     cubeOfFog(2, passesBy) + light + alongZ));
    lab.add(coverage(lab, "alpha of a cube of fog that a camera passes", opacity / 4,
                     cubeOfFog(2, "") + light +
                         "[camera]\ntype = \"orthographic\"\nheight = 1e-12\n"
                         "eye = { keys = [[-0.5, [3, 0, 5]], [0.5, [-1, 0, 5]]] }\n"
                         "look_at = { keys = [[-0.5, [3, 0, 0]], [0.5, [-1, 0, 0]]] }\n" +
                         shutter));
    lab.add(brightness(lab, "light of a glowing cube that passes", 3.0 / 4,
                       "[[volume]]\nbox = { min = [0, -1, -0.5], max = [1, 1, 0.5] }\n"
                       "emission = 3\nsigma_a = 0\n" +
                           passesBy + alongZ));
    const std::string box =
        "[[surface]]\nbox = { min = [0, -1, -0.5], max = [1, 1, 0.5] }\n" + passesBy;
    lab.add(coverage(lab, "alpha of an opaque box that passes", 0.25, box + light + alongZ));
    const std::string filled = box +
                               "material = \"air\"\nmedium = { sigma_a = 2 }\n"
                               "[[material]]\nname = \"air\"\ntype = \"interface\"\n";
    lab.add(
        coverage(lab, "alpha of fog in a box that passes", opacity / 4, filled + light + alongZ));
    lab.add(coverage(lab, "alpha of fog that passes over the camera", -std::expm1(-1.0) / 4,
                     filled + light + pencilCamera({0, 0, 0}, {0, 0, -1}) + shutter));
    // Jumps, half way through the shutter.
    lab.add(coverage(lab, "alpha of an opaque box that jumps", 0.5,
                     "[[surface]]\nbox = { min = [-1, -1, -0.5], max = [1, 1, 0.5] }\ntransform = "
                     "{ translate = { keys = [[-9, [0, 0, 0]], [0, [5, 0, 0]]], interpolation = "
                     "\"constant\" } }\n" +
                         light + alongZ));
    // Slowly, fast, slowly: 3 s^2 - 2 s^3 of the way at s of the shutter, as both ends are level.
    const auto way = [](double s) { return -3 + 4 * s * s * (3 - 2 * s); };
    const auto when = [&](double x) {
        double a = 0, b = 1;
        for (int i = 0; i < 60; ++i) (way((a + b) / 2) < x ? a : b) = (a + b) / 2;
        return a;
    };
    lab.add(coverage(lab, "alpha of an opaque box that sets off and stops gently",
                     when(0) - when(-1),
                     "[[surface]]\nbox = { min = [0, -1, -0.5], max = [1, 1, 0.5] }\ntransform = "
                     "{ translate = { keys = [[-1, [-3, 0, 0]], [-0.5, [-3, 0, 0]], [0.5, [1, 0, "
                     "0]], [1, [1, 0, 0]]], interpolation = \"smooth\" } }\n" +
                         light + alongZ));
}

/// What turns: between keys the angle goes evenly.
void addTurning(Lab& lab) {
    const double degrees = pi / 180;
    // A slab of thickness 1, seen through at an angle.
    const auto seen = [&](double angle) { return -std::expm1(-1 / std::cos(angle)); };
    const double mean = integrate(0, 1, 32, [&](double s) { return seen(60 * degrees * s); });
    const std::string slab =
        "[[volume]]\nbox = { min = [-99, -99, -0.5], max = [99, 99, 0.5] }\nsigma_a = 1\n";
    lab.add(coverage(lab, "alpha of a slab of fog that turns", mean,
                     slab +
                         "transform = { rotate = { keys = [[-0.5, [0, 0, 0]], [0.5, [0, 60, 0]]] } "
                         "}\n" +
                         light + alongZ));
    lab.add(coverage(lab, "alpha of a slab of fog that a matrix turns", mean,
                     slab +
                         fmt::format("matrix = {{ keys = [[-0.5, [[1, 0, 0, 0], [0, 1, 0, 0], "
                                     "[0, 0, 1, 0], [0, 0, 0, 1]]], [0.5, [[0.5, 0, {0}, 0], "
                                     "[0, 1, 0, 0], [-{0}, 0, 0.5, 0], [0, 0, 0, 1]]]] }}\n",
                                     std::sqrt(0.75)) +
                         light + alongZ));
    // The camera's aim goes evenly along a line: the tangent of the angle does.
    const double aside = std::sqrt(3.0);
    lab.add(coverage(
        lab, "alpha of a slab of fog before a camera that turns",
        integrate(0, 1, 32, [&](double s) { return -std::expm1(-std::hypot(1, aside * s)); }),
        slab + light +
            fmt::format("[camera]\nfov = 1e-9\neye = [0, 0, 5]\nlook_at = {{ keys = "
                        "[[-0.5, [0, 0, 4]], [0.5, [{}, 0, 4]]] }}\n",
                        aside) +
            shutter));
    // A square about its middle: a point 1.2 aside is in it while both its coordinates are.
    const double from = std::acos(1 / 1.2), to = std::asin(1 / 1.2);
    const std::string square = "box = { min = [-1, -1, -0.5], max = [1, 1, 0.5] }\n";
    lab.add(coverage(
        lab, "alpha of an opaque square that turns", (to - from) / (pi / 2),
        "[[surface]]\n" + square +
            "transform = { rotate = { keys = [[-0.5, [0, 0, 0]], [0.5, [0, 0, 90]]] } }\n" + light +
            pencilCamera({1.2, 0, 5}, {0, 0, -1}) + shutter));
    // A small ball far from the axis that it turns about: for 2 asin(r / d) of a right angle.
    const double r = 0.3, d = 7;
    lab.add(coverage(
        lab, "alpha of an opaque ball on its orbit", 4 * std::asin(r / 2 / d) / (pi / 2),
        fmt::format("[[surface]]\nsphere = {{ centre = [{}, 0, 0], radius = {} }}\n", d, r) +
            "transform = { rotate = { keys = [[-0.5, [0, 0, 0]], [0.5, [0, 0, 90]]] } }\n" + light +
            pencilCamera({d / std::sqrt(2.0), d / std::sqrt(2.0), 5}, {0, 0, -1}) + shutter));
}

/// Pictures of which each pixel shows something else.
void addPictures(Lab& lab) {
    const Precision precision{lab.pick(1e-2, 2e-3), lab.pick(2e-3, 5e-4)};
    const auto alphaOf = [](const image::Film& film) { return evenAlpha(film).mean; };
    // A square of side 1 in a picture whose height goes from 2 to 4.
    const std::string zoom = "zooming in on an opaque square";
    lab.add(
        caseOf(zoom, 1.0 / 8,
               meanOverSeeds(sceneIn(lab,
                                     "[[surface]]\nbox = { min = [-0.5, -0.5, -0.5], max = "
                                     "[0.5, 0.5, 0.5] }\n" +
                                         light +
                                         "[camera]\ntype = \"orthographic\"\nheight = { keys = "
                                         "[[-0.5, 4], [0.5, 2]] }\neye = [0, 0, 5]\nlook_at = "
                                         "[0, 0, 0]\n" +
                                         shutter),
                             {.samples = lab.pick(64, 1024), .seed = lab.seed(zoom)}, 16, alphaOf),
               precision));

    // A camera and a lamp that move about scattering fog and a mirror, against still pictures at
    // even times.
    const std::string name = "a picture by a camera and a lamp that move";
    const std::string text =
        "[[volume]]\nbox = { min = [-1, -1, -1], max = [1, 1, 0] }\nsigma_a = 0.5\nsigma_s = 1\n"
        "[[surface]]\nsphere = { centre = [0.5, 0.2, 0.6], radius = 0.5 }\nmaterial = \"m\"\n"
        "[[material]]\nname = \"m\"\ntype = \"conductor\"\n" +
        light +
        "[[light]]\ntype = \"sun\"\ndirection = [1, -2, -1]\nirradiance = 2\n"
        "[[light]]\ntype = \"sphere\"\nradius = 0.2\nradiance = 5\nposition = { keys = [[-0.5, "
        "[-1.5, 1, 0]], [0.5, [1.5, 1.5, 0.5]]] }\n"
        "[camera]\nfov = { keys = [[-1, 40], [1, 60]] }\nlook_at = [0, 0, 0]\n"
        "eye = { keys = [[-1, [-3, 0, 3]], [0, [0, 1, 5]], [1, [2, 1, 2]]], interpolation = "
        "\"smooth\" }\n" +
        shutter;
    lab.add(asStillPictures(lab, name, text, precision));
}

/// Twice the same, where nothing random may differ.
void addUnblurred(Lab& lab) {
    const auto scene = [&](const std::string& transform, const std::string& camera) {
        return sceneIn(lab, cubeOfFog(1, transform) + light + "[camera]\n" + camera);
    };
    const Picture picture{.width = 16, .height = 16, .samples = 8, .seed = lab.seed("unblurred")};
    const auto worst = [&](const render::Scene& a, const render::Scene& b) {
        const image::Film one = renderScene(a, picture).film, other = renderScene(b, picture).film;
        double most = 0;
        for (int y = 0; y < picture.height; ++y)
            for (int x = 0; x < picture.width; ++x)
                most =
                    std::max(most, std::abs(one.at(x, y).radiance[0] - other.at(x, y).radiance[0]) /
                                       picture.samples);
        return most;
    };
    const std::string eye = "eye = [2, 1, 4]\nlook_at = [0.5, 0, 0]\n";
    const render::Scene still = scene("", eye);
    lab.add(exactCase("keys that stay the same: difference to a still scene", 0,
                      worst(still, scene("transform = { rotate = { keys = [[-1, [0, 0, 0]], [1, "
                                         "[0, 0, 0]]] } }\n",
                                         "eye = { keys = [[-1, [2, 1, 4]], [1, [2, 1, 4]]] }\n"
                                         "look_at = [0.5, 0, 0]\n" +
                                             shutter)),
                      0));
    // Both move along, in steps that doubles hold.
    lab.add(exactCase(
        "a volume and a camera that move together: difference to a still scene", 0,
        worst(still, scene("transform = { translate = { keys = [[-0.5, [-8, 0, 2]], [0.5, [8, 0, "
                           "-2]]] } }\n",
                           "eye = { keys = [[-0.5, [-6, 1, 6]], [0.5, [10, 1, 2]]] }\nlook_at = { "
                           "keys = [[-0.5, [-7.5, 0, 2]], [0.5, [8.5, 0, -2]]] }\n" +
                               shutter)),
        1e-5));
}

}  // namespace

std::vector<Check> motionOfTransforms() {
    return {{Kind::ClosedForm, "motion of transforms: what passes", addPassing},
            {Kind::ClosedForm, "motion of transforms: what turns", addTurning},
            {Kind::ClosedForm, "motion of transforms: pictures", addPictures},
            {Kind::Property, "motion of transforms: what looks still", addUnblurred}};
}

}  // namespace woodcock::proof
