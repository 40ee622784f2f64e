// SPDX-License-Identifier: Apache-2.0
// Glass, total reflection, emitters and walls, and media inside of surfaces.
#include "woodcock/proof/oracles/surfaces.h"

#include <fmt/format.h>

#include <cmath>

#include "woodcock/proof/checks/measure.h"
#include "woodcock/proof/checks/subjects.h"
#include "woodcock/proof/oracles/adding_doubling.h"
#include "woodcock/proof/oracles/plates.h"

namespace woodcock::proof {

namespace {

const std::string evenLight = "[[light]]\ntype = \"environment\"\nradiance = 1\n";

std::string dielectric(const std::string& name, double ior) {
    return fmt::format("[[material]]\nname = \"{}\"\ntype = \"dielectric\"\nior = {}\n", name, ior);
}
const std::string interface = "[[material]]\nname = \"interface\"\ntype = \"interface\"\n";

/// A layer across y, as wide as infinite.
std::string layer(const std::string& material, double bottom, double top,
                  const std::string& more = "") {
    return fmt::format(
        "[[surface]]\nmaterial = \"{}\"\n"
        "box = {{ min = [-1e6, {}, -1e6], max = [1e6, {}, 1e6] }}\n{}\n",
        material, bottom, top, more);
}
std::string medium(double sigmaA, double sigmaS, double g) {
    return fmt::format("medium = {{ sigma_a = {}, sigma_s = {}, g = {} }}", sigmaA, sigmaS, g);
}

/// How the two-coloured sky shows a layer across y: reflected light is red, transmitted light is
/// blue.
void addFaces(Lab& lab, const std::string& name, const std::string& scene, double reflectance,
              double transmittance, const Precision& precision, const std::string& source) {
    const RgbEstimate e = evenPicture(lab, name, sceneIn(lab, scene), precision, {0, 2});
    for (const bool through : {false, true}) {
        const double expected = through ? transmittance : reflectance;
        if (expected < 4 * precision.floor) continue;
        Case c = caseOf(fmt::format("{}, {}", through ? "transmittance" : "reflectance", name),
                        expected, e[through ? 2 : 0], precision);
        c.allowance += 3e-6 + horizonAllowance;
        c.note = source;
        lab.add(std::move(c));
    }
}

/// A plate of absorbing glass, at several sizes and positions in the world.
void plates(Lab& lab) {
    writeTwoColouredSky(lab);
    const Precision precision = dearPrecision(lab);
    for (const double index : {1.33, 1.5, 2.4})
        for (const double depth : {0.0, 0.3, 2.0})
            for (const double mu : {1.0, 0.5, 0.1}) {
                const auto answer = oracle::unpolarisedPlates({{index, depth}}, mu);
                addFaces(lab, fmt::format("plate of index {}, depth {}, mu {}", index, depth, mu),
                         dielectric("glass", index) + layer("glass", -1, 0, medium(depth, 0, 0)) +
                             twoColouredSky + cameraAbove(mu),
                         answer.reflectance, answer.transmittance, precision,
                         "Fresnel, Beer and all reflections between the faces");
            }
    for (const double scale : {1e-4, 1e5}) {
        const auto answer = oracle::unpolarisedPlates({{1.5, 0.3}}, 0.5);
        const std::string scene =
            dielectric("glass", 1.5) +
            fmt::format(
                "[[surface]]\nmaterial = \"glass\"\n"
                "box = {{ min = [{0}, {1}, {0}], max = [{2}, 0, {2}] }}\n{3}\n",
                -1e4 * scale, -scale, 1e4 * scale, medium(0.3 / scale, 0, 0)) +
            twoColouredSky + pencilCamera(Vec3d{0, 50, 0} * scale, {std::sqrt(0.75), -0.5, 0});
        addFaces(lab, fmt::format("plate {} thick", scale), scene, answer.reflectance,
                 answer.transmittance, precision, "as of any size");
    }
}

/// Water that reaches into glass: priorities make it one boundary, and the pile acts like plates
/// that touch.
void nested(Lab& lab) {
    writeTwoColouredSky(lab);
    const Precision precision = dearPrecision(lab);
    for (const double mu : {1.0, 0.3}) {
        const auto answer = oracle::unpolarisedPlates({{1.5, 0.4}, {1.33, 0.7}, {1.31, 0.1}}, mu);
        addFaces(lab, fmt::format("glass over water over ice, overlapping, mu {}", mu),
                 dielectric("glass", 1.5) + dielectric("water", 1.33) + dielectric("ice", 1.31) +
                     layer("water", -2, -0.4, medium(0.7, 0, 0)) +
                     layer("glass", -1, 0, "priority = 2\n" + medium(0.4, 0, 0)) +
                     layer("ice", -3, -2 + 0.5, "priority = -1\n" + medium(0.1, 0, 0)) +
                     twoColouredSky + cameraAbove(mu),
                 answer.reflectance, answer.transmittance, precision, "a pile of touching plates");
    }
    // The camera in the middle of an absorbing ball sees the sky along the normal: what enters it
    // goes to and fro through the centre.
    const double index = 1.5, depth = 0.7, inside = std::exp(-depth);
    const double face = oracle::fresnelReflectance(1, index);
    const double expected = index * index * (1 - face) * inside / (1 - face * inside * inside);
    const std::string ball =
        dielectric("glass", index) +
        "[[surface]]\nmaterial = \"glass\"\nsphere = { centre = [0, 0, 0], radius = 1 }\n" +
        medium(depth, 0, 0) + "\n";
    lab.add(caseOf(
        "from the centre of an absorbing ball of glass", expected,
        evenPicture(lab, "centre of a ball",
                    sceneIn(lab, ball + evenLight + pencilCamera({0, 0, 0}, {0.3, 0.5, 0.2})),
                    precision, {0})[0],
        precision));
}

/// From within a half-space of glass: beyond the critical angle nothing of the sky above arrives,
/// and all of what is below, exactly.
void totalReflection(Lab& lab) {
    writeTwoColouredSky(lab);
    const Precision precision = dearPrecision(lab);
    const double index = 1.5;
    const std::string glass =
        dielectric("glass", index) + "[[surface]]\nmaterial = \"glass\"\nplane = {}\n";
    for (const double mu : {0.9, 0.75, 0.74, 0.1, 1e-3}) {
        const double sine = index * std::sqrt((1 - mu) * (1 + mu));
        const double outside = sine < 1 ? std::sqrt((1 - sine) * (1 + sine)) : 0;
        const double reflected = sine < 1 ? oracle::fresnelReflectance(outside, index) : 1;
        const std::string name = fmt::format("from within glass, mu {}", mu);
        const RgbEstimate e = evenPicture(
            lab, name,
            sceneIn(lab, glass + twoColouredSky +
                             pencilCamera({0, -5, 0}, {std::sqrt((1 - mu) * (1 + mu)), mu, 0})),
            precision, {0, 2});
        Case above =
            caseOf(name + ", the sky above", index * index * (1 - reflected), e[0], precision);
        Case below = caseOf(name + ", reflected", reflected, e[2], precision);
        above.allowance += horizonAllowance, below.allowance += horizonAllowance;
        above.note = sine < 1 ? "index^2 (1 - R)" : "total reflection is exact";
        lab.add(above), lab.add(below);
    }
}

/// Scattering media behind glass and behind mere interfaces.
void mediaInside(Lab& lab) {
    writeTwoColouredSky(lab);
    const Precision precision = dearPrecision(lab);
    for (const double mu : {1.0, 0.4}) {
        const std::string name = fmt::format("half-space behind glass of 1.5, mu {}", mu);
        const std::string scene = dielectric("glass", 1.5) +
                                  "[[surface]]\nmaterial = \"glass\"\nplane = {}\n" +
                                  medium(0.1, 0.9, 0) + "\n" + twoColouredSky + cameraAbove(mu);
        Case c =
            caseOf("reflectance, " + name, oracle::refractiveHalfSpaceReflectance(1.5, 0.9, 0, mu),
                   evenPicture(lab, name, sceneIn(lab, scene), precision, {0})[0], precision);
        c.allowance += 1e-6 + horizonAllowance;
        c.note = mu == 1 ? "Giovanelli 1955" : "adding-doubling";
        lab.add(c);
    }
    struct Row {
        double index, depth, albedo, g, mu;
    };
    for (const Row& r : {Row{1.33, 1, 0.9, 0.5, 1},
                         {1.5, 2, 0.99, 0.75, 0.5},
                         {1, 1, 0.9, 0.75, 1},
                         {1, 4, 0.99, 0, 0.5},
                         {1, 0.1, 0.5, -0.5, 0.2}}) {
        const auto face =
            oracle::solveSlab({.layers = {{r.depth, r.albedo, r.g}}, .refractiveIndex = r.index},
                              {r.mu})
                .above;
        const std::string material = r.index == 1 ? interface : dielectric("glass", r.index);
        addFaces(lab,
                 fmt::format("slab in {}, depth {}, albedo {}, g {}, mu {}",
                             r.index == 1 ? "an interface" : fmt::format("glass of {}", r.index),
                             r.depth, r.albedo, r.g, r.mu),
                 material +
                     layer(r.index == 1 ? "interface" : "glass", -1, 0,
                           medium(r.depth * (1 - r.albedo), r.depth * r.albedo, r.g)) +
                     twoColouredSky + cameraAbove(r.mu),
                 face.reflectance[0], face.transmittance[0], precision, "adding-doubling");
    }
    // The same coloured fog in an interface and without one, under a sun and beside a sphere light.
    const std::string lights =
        "[[light]]\ntype = \"sun\"\ndirection = [1, -2, 0.5]\nirradiance = 3\n"
        "[[light]]\ntype = \"sphere\"\nposition = [0.2, 0.1, 0]\nradius = 0.1\nradiance = 30\n";
    const std::string fog = "sigma_a = [0.3, 0.1, 0], sigma_s = [0.5, 1, 2], g = 0.4";
    const std::string eye = pencilCamera({3, 1, 2}, {-3, -1.2, -2.1});
    const RgbEstimate inside =
        evenPicture(lab, "fog in an interface",
                    sceneIn(lab, interface +
                                     "[[surface]]\nmaterial = \"interface\"\n"
                                     "box = { min = [-1, -1, -1], max = [1, 1, 1] }\nmedium = { " +
                                     fog + " }\n" + lights + eye),
                    precision);
    const RgbEstimate alone =
        evenPicture(lab, "fog alone",
                    sceneIn(lab,
                            "[[volume]]\nbox = { min = [-1, -1, -1], max = [1, 1, 1] }\n"
                            "sigma_a = [0.3, 0.1, 0]\nsigma_s = [0.5, 1, 2]\ng = 0.4\n" +
                                lights + eye),
                    precision);
    for (std::size_t i = 0; i < 3; ++i) {
        const double ratio = inside[i].mean / alone[i].mean;
        const double error =
            ratio * std::hypot(inside[i].error / inside[i].mean, alone[i].error / alone[i].mean);
        lab.add(caseOf(fmt::format("fog in an interface over fog alone, channel {}", i), 1,
                       {ratio, error}, {1.6 * precision.relative, 0}));
    }
}

/// An object that absorbs nothing is invisible in a uniform environment.
void furnaces(Lab& lab) {
    const Precision precision = dearPrecision(lab);
    const auto furnace = [&](const std::string& name, const std::string& scene,
                             const std::string& camera) {
        const RgbEstimate e =
            evenPicture(lab, name, sceneIn(lab, scene + evenLight + camera), precision);
        for (std::size_t i = 0; i < (scene.find("[0.2, 1, 3]") == std::string::npos ? 1 : 3); ++i)
            lab.add(caseOf(fmt::format("{}{}", name, i ? fmt::format(", channel {}", i) : ""), 1,
                           e[i], precision));
    };
    const std::string around = "[camera]\neye = [0, 1, 4]\nlook_at = [0, 0, 0]\nfov = 30\n";
    const std::string ball =
        "[[surface]]\nmaterial = \"glass\"\nsphere = { centre = [0, 0, 0], radius = 1 }\n";
    furnace("a clear ball of glass", dielectric("glass", 1.5) + ball, around);
    furnace("a ball of glass full of milk",
            dielectric("glass", 1.5) + ball + medium(0, 5, 0.5) + "\n", around);
    furnace("a ball of glass full of coloured milk",
            dielectric("glass", 1.33) + ball +
                "medium = { sigma_a = 0, sigma_s = [0.2, 1, 3], g = -0.3 }\n",
            around);
    furnace(
        "a box of glass that holds a bubble",
        dielectric("glass", 1.7) + interface +
            "[[surface]]\nmaterial = \"glass\"\nbox = { min = [-1, -1, -1], max = [1, 1, 1] }\n" +
            medium(0, 1, 0) + "\n" + dielectric("air", 1) +
            "[[surface]]\nmaterial = \"air\"\npriority = 1\n"
            "sphere = { centre = [0.2, 0, 0], radius = 0.6 }\n",
        around);
    furnace("white walls around white fog",
            "[[material]]\nname = \"white\"\ntype = \"diffuse\"\ncolour = 1\n"
            "[[surface]]\nmaterial = \"white\"\nplane = { size = [1, 1] }\n"
            "[[surface]]\nmaterial = \"white\"\nbox = { min = [-2, -1, -1], max = [-1, 2, 0] }\n"
            "[[volume]]\nbox = { min = [-1.5, -0.5, -0.5], max = [1, 1, 0.5] }\n"
            "sigma_s = 2\nsigma_a = 0\ng = 0.7\n",
            around);
    furnace("a mirror and a white metal",
            "[[material]]\nname = \"mirror\"\ntype = \"conductor\"\ncolour = 1\n"
            "[[surface]]\nmaterial = \"mirror\"\nsphere = { centre = [0, 0, 0], radius = 1 }\n"
            "[[surface]]\nmaterial = \"mirror\"\nplane = {}\n"
            "transform = { translate = [0, -1, 0] }\n",
            around);
    for (const double mu : {1e-2, 1e-4, 1e-6})
        furnace(fmt::format("a clear plate at mu {}", mu),
                dielectric("glass", 1.5) + layer("glass", -1, 0),
                pencilCamera({0, 1e-3, 0}, {std::sqrt((1 - mu) * (1 + mu)), -mu, 0}));
}

/// Emissive surfaces, and rooms that they light.
void emissiveSurfaces(Lab& lab) {
    const Precision precision = dearPrecision(lab);
    const std::string emitter =
        "[[material]]\nname = \"lamp\"\ntype = \"emissive\"\nradiance = [3, 2, 1]\n";
    const std::string ground =
        "[[material]]\nname = \"grey\"\ntype = \"diffuse\"\ncolour = 0.5\n"
        "[[surface]]\nmaterial = \"grey\"\nplane = {}\n";
    const Vec3d lower{-1, 2, -0.5}, upper{1, 4, 0.5}, up{0, 1, 0};
    for (const double x : {0.0, 0.9, 3.0, 40.0}) {
        const Vec3d point{x, 0, 0.2};
        double irradiance = oracle::polygonIrradiance({lower,
                                                       {upper.x, lower.y, lower.z},
                                                       {upper.x, lower.y, upper.z},
                                                       {lower.x, lower.y, upper.z}},
                                                      point, up);
        if (x > upper.x)
            irradiance += oracle::polygonIrradiance({{upper.x, lower.y, lower.z},
                                                     {upper.x, upper.y, lower.z},
                                                     upper,
                                                     {upper.x, lower.y, upper.z}},
                                                    point, up);
        const std::string name = fmt::format("ground at {} under a box of light", x);
        lab.add(
            caseOf(name, 3 * 0.5 / pi * irradiance,
                   evenPicture(lab, name,
                               sceneIn(lab, emitter + ground +
                                                "[[surface]]\nmaterial = \"lamp\"\nbox = { min "
                                                "= [-1, 2, -0.5], max = [1, 4, 0.5] }\n" +
                                                pencilCamera(point + Vec3d{0, 1, 2}, {0, -1, -2})),
                               precision, {0})[0],
                   precision));
    }
    for (const double cosine : {1.0, 0.3, 0.0}) {
        const double distance = 2.5, sine = std::sqrt(1 - cosine * cosine);
        const std::string name = fmt::format("ground under a ball of light, cosine {}", cosine);
        Case c = caseOf(
            name, 3 * 0.5 / pi * oracle::sphereIrradiance(1, distance, cosine),
            evenPicture(lab, name,
                        sceneIn(lab, emitter + ground +
                                         fmt::format("[[surface]]\nmaterial = \"lamp\"\nsphere = "
                                                     "{{ centre = [{}, {}, 0], radius = 1 }}\n",
                                                     distance * sine, distance * cosine) +
                                         pencilCamera({-1, 1, 3}, {1, -1, -3})),
                        precision, {0})[0],
            precision);
        c.allowance += 2e-4 * c.expected, c.note = "a ball of light is a mesh of equal area";
        lab.add(c);
    }
    const std::string room =
        "[[material]]\nname = \"lamp\"\ntype = \"emissive\"\nradiance = [3, 2, 1]\n"
        "both_sides = true\n"
        "[[material]]\nname = \"grey\"\ntype = \"diffuse\"\ncolour = 0.8\n"
        "[[material]]\nname = \"wall\"\ntype = \"mix\"\nfirst = \"lamp\"\nsecond = \"grey\"\n"
        "weight = 0.75\n"
        "[[surface]]\nmaterial = \"wall\"\nbox = { min = [-1, -2, -0.5], max = [1, 4, 0.5] }\n";
    const std::string fog =
        "[[volume]]\nbox = { min = [-0.9, -1, -0.6], max = [2, 3.9, 0.4] }\n"
        "sigma_s = [2, 1, 0.3]\nsigma_a = 0\ng = 0.6\n";
    const double even = oracle::cavityRadiance(0.25, 0.75 * 0.8);
    for (const bool foggy : {false, true}) {
        const std::string name =
            foggy ? "a shining room full of white fog" : "a room whose walls shine and reflect";
        const RgbEstimate e = evenPicture(
            lab, name,
            sceneIn(lab, room + (foggy ? fog : "") + pencilCamera({0.3, 0.1, 0.2}, {1, 0.4, -0.2})),
            precision);
        for (int i = 0; i < 3; ++i)
            lab.add(caseOf(fmt::format("{}, channel {}", name, i), (3 - i) * even,
                           e[static_cast<std::size_t>(i)], precision));
    }
    // The shadow of absorbing fog, under a sun from straight above.
    const std::string scene = ground +
                              "[[volume]]\nbox = { min = [-1, 1, -1], max = [1, 2, 1] }\n"
                              "sigma_a = 0.7\nsigma_s = 0\n"
                              "[[light]]\ntype = \"sun\"\ndirection = [0, -1, 0]\nirradiance = 2\n";
    lab.add(caseOf("ground in the shadow of fog", 0.5 / pi * 2 * std::exp(-0.7),
                   evenPicture(lab, "shadow of fog",
                               sceneIn(lab, scene + pencilCamera({9, 0.5, 0}, {-18, -1, 0})),
                               precision, {0})[0],
                   precision));
}

}  // namespace

std::vector<Check> surfaces() {
    return {{Kind::Surface, "plates of glass", plates},
            {Kind::Surface, "nested dielectrics", nested},
            {Kind::Surface, "total reflection", totalReflection},
            {Kind::Surface, "media inside surfaces", mediaInside},
            {Kind::Surface, "furnaces with surfaces", furnaces},
            {Kind::Surface, "emissive surfaces", emissiveSurfaces}};
}

}  // namespace woodcock::proof
