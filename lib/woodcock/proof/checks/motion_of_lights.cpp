// SPDX-License-Identifier: Apache-2.0
// Lights that move and change while the shutter is open, and surfaces that emit. The expected
// numbers are integrals over the shutter of closed forms.
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <functional>

#include "woodcock/base/affine.h"
#include "woodcock/proof/checks/measure.h"
#include "woodcock/proof/checks/stills.h"
#include "woodcock/proof/checks/subjects.h"
#include "woodcock/proof/oracles/surfaces.h"
#include "woodcock/proof/support/statistics.h"

namespace woodcock::proof {

namespace {

const std::string openShutter = "shutter = 1\n";  // from frame -0.5 to 0.5
const std::string lamp =
    "[[material]]\nname = \"lamp\"\ntype = \"emissive\"\nradiance = 3\n"
    "[[surface]]\nmaterial = \"lamp\"\n";
const std::string greyGround =
    "[[material]]\nname = \"grey\"\ntype = \"diffuse\"\ncolour = 0.5\n"
    "[[surface]]\nmaterial = \"grey\"\nplane = {}\n";
const Vec3d litSpot{0.3, 0, 0.2}, upwards{0, 1, 0};  // of the ground, and its normal

/// Grey ground at `litSpot` that a light of radiance 3 shines on, of which `irradiance` knows what
/// it makes there with a radiance of 1, at a time within the shutter.
void addGround(Lab& lab, const std::string& name, const std::string& light,
               const std::function<double(double)>& irradiance, double allowance = 2e-4) {
    const Precision precision{lab.pick(1e-2, 2e-3), lab.pick(2e-3, 5e-4)};
    const double expected = 3 * 0.5 / pi * integrate(0, 1, 48, irradiance);
    const render::Scene scene =
        sceneIn(lab, light + greyGround + pencilCamera(litSpot + Vec3d{0, 0.5, 4}, {0, -0.5, -4}) +
                         openShutter);
    Case c = caseOf(name, expected, evenPicture(lab, name, scene, precision, {0})[0], precision);
    c.allowance += allowance * expected;
    lab.add(c);
}

double fromSphere(Vec3d centre, double radius) {
    const Vec3d d = centre - litSpot;
    return oracle::sphereIrradiance(radius, length(d), dot(d, upwards) / length(d));
}

/// Of the box from -half to half, in its own space, which shines outwards.
double fromBox(const Affine3d& worldFromBox, Vec3d half) {
    double sum = 0;
    for (int axis = 0; axis < 3; ++axis)
        for (const double side : {-1.0, 1.0}) {
            const int a = (axis + 1) % 3, b = (axis + 2) % 3;
            std::vector<Vec3d> corners;
            for (const auto& [s, t] : {std::array{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}) {
                Vec3d p;
                p[axis] = side * half[axis], p[a] = s * half[a], p[b] = t * half[b];
                corners.push_back(worldFromBox.point(p));
            }
            const Vec3d outwards = cross(corners[1] - corners[0], corners[3] - corners[0]) * side;
            if (dot(outwards, litSpot - corners[0]) > 0)
                sum += oracle::polygonIrradiance(corners, litSpot, upwards);
        }
    return sum;
}

/// Emissive surfaces.
void addSurfaces(Lab& lab) {
    addGround(
        lab, "ground under a ball of light that flies by",
        lamp +
            "sphere = { radius = 0.5 }\ntransform = { translate = { keys = "
            "[[-0.5, [-3, 1, 0]], [0.5, [2, 3, 1]]] } }\n",
        [](double s) {
            return fromSphere({-3 + 5 * s, 1 + 2 * s, s}, 0.5);
        },
        5e-4);
    const std::string box = lamp + "box = { min = [-1, -0.2, -0.5], max = [1, 0.2, 0.5] }\n";
    const Vec3d half{1, 0.2, 0.5};
    addGround(
        lab, "ground under a box of light that turns",
        box +
            "transform = { translate = [0, 2, 0], rotate = { keys = [[-0.5, [0, 0, 0]], "
            "[0.5, [0, 0, 120]]] } }\n",
        [&](double s) {
            return fromBox(Affine3d::translate({0, 2, 0}) * Affine3d::rotate(2, 120 * s), half);
        });
    addGround(
        lab, "ground under a box of light that grows",
        box +
            "transform = { translate = [0, 3, 0], scale = { keys = [[-0.5, [0.3, 1, 1]], "
            "[0.5, [1.5, 4, 2]]] } }\n",
        [&](double s) {
            return fromBox(
                Affine3d::translate({0, 3, 0}) *
                    Affine3d{{Vec3d{0.3 + 1.2 * s, 0, 0}, {0, 1 + 3 * s, 0}, {0, 0, 1 + s}}, {}},
                half);
        });
    addGround(lab, "ground under a box of light that jumps",
              box +
                  "transform = { translate = { keys = [[-9, [0, 1, 0]], [0.25, [4, 3, 0]]], "
                  "interpolation = \"constant\" } }\n",
              [&](double) {
                  return 0.75 * fromBox(Affine3d::translate({0, 1, 0}), half) +
                         0.25 * fromBox(Affine3d::translate({4, 3, 0}), half);
              });
}

/// Lights that change their size, form or brightness.
void addForms(Lab& lab) {
    const std::string ball = "[[light]]\ntype = \"sphere\"\nposition = [-1, 3, 0]\n";
    const std::string grows = "radius = { keys = [[-0.5, 0.2], [0.5, 2]] }\n";
    addGround(lab, "ground under a sphere light that grows", ball + "radiance = 3\n" + grows,
              [](double s) {
                  return fromSphere({-1, 3, 0}, 0.2 + 1.8 * s);
              });
    addGround(lab, "ground under a sphere light that grows and keeps its power",
              ball + fmt::format("power = {:.9g}\n", 4 * pi * pi * 3) + grows, [](double s) {
                  const double radius = 0.2 + 1.8 * s;
                  return fromSphere({-1, 3, 0}, radius) / (radius * radius);
              });
    addGround(lab, "ground under a sphere light that goes out",
              ball + "radius = 1\nradiance = { keys = [[-0.5, 3], [0, 0]] }\n", [](double) {
                  return fromSphere({-1, 3, 0}, 1) / 4;
              });
    addGround(lab, "ground under a rectangle light that moves and widens",
              "[[light]]\ntype = \"rectangle\"\nradiance = 3\nlook_at = { keys = [[-0.5, "
              "[-2, 0, 0]], [0.5, [1, 0, 0]]] }\nposition = { keys = [[-0.5, [-2, 3, 0]], "
              "[0.5, [1, 3, 0]]] }\nsize = { keys = [[-0.5, [0.5, 0.5]], [0.5, [3, 0.5]]] }\n",
              [](double s) {
                  const Vec3d c{-2 + 3 * s, 3, 0};
                  const double x = 0.25 + 1.25 * s, z = 0.25;
                  return oracle::polygonIrradiance({c + Vec3d{-x, 0, -z}, c + Vec3d{x, 0, -z},
                                                    c + Vec3d{x, 0, z}, c + Vec3d{-x, 0, z}},
                                                   litSpot, upwards);
              });
    // Straight down on the way to `litSpot` stands a cone's edge at 20 of 10 to 50 degrees.
    addGround(
        lab, "ground at the edge of a spot light that opens",
        fmt::format("[[light]]\ntype = \"spot\"\nintensity = 3\nposition = [{0}, 2, 0.2]\n"
                    "look_at = [{0}, 0, 0.2]\nblend = 0\n"
                    "cone = {{ keys = [[-0.5, 20], [0.5, 100]] }}\n",
                    litSpot.x + 2 * std::tan(20 * pi / 180)),
        [](double) { return 0.75 * std::pow(std::cos(20 * pi / 180), 3) / 4; }, 5e-4);
}

/// In fog, where paths meet such lights in every way.
void addFog(Lab& lab) {
    lab.add(asStillPictures(
        lab, "a picture of fog among lights that move and change",
        "[[volume]]\nbox = { min = [-1, -1, -1], max = [1, 1, 1] }\nsigma_a = 0.2\n"
        "sigma_s = 1\ng = 0.3\n" +
            lamp +
            "box = { min = [-0.3, -0.1, -0.2], max = [0.3, 0.1, 0.2] }\ntransform = { translate = "
            "{ keys = [[-0.5, [-1.8, -0.5, 1.2]], [0.5, [1.2, 0.4, 1.4]]] }, rotate = { keys = "
            "[[-0.5, [0, 0, 0]], [0.5, [30, 90, 150]]] }, scale = { keys = [[-0.5, 1], [0.5, 1.5]] "
            "} }\n"
            "[[light]]\ntype = \"sphere\"\nposition = [1, 0.6, 0.5]\npower = 30\nradius = { "
            "keys = [[-0.5, 0.1], [0.5, 0.5]] }\n"
            "[[light]]\ntype = \"disk\"\nradiance = 4\nlook_at = [0, 0, 0]\nposition = [0, "
            "1.5, 0.5]\nspread = { keys = [[-0.5, 180], [0.5, 60]] }\nradius = 0.4\n"
            "[camera]\nfov = 45\neye = [0.5, 0.5, 4]\nlook_at = [0, 0, 0]\n" +
            openShutter,
        {lab.pick(1.5e-2, 5e-3), lab.pick(2e-3, 5e-4)}));
}

}  // namespace

std::vector<Check> motionOfLights() {
    return {{Kind::ClosedForm, "motion of lights: surfaces that emit", addSurfaces},
            {Kind::ClosedForm, "motion of lights: size and brightness", addForms},
            {Kind::ClosedForm, "motion of lights: in fog", addFog}};
}

}  // namespace woodcock::proof
