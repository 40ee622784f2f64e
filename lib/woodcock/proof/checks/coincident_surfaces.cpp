// SPDX-License-Identifier: Apache-2.0
// Surfaces that coincide: the same object twice, glass on a floor, blocks that touch, emitters on
// walls, and a camera on a face.
#include <fmt/format.h>

#include <cmath>

#include "woodcock/proof/checks/measure.h"
#include "woodcock/proof/checks/subjects.h"
#include "woodcock/proof/oracles/adding_doubling.h"
#include "woodcock/proof/oracles/plates.h"
#include "woodcock/proof/oracles/quadrature.h"
#include "woodcock/proof/oracles/surfaces.h"

namespace woodcock::proof {

namespace {

const std::string evenLight = "[[light]]\ntype = \"environment\"\nradiance = 1\n";
const std::string glass = "[[material]]\nname = \"glass\"\ntype = \"dielectric\"\nior = 1.5\n";
const std::string heavy = "[[material]]\nname = \"heavy\"\ntype = \"dielectric\"\nior = 1.9\n";
const std::string fog = "[[material]]\nname = \"fog\"\ntype = \"interface\"\n";

std::string diffuse(const std::string& name, double colour) {
    return fmt::format("[[material]]\nname = \"{}\"\ntype = \"diffuse\"\ncolour = {}\n", name,
                       colour);
}
std::string surface(const std::string& material, const std::string& shape,
                    const std::string& more = "") {
    return fmt::format("[[surface]]\nmaterial = \"{}\"\n{}\n{}\n", material, shape, more);
}
std::string layer(double bottom, double top, double width = 1e6) {
    return fmt::format("box = {{ min = [-{2}, {0}, -{2}], max = [{2}, {1}, {2}] }}", bottom, top,
                       width);
}

/// The transform of a whole scene.
struct Setting {
    double scale = 1;
    Vec3d place = {};

    std::string around() const {
        return fmt::format("[camera]\neye = [{}, {}, {}]\nlook_at = [{}, {}, {}]\nfov = 34\n",
                           place.x, place.y + 1.3 * scale, place.z + 4 * scale, place.x, place.y,
                           place.z);
    }
    /// Turned about x, y and z, moved by `offset` and scaled.
    std::string transform(Vec3d turn = {}, Vec3d offset = {}, double size = 1) const {
        const Vec3d at = place + offset * scale;
        return fmt::format(
            "transform = {{ scale = {}, rotate = [{}, {}, {}], translate = [{}, {}, {}] }}",
            size * scale, turn.x, turn.y, turn.z, at.x, at.y, at.z);
    }
    std::string name() const { return fmt::format("{} wide at {}", scale, place.x); }
};

const Setting settings[]{{}, {1e-4, {}}, {1e5, {}}, {1, {1e6, -1e6, 1e6}}, {1e-2, {0, 30, 0}}};

/// All pixels expect the same, in all channels.
void even(Lab& lab, const std::string& name, const std::string& scene, double expected,
          const std::string& note = "") {
    const Precision precision = dearPrecision(lab);
    Case c = caseOf(name, expected, evenPicture(lab, name, sceneIn(lab, scene), precision, {0})[0],
                    precision);
    c.note = note;
    lab.add(std::move(c));
}

/// An object that absorbs nothing is invisible, however many copies there are.
void furnaces(Lab& lab) {
    const Vec3d turn{10, 20, 30};
    const std::string ball = "sphere = {}";
    const std::string box = "box = { min = [-1, -1, -1], max = [1, 1, 1] }";
    const std::string half = "box = { min = [-0.5, -0.5, -0.5], max = [0.5, 0.5, 0.5] }";
    for (const Setting& s : settings) {
        const auto furnace = [&](const std::string& what, const std::string& scene) {
            even(lab, fmt::format("{}, {}", what, s.name()),
                 glass + heavy + fog + diffuse("white", 1) + scene + evenLight + s.around(), 1);
        };
        const std::string there = s.transform(turn);
        furnace("a glass ball twice",
                surface("glass", ball, there) + surface("glass", ball, there));
        furnace("a glass box three times", surface("glass", box, there) +
                                               surface("glass", box, there) +
                                               surface("glass", half, s.transform(turn, {}, 2)));
        furnace("glass in glass with the same walls",
                surface("glass", box, there) + surface("heavy", box, there + "\npriority = 1") +
                    surface("fog", box, there));
        // One wall is common, others cross.
        furnace("glass cubes that touch and overlap",
                surface("glass", half, s.transform({}, {-0.5, 0, 0})) +
                    surface("heavy", half, s.transform({}, {0.5, 0, 0})) +
                    surface("heavy", half, s.transform({}, {0, 1, 0})) +
                    surface("glass", half, s.transform({}, {0.2, 0, 0.3})));
        furnace(
            "blocks of glass on a white floor",
            surface("white", "plane = { size = [9, 9] }", s.transform(turn, {}, 1.0 / 3)) +
                surface("glass", "box = { min = [-0.7, 0, -0.7], max = [0.3, 1, 0.7] }", there) +
                surface("heavy", "box = { min = [0.3, 0, -0.7], max = [0.7, 0.4, 0.7] }", there));
    }
    for (const char* material : {"glass", "heavy"})
        even(lab, fmt::format("instances of {} on each other", material),
             glass + heavy +
                 surface(material, half,
                         "instances = [{}, {}, { translate = [1, 0, 0] }, { scale = -1 }, "
                         "{ rotate = [0, 90, 0] }]") +
                 evenLight + settings[0].around(),
             1);
}

/// The order in the file and rounding decide only which of two colours is seen.
void opaque(Lab& lab) {
    const std::string ball = "sphere = {}", box = "box = { min = [-1, -1, -1], max = [1, 1, 1] }";
    for (const Setting& s : settings) {
        const std::string there = s.transform({10, 20, 30});
        const std::string wide = s.transform({10, 20, 30}, {}, 2);
        const auto seen = [&](const std::string& what, const std::string& scene, double expected) {
            const Vec3d eye = s.place + Vec3d{0.1, 0.2, 5} * s.scale;
            even(lab, fmt::format("{}, {}", what, s.name()),
                 diffuse("light", 0.8) + diffuse("dark", 0.3) + scene + evenLight +
                     pencilCamera(eye, {0, 0, -1}),
                 expected, "the albedo");
        };
        seen("a diffuse ball twice", surface("light", ball, there) + surface("light", ball, there),
             0.8);
        seen("the later of two balls", surface("light", ball, there) + surface("dark", ball, there),
             0.3);
        seen("the ball of higher priority",
             surface("light", ball, there + "\npriority = 1") + surface("dark", ball, there), 0.8);
        seen(
            "the later of two boxes",
            surface("dark", box, there) +
                surface("light", "box = { min = [-0.5, -0.5, -0.5], max = [0.5, 0.5, 0.5] }", wide),
            0.8);
    }
}

/// Part of diffuse light that a plate reflects and lets through.
oracle::PlateAnswer diffusely(const oracle::Plate& plate) {
    oracle::PlateAnswer sum{0, 0};
    const oracle::Quadrature nodes = oracle::gaussLegendre(200);
    for (std::size_t i = 0; i < nodes.nodes.size(); ++i) {
        const double mu = nodes.nodes[i] * nodes.nodes[i];  // grazing light reflects most
        const double weight = nodes.weights[i] * 2 * nodes.nodes[i] * 2 * mu;
        const auto at = oracle::unpolarisedPlates({plate}, mu);
        sum.reflectance += weight * at.reflectance, sum.transmittance += weight * at.transmittance;
    }
    return sum;
}

/// A plate on a diffuse floor looks as it does a hair above it: light is reflected between the two,
/// and the plate's lower face reflects as well.
void glassOnFloors(Lab& lab) {
    const double depth = 0.3, albedo = 0.6;
    const auto all = diffusely({1.5, depth});
    const double floor = albedo * all.transmittance / (1 - albedo * all.reflectance);
    const std::string medium = fmt::format("medium = {{ sigma_a = {}, sigma_s = 0 }}", depth);
    for (const double mu : {1.0, 0.5})
        for (const double gap : {0.0, 1e-6}) {
            const auto at = oracle::unpolarisedPlates({{1.5, depth}}, mu);
            even(lab,
                 fmt::format("a plate of glass {} on a floor, mu {}",
                             gap > 0 ? fmt::format("{} above", gap) : "right", mu),
                 glass + diffuse("floor", albedo) +
                     surface("floor", "plane = {}", "transform = { translate = [0, -1, 0] }") +
                     surface("glass", layer(-1 + gap, gap, 1e4), medium) + evenLight +
                     cameraAbove(mu),
                 at.reflectance + at.transmittance * floor,
                 "sums of reflections between the plate and the floor");
        }
}

/// Pieces of glass that touch are one body for each index of refraction.
void touchingPlates(Lab& lab) {
    writeTwoColouredSky(lab);
    const Precision precision = dearPrecision(lab);
    const auto add = [&](const std::string& name, const std::string& scene,
                         const std::vector<oracle::Plate>& plates, double mu) {
        const auto answer = oracle::unpolarisedPlates(plates, mu);
        const RgbEstimate e = evenPicture(
            lab, name, sceneIn(lab, glass + heavy + fog + scene + twoColouredSky + cameraAbove(mu)),
            precision, {0, 2});
        for (const bool through : {false, true}) {
            Case c = caseOf(fmt::format("{}, {}", through ? "transmittance" : "reflectance", name),
                            through ? answer.transmittance : answer.reflectance, e[through ? 2 : 0],
                            precision);
            c.allowance += 3e-6 + horizonAllowance;
            c.note = "a pile of touching plates";
            lab.add(std::move(c));
        }
    };
    const auto absorbing = [](double sigma) {
        return fmt::format("medium = {{ sigma_a = {}, sigma_s = 0 }}", sigma);
    };
    for (const double mu : {1.0, 0.3}) {
        add(fmt::format("two plates as one, mu {}", mu),
            surface("glass", layer(-0.3, 0), absorbing(0.5)) +
                surface("glass", layer(-1, -0.3), absorbing(0.5)),
            {{1.5, 0.5}}, mu);
        // The same plane by other numbers: 0.3 is not a float, and the numbers of a rotation are
        // irrational.
        add(fmt::format("two plates that touch by other transforms, mu {}", mu),
            surface("glass", layer(0, 0.3, 1e3),
                    "transform = { translate = [0, -0.3, 0] }\n" + absorbing(0.5)) +
                surface("heavy", layer(-0.07, 0, 1e3),
                        "transform = { scale = 10, rotate = [0, 33, 0], "
                        "translate = [0, -0.3, 0] }\n" +
                            absorbing(0.5)),
            {{1.5, 0.15}, {1.9, 0.35}}, mu);
        add(fmt::format("fog of no density on a plate, mu {}", mu),
            surface("glass", layer(-1, -0.5), absorbing(0.4)) + surface("fog", layer(-0.5, 0)),
            {{1.5, 0.2}}, mu);
        add(fmt::format("a plate twice, the absorbing one of higher priority, mu {}", mu),
            surface("glass", layer(-1, 0), "priority = 1\n" + absorbing(0.4)) +
                surface("heavy", layer(-1, 0), absorbing(2)),
            {{1.5, 0.4}}, mu);
    }
    // Fog in two boxes that touch is fog in one.
    const auto slab = oracle::solveSlab({.layers = {{2, 0.9, 0.5}}}, {0.5}).above;
    const std::string name = "fog in two boxes that touch";
    const std::string milk = "medium = { sigma_a = 0.2, sigma_s = 1.8, g = 0.5 }";
    const RgbEstimate e = evenPicture(
        lab, name,
        sceneIn(lab, fog + surface("fog", layer(-0.3, 0), milk) +
                         surface("fog", layer(-1, -0.3), milk) + twoColouredSky + cameraAbove(0.5)),
        precision, {0, 2});
    for (const bool through : {false, true}) {
        Case c = caseOf(fmt::format("{}, {}", through ? "transmittance" : "reflectance", name),
                        through ? slab.transmittance[0] : slab.reflectance[0], e[through ? 2 : 0],
                        precision);
        c.allowance += 3e-6 + horizonAllowance;
        c.note = "adding-doubling";
        lab.add(std::move(c));
    }
}

/// A camera on a face is on the side to which it looks.
void camerasOnFaces(Lab& lab) {
    const std::string plates =
        glass + heavy + surface("glass", layer(-0.3, 0)) + surface("heavy", layer(-1, -0.3));
    struct Row {
        const char* what;
        double height, down, index;
    };
    for (const Row& r : {Row{"from the upper face up", 0, -1, 1},
                         {"from the upper face down", 0, 1, 1.5},
                         {"from between, up", -0.3, -1, 1.5},
                         {"from between, down", -0.3, 1, 1.9},
                         {"from the lower face up", -1, -1, 1.9},
                         {"from the lower face down", -1, 1, 1}})
        even(
            lab, std::string("an even light ") + r.what,
            plates + evenLight +
                fmt::format("[camera]\neye = [0.1, {0}, 0.2]\nlook_at = [0.1, {1}, 0.3]\nfov = 1\n",
                            r.height, r.height - r.down),
            r.index * r.index, "index^2");
}

/// An emitter on a wall emits, whichever comes first in the file, and only once.
void emittersOnWalls(Lab& lab) {
    const Precision precision = dearPrecision(lab);
    const std::string emitter =
        "[[material]]\nname = \"lamp\"\ntype = \"emissive\"\nradiance = 2\n";
    const std::string ground =
        diffuse("ground", 0.5) + diffuse("black", 0) + surface("ground", "plane = {}");
    // On a wall at z = -1 that faces +z; its own box stands behind it.
    const std::string wall = surface("black", "box = { min = [-5, -1, -2], max = [5, 5, -1] }");
    const std::string panel =
        surface("lamp", "plane = { size = [2, 1] }",
                "transform = { rotate = [90, 0, 0], translate = [0, 1.5, -1] }");
    const Vec3d point{0.4, 0, 1};
    const double irradiance = oracle::polygonIrradiance(
        {{-1, 1, -1}, {1, 1, -1}, {1, 2, -1}, {-1, 2, -1}}, point, {0, 1, 0});
    const std::string camera = pencilCamera(point + Vec3d{0, 1, 2}, {0, -1, -2});
    struct Row {
        const char* what;
        std::string surfaces;
    };
    for (const Row& r :
         {Row{"an emitter on a wall", emitter + ground + wall + panel},
          {"an emitter before its wall in the file", emitter + ground + panel + wall},
          {"an emitter twice on a wall", emitter + ground + panel + wall + panel},
          {"an emitter on a wall as two instances",
           emitter + ground + wall +
               surface("lamp", "plane = { size = [2, 1] }",
                       "instances = [{}, {}]\n"
                       "transform = { rotate = [90, 0, 0], translate = [0, 1.5, -1] }")}})
        lab.add(
            caseOf(r.what, 2 * 0.5 / pi * irradiance,
                   evenPicture(lab, r.what, sceneIn(lab, r.surfaces + camera), precision, {0})[0],
                   precision));
    even(lab, "an emitter behind the paint of its wall",
         emitter + ground + panel +
             surface("black", "box = { min = [-5, -1, -2], max = [5, 5, -1] }", "priority = 1") +
             surface("lamp", "sphere = { centre = [0, 2.5, 1], radius = 0.5 }") + camera,
         2 * 0.5 / pi *
             oracle::sphereIrradiance(0.5, std::hypot(2.5, 0.4), 2.5 / std::hypot(2.5, 0.4)),
         "the other emitter alone");
    // Walls whose planes are not exact in floats: a wall must not light itself.
    even(lab, "a shining room, turned",
         "[[material]]\nname = \"shine\"\ntype = \"emissive\"\nradiance = 1\nboth_sides = true\n" +
             diffuse("grey", 0.8) +
             "[[material]]\nname = \"wall\"\ntype = \"mix\"\nfirst = \"shine\"\n"
             "second = \"grey\"\nweight = 0.75\n" +
             surface("wall", "box = { min = [-1, -2, -0.5], max = [1, 4, 0.5] }",
                     "transform = { rotate = [10, 20, 30] }") +
             pencilCamera({0.1, 0.1, 0.1}, {1, 0.4, -0.2}),
         oracle::cavityRadiance(0.25, 0.75 * 0.8), "as in any other place");
    // Every wall of the room twice, once by other numbers: the radiance is uniform all the same.
    const std::string room =
        "[[material]]\nname = \"shine\"\ntype = \"emissive\"\nradiance = 1\nboth_sides = true\n" +
        diffuse("grey", 0.8) +
        "[[material]]\nname = \"wall\"\ntype = \"mix\"\nfirst = \"shine\"\nsecond = \"grey\"\n"
        "weight = 0.75\n" +
        surface("wall", "box = { min = [-1, -2, -0.5], max = [1, 4, 0.5] }") +
        surface("wall", "box = { min = [-0.5, -2, -1], max = [0.5, 4, 1] }",
                "transform = { rotate = [0, 90, 0] }");
    even(lab, "a shining room twice", room + pencilCamera({0.3, 0.1, 0.2}, {1, 0.4, -0.2}),
         oracle::cavityRadiance(0.25, 0.75 * 0.8), "of one room");
}

}  // namespace

std::vector<Check> surfacesTogether() {
    return {{Kind::Surface, "furnaces of surfaces in one place", furnaces},
            {Kind::Surface, "opaque surfaces in one place", opaque},
            {Kind::Surface, "glass on floors", glassOnFloors},
            {Kind::Surface, "plates that touch", touchingPlates},
            {Kind::Surface, "cameras on faces", camerasOnFaces},
            {Kind::Surface, "emitters on walls", emittersOnWalls}};
}

}  // namespace woodcock::proof
