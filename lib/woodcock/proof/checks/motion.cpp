// SPDX-License-Identifier: Apache-2.0
// Volumes that their velocities move while the shutter is open.
#include <fmt/format.h>

#include <cmath>

#include "woodcock/base/random.h"
#include "woodcock/medium/optical_depth.h"
#include "woodcock/proof/checks/measure.h"
#include "woodcock/proof/checks/subjects.h"
#include "woodcock/proof/oracles/quadrature.h"
#include "woodcock/proof/support/write_vdb.h"

namespace woodcock::proof {

namespace {

constexpr const char* uniformLight = "[[light]]\ntype = \"environment\"\n";
constexpr const char* dark = "[[light]]\ntype = \"environment\"\nradiance = 0\n";

// ---- the files ------------------------------------------------------------------------------

/// World units are 16 voxels. All grids lie around the origin.
constexpr double voxel = 1.0 / 16;
const Affine3d place = Affine3d::translate({-1, -1, -1}) * Affine3d::scale({voxel, voxel, voxel});

/// A ball of fog, denser on one side.
double fog(Vec3i v) {
    const Vec3d p = place.point(v.as<double>());
    return std::max(0.0, 1 - length(p) / 0.7) * (1 + 0.8 * std::sin(9 * p.x) * std::cos(7 * p.y));
}

GridSpec gridOf(const std::string& name, std::function<double(Vec3i)> value) {
    GridSpec grid{.name = name, .box = {{0, 0, 0}, {32, 32, 32}}, .value = std::move(value)};
    grid.worldFromIndex = place;
    return grid;
}

/// World units per second, at world positions.
GridSpec velocityOf(const std::function<Vec3d(Vec3d)>& velocity) {
    GridSpec grid{.name = "vel", .type = VdbType::Vec3s, .box = {{0, 0, 0}, {32, 32, 32}}};
    grid.colour = [=](Vec3i v) { return velocity(place.point(v.as<double>())); };
    grid.worldFromIndex = place;
    grid.gridClass = "unknown";
    return grid;
}

/// Without order, in metres per frame at 1 frame a second: up to a quarter of the ball's radius.
Vec3d swirl(Vec3d p) {
    return Vec3d{-p.y, p.x, 0.2 * std::sin(20 * p.x)} * 0.3 + Vec3d{0.02, -0.05, 0.04};
}

/// The same velocity in all of space.
GridSpec evenVelocity(Vec3d v) {
    GridSpec grid{.name = "vel", .type = VdbType::Vec3s, .background = {v.x, v.y, v.z}};
    grid.worldFromIndex = place;
    return grid;
}

// ---- even velocities ------------------------------------------------------------------------

/// The fog where a transform has moved it: its transmittance along a line, without randomness.
double transmittanceAt(Lab& lab, Vec3d moved, double sigma, Vec3d eye, Vec3d direction) {
    const render::Scene still =
        sceneIn(lab, fmt::format("[[volume]]\nfile = \"even.vdb\"\nsigma_a = {}\n"
                                 "transform = {{ translate = [{}, {}, {}] }}\n",
                                 sigma, moved.x, moved.y, moved.z) +
                         dark + pencilCamera(eye, direction));
    return std::exp(-medium::exactOpticalDepth(still.medium, eye, direction, 0, 20)[0]);
}

/// An even velocity moves a volume as its transform would: the mean over the shutter of exact
/// transmittances. The shutter's sign and place matter: the lines are not in the middle.
void evenMotion(Lab& lab) {
    const Vec3d v{0.6, -0.3, 0.2};
    writeVdb(lab.file("even.vdb"), {gridOf("density", fog), evenVelocity(v)});
    const Precision precision{lab.pick(1e-2, 1e-3), 0};
    constexpr double sigma = 6;
    const Vec3d eye{0.35, 0.1, 5}, direction{0, 0, -1};
    const oracle::Quadrature rule = oracle::gaussLegendre(64);
    for (const auto& [open, close] : {std::pair{-0.5, 0.5}, {0.0, 1.0}, {-1.0, 0.0}, {0.4, 0.4}}) {
        double expected = 0;
        for (std::size_t i = 0; i < rule.nodes.size(); ++i) {
            const double time = open + (close - open) * rule.nodes[i];
            expected += rule.weights[i] * transmittanceAt(lab, v * time, sigma, eye, direction);
        }
        for (const bool turned : {false, true}) {
            // A quarter turn of everything: the volume's transform turns its velocities, too.
            const Affine3d turn = turned ? Affine3d::rotate(1, 90) : Affine3d{};
            const std::string name =
                fmt::format("transmittance at even velocity, shutter {} to {}{}", open, close,
                            turned ? ", turned" : "");
            const render::Scene scene = sceneIn(
                lab,
                fmt::format("[[volume]]\nfile = \"even.vdb\"\nsigma_a = {}\n{}{}[render]\n"
                            "fps = 1\n",
                            sigma, turned ? "transform = { rotate = [0, 90, 0] }\n" : "",
                            uniformLight + pencilCamera(turn.point(eye), turn.vector(direction)) +
                                fmt::format("shutter = [{}, {}]\n", open, close)));
            const RgbEstimate e = evenPicture(lab, name, scene, precision, {0});
            Case one = caseOf(name, expected, e[0], precision);
            one.allowance += 1e-4 * expected;  // of the quadrature
            lab.add(std::move(one));
        }
    }
}

// ---- bounds ---------------------------------------------------------------------------------

/// At random places and times no value of a moved grid is beyond the bounds of its cell; one
/// voxel's velocity is a hundred times that of the others.
void boundsInMotion(Lab& lab) {
    GridSpec velocity = velocityOf(swirl);
    velocity.voxels = {{{16, 20, 14}, {40, -30, 20}}};
    GridSpec staggered = velocity;
    staggered.gridClass = "staggered";
    for (const GridSpec& grid : {velocity, staggered}) {
        writeVdb(lab.file("outlier.vdb"), {gridOf("density", fog), grid});
        const std::string name =
            fmt::format("values beyond the bounds in motion, {}",
                        grid.gridClass == "staggered" ? "staggered" : "collocated");
        const render::Scene scene =
            sceneIn(lab, std::string("[[volume]]\nfile = \"outlier.vdb\"\nscale = 30\n") + dark +
                             pencilCamera({0, 0, 5}, {0, 0, -1}) +
                             "shutter = [-0.2, 1]\n[render]\nfps = 1\n");
        const medium::MediumPart& part = scene.medium.parts[0];
        RandomStream random(lab.seed(name));
        int beyond = 0, seen = 0;
        const int count = lab.pick(200000, 5000000);
        for (int i = 0; i < count; ++i) {
            const auto u = [&] { return 44 * random.uniform() - 6; };
            const Vec3d index{u(), u(), u()};
            const auto time = static_cast<float>(random.uniform());
            const float f = part.value(place.point(index), time)[0];
            seen += f > 0;
            const bool inside = part.support().contains(index);
            const grid::Range r =
                inside ? part.majorants().find(floorToInt(index)).range : grid::Range{};
            beyond += !(r.min <= f * (1 + 1e-6f) && f <= r.max * (1 + 1e-6f));
        }
        lab.add({.name = name,
                 .measured = static_cast<double>(beyond),
                 .note = fmt::format("of {} places and times, {} of them in matter", count, seen)});
    }
}

// ---- nothing is lost ------------------------------------------------------------------------

constexpr const char* swirling = "shutter = [-0.5, 0.5]\n[render]\nfps = 1\n";

/// A volume that scatters without loss is invisible in uniform light, also while it moves.
void furnaceInMotion(Lab& lab) {
    writeVdb(lab.file("swirl.vdb"), {gridOf("density", fog), velocityOf(swirl)});
    const Precision precision{lab.pick(1e-2, 1e-3), 0};
    for (const char* by : {"", "march_step = 0.5\n"}) {
        const std::string name = fmt::format("white furnace in motion{}", *by ? ", marched" : "");
        const RgbEstimate e = evenPicture(
            lab, name,
            sceneIn(lab, std::string("[[volume]]\nfile = \"swirl.vdb\"\nscale = [20, 8, 3]\n"
                                     "g = 0.4\n") +
                             uniformLight + pencilCamera({0.2, 0.1, 5}, {0, 0, -1}) + swirling +
                             by),
            precision);
        for (std::size_t c = 0; c < 3; ++c)
            lab.add(caseOf(fmt::format("{}, channel {}", name, c), 1, e[c], precision));
    }
}

/// Emission and absorption that move together stay in thermal equilibrium with their surroundings.
void equilibriumInMotion(Lab& lab) {
    writeVdb(lab.file("swirl.vdb"), {gridOf("density", fog), velocityOf(swirl)});
    const Precision precision{lab.pick(1e-2, 2e-3), 0};
    const std::string name = "thermal equilibrium in motion";
    const RgbEstimate e = evenPicture(
        lab, name,
        sceneIn(lab, std::string("[[volume]]\nfile = \"swirl.vdb\"\nsigma_a = [5, 2, 9]\n"
                                 "sigma_s = [3, 6, 1]\nemission = [5, 2, 9]\n") +
                         uniformLight + pencilCamera({0.2, 0.1, 5}, {0, 0, -1}) + swirling),
        precision);
    for (std::size_t c = 0; c < 3; ++c) {
        Case one = caseOf(fmt::format("{}, channel {}", name, c), 1, e[c], precision);
        one.allowance += 1e-6;
        lab.add(std::move(one));
    }
}

/// The two halves of a volume, moved alike, are the volume: its light and what it lets through.
void superpositionInMotion(Lab& lab) {
    const auto part = [](double share) {
        return [share](Vec3i v) {
            const double u = RandomStream(hashOf(3, v.x, v.y, v.z)).uniform();
            return fog(v) * (share > 0 ? u : 1 - u);
        };
    };
    const GridSpec velocity = velocityOf(swirl);
    writeVdb(lab.file("whole.vdb"), {gridOf("density", fog), velocity});
    writeVdb(lab.file("left.vdb"), {gridOf("density", part(1)), velocity});
    writeVdb(lab.file("right.vdb"), {gridOf("density", part(0)), velocity});
    const auto volume = [](const std::string& file) {
        return fmt::format("[[volume]]\nfile = \"{}.vdb\"\nscale = 12\nalbedo = 0.8\n", file);
    };
    const Precision precision = usualPrecision(lab);
    const std::string rest = "[[light]]\ntype = \"sun\"\ndirection = [-1, -2, -1]\n" +
                             std::string(uniformLight) + pencilCamera({0.2, 0.1, 5}, {0, 0, -1}) +
                             swirling;
    const auto picture = [&](const std::string& name, const std::string& volumes) {
        return evenPicture(lab, name, sceneIn(lab, volumes + rest), precision, {0})[0];
    };
    const Estimate whole = picture("a volume in motion", volume("whole"));
    const Estimate halves = picture("its halves in motion", volume("left") + volume("right"));
    const double ratio = halves.mean / whole.mean;
    lab.add(
        caseOf("the halves of a volume in motion over the volume", 1,
               {ratio, ratio * std::hypot(halves.error / halves.mean, whole.error / whole.mean)},
               {1.6 * precision.relative, 0}));
}

/// Velocities of 0 give the bits of a closed shutter.
void standingStill(Lab& lab) {
    writeVdb(lab.file("still.vdb"),
             {gridOf("density", fog), velocityOf([](Vec3d) { return Vec3d{}; })});
    writeVdb(lab.file("swirl.vdb"), {gridOf("density", fog), velocityOf(swirl)});
    const auto film = [&](const std::string& file, const std::string& keys,
                          const std::string& shutter) {
        return renderScene(sceneIn(lab, fmt::format("[[volume]]\nfile = \"{}.vdb\"\nscale = 20\n"
                                                    "albedo = 0.9\n{}",
                                                    file, keys) +
                                            uniformLight + pencilCamera({0.2, 0.1, 5}, {0, 0, -1}) +
                                            shutter),
                           {8, 8, 16})
            .film;
    };
    const image::Film sharp = film("still", "", "");
    const auto add = [&](const std::string& where, const image::Film& other) {
        int count = 0;
        for (int y = 0; y < 8; ++y)
            for (int x = 0; x < 8; ++x) count += sharp.radiance(x, y) != other.radiance(x, y);
        lab.add({.name = "pixels that an open shutter changes where " + where,
                 .measured = static_cast<double>(count)});
    };
    add("velocities are 0", film("still", "", "shutter = 1\n"));
    add("velocities are scaled to 0", film("swirl", "velocity_scale = 0\n", "shutter = 1\n"));
}

}  // namespace

std::vector<Check> motion() {
    return {{Kind::ClosedForm, "even velocity", evenMotion},
            {Kind::Property, "bounds in motion", boundsInMotion},
            {Kind::Property, "white furnace in motion", furnaceInMotion},
            {Kind::Property, "thermal equilibrium in motion", equilibriumInMotion},
            {Kind::Property, "superposition in motion", superpositionInMotion},
            {Kind::Property, "standing still", standingStill}};
}

}  // namespace woodcock::proof
