// SPDX-License-Identifier: Apache-2.0
// Rays along faces, edges and corners of voxels; cameras, lights and volumes in unusual positions.
#include <fmt/format.h>

#include <cmath>

#include "woodcock/base/random.h"
#include "woodcock/medium/optical_depth.h"
#include "woodcock/medium/tracking.h"
#include "woodcock/proof/checks/extremes.h"
#include "woodcock/proof/oracles/adding_doubling.h"
#include "woodcock/proof/oracles/closed_forms.h"
#include "woodcock/proof/support/write_vdb.h"

namespace woodcock::proof {

namespace {

double noise(Vec3i v) {
    for (int i = 0; i < 3; ++i)
        if (v[i] < 0 || v[i] > 7) return 0;
    return static_cast<double>(hashOf(3, v.x, v.y, v.z) % 257) / 256;
}

struct Line {
    const char* name;
    Vec3d from, along;
    double end = std::numeric_limits<double>::infinity();
};
constexpr double tiny = 5e-324;  // the least denormal
const Line lines[]{{"along x through voxels", {-3, 3, 4}, {1, 0, 0}},
                   {"along -y through voxels", {2, 30, 5}, {0, -1, 0}},
                   {"along z, between voxels", {2.5, 3.5, -9}, {0, 0, 1}},
                   {"inside the face of the support", {-3, 8, 4.3}, {1, 0, 0}},
                   {"inside the face of a leaf", {-3, 0, 4.3}, {1, 0, 0}},
                   {"along the edge of the support", {-1, 8, -5}, {0, 0, 1}},
                   {"along the edge of a leaf", {0, 0, -5}, {0, 0, 1}},
                   {"through corners", {-2, -2, -2}, {1, 1, 1}},
                   {"through other corners", {-2, 9, -2}, {1, -1, 1}},
                   {"through edges", {-2, -2, 3.3}, {1, 1, 0}},
                   {"past a corner of the support", {-2, -1, 3}, {1, -1, 0}},
                   {"from inside, at a voxel", {3, 3, 3}, {-1, 0, 0}},
                   {"with a denormal component", {-3, 3, 4.5}, {1, tiny, -tiny}},
                   {"with small components", {-3, 3, 4.5}, {1, 1e-300, -1e-17}},
                   {"with all but one denormal, in a face", {3.2, -2, 0}, {-tiny, 1, tiny}},
                   {"of length 1e-300", {3.2, 2, 1}, {0.6, 0.8, 0}, 1e-300},
                   {"of length zero", {3.2, 2, 1}, {0.6, 0.8, 0}, 0}};

/// Both walks and the exact integrator, called as the tracer calls them: directions of any kind
/// arrive.
void rays(Lab& lab) {
    GridSpec spec;
    spec.box = {{0, 0, 0}, {7, 7, 7}};
    spec.value = noise;
    writeVdb(lab.file("noise.vdb"), {spec});
    const medium::Medium medium =
        sceneIn(lab, "[[volume]]\nfile = \"noise.vdb\"\nsigma_a = 0.1\nsigma_s = 0.2\n" +
                         std::string(evenLight) + cameraAbove(1))
            .medium;
    Precision precision = extremePrecision(lab);
    if (lab.full()) precision.relative = 4e-3;
    const int count = lab.pick(80000, 600000);
    for (const Line& l : lines) {
        const Vec3d along = normalize(l.along);
        const double depth = 0.3f * oracle::lineIntegral(noise, spec.box, l.from, along, 0, l.end);
        lab.add({.name = fmt::format("optical depth {}", l.name),
                 .expected = depth,
                 .measured = double{medium::exactOpticalDepth(medium, l.from, along, 0, l.end)[0]},
                 .allowance = 2e-6 * depth + 1e-40});
        std::vector<medium::TransmittanceQuery<1>> across;
        std::vector<medium::DistanceQuery<1>> scattered;
        for (int i = 0; i < count; ++i) {
            RandomStream random(hashOf(lab.seed(l.name), i));
            across.push_back({.origin = l.from,
                              .direction = along,
                              .tMax = l.end,
                              .random = random,
                              .contribution = Spectrum<1>(1)});
            const double u = random.uniformOpenLow();
            scattered.push_back({.origin = l.from,
                                 .direction = along,
                                 .tMax = l.end,
                                 .u = u,
                                 .random = random,
                                 .absorptionToo = true,
                                 .throughput = Spectrum<1>(1)});
        }
        medium::TrackingCounters counters;
        medium::trackTransmittance<1>(medium, across, counters);
        medium::trackDistance<1>(medium, scattered, counters);
        Moments transmitted, passed;
        for (const auto& q : across) transmitted.add(q.contribution[0]);
        for (const auto& q : scattered) passed.add(q.part < 0 ? 1 : 0);
        lab.add(caseOf(fmt::format("transmittance {}", l.name), std::exp(-depth),
                       Estimate(transmitted), precision));
        lab.add(caseOf(fmt::format("part that does not collide {}", l.name), std::exp(-depth),
                       Estimate(passed), precision));
        const double steps =
            static_cast<double>(counters.segments + counters.collisions) / (2 * count);
        lab.add({.name = fmt::format("steps per flight {}", l.name),
                 .expected = 0,
                 .measured = steps,
                 .allowance = 100,
                 .note = "at most 100"});
    }
}

/// A camera in the face of a slab, its ramp's foot, and in the middle of it.
void boundary(Lab& lab) {
    writeTwoColouredSky(lab);
    writeSlab(lab, "slab.vdb", {1, 1, 1, 1});
    const Precision precision = extremePrecision(lab);
    const oracle::Face face = oracle::solveSlab({.layers = {{2, 0.9, 0.3}}}, {0.7}).above;
    // Voxels 0 to 3, with ramps to -1 and 4.
    for (const double height : {4.0, std::nextafter(4.0, 0.0), std::nextafter(4.0, 5.0)}) {
        const std::string name =
            fmt::format("camera at the foot of a slab{}", height < 4   ? ", just inside"
                                                          : height > 4 ? ", just outside"
                                                                       : "");
        const RgbEstimate e = watch(
            lab, name,
            sceneIn(lab, "[[volume]]\nfile = \"slab.vdb\"\nscale = 2\nalbedo = 0.9\ng = 0.3\n" +
                             std::string(twoColouredSky) +
                             pencilCamera({0, height, 0}, {std::sqrt(0.51), -0.7, 0})),
            precision, {.channels = {0, 2}});
        Case r = caseOf("reflectance, " + name, face.reflectance[0], e[0], precision);
        Case t = caseOf("transmittance, " + name, face.transmittance[0], e[2], precision);
        r.allowance += 3e-6 + horizonAllowance, t.allowance += 3e-6 + horizonAllowance;
        lab.add(r), lab.add(t);
    }
    // In the face of a box: looking in, along the face, and away.
    const std::string box =
        "[[volume]]\nbox = { min = [0, 0, 0], max = [1, 1, 1] }\nsigma_a = 1\nsigma_s = 0\n";
    for (const auto& [name, eye, along, depth] :
         {std::tuple{"into a box", Vec3d{0, 0.5, 0.5}, Vec3d{1, 0, 0}, 1.0},
          {"away from a box", {0, 0.5, 0.5}, {-1, 0, 0}, 0.0},
          {"from a corner of a box", {0, 0, 0}, {1, 1, 1}, std::sqrt(3.0)},
          {"past an edge of a box", {0, 1, 0}, {1, 1, 0}, 0.0}})
        lab.add(caseOf(fmt::format("camera in the face, {}", name), std::exp(-depth),
                       watch(lab, name, sceneIn(lab, box + evenLight + pencilCamera(eye, along)),
                             precision)[0],
                       precision));
}

/// A point light inside the medium, next to the line of sight or to the camera itself.
void nearLight(Lab& lab) {
    const Precision precision = extremePrecision(lab);
    constexpr double half = 10, sigmaA = 0.02, sigmaS = 0.08, g = 0.6;
    const std::string volume = fmt::format(
        "[[volume]]\nbox = {{ min = [-{0}, -{0}, -{0}], max = [{0}, {0}, {0}] }}\n"
        "sigma_a = {1}\nsigma_s = {2}\ng = {3}\n",
        half, sigmaA, sigmaS, g);
    for (const double offset : {1.0, 1e-4, 1e-8})
        for (const double eye : {-5.0, 0.0, 1e-8}) {
            const std::string name =
                fmt::format("light {:g} beside the line of sight, camera at {:g}", offset, eye);
            const render::Scene scene =
                sceneIn(lab, volume +
                                 fmt::format("[[light]]\ntype = \"point\"\nintensity = 1\n"
                                             "position = [0, 0, {}]\n",
                                             digits(offset)) +
                                 pencilCamera({eye, 0, 0}, {1, 0, 0}));
            const double truth = oracle::airlight({sigmaA, sigmaS, g, 1, offset}, eye, eye, half);
            Precision wanted = precision;
            wanted.floor = 0;
            lab.add(caseOf("first scattering, " + name, truth,
                           watch(lab, name, scene, wanted, {.maxScatterings = 1})[0], wanted));
            if (eye < 0) {
                const RgbEstimate all =
                    watch(lab, name + ", all orders", scene, precision, {.side = 8});
                lab.add({.name = "all orders are finite and no less, " + name,
                         .expected = 1,
                         .measured = all[0].mean + 4 * all[0].error >= truth ? 1.0 : 0.0});
            }
        }
}

/// A thousand overlapping parts instead of one.
void crowd(Lab& lab) {
    writeSlab(lab, "slab.vdb", {1, 1, 1, 1});
    std::string volumes;
    constexpr int count = 1000;
    for (int i = 0; i < count; ++i) {
        const double sigma = 2.0 / count;
        volumes += i % 4 ? fmt::format(
                               "[[volume]]\nbox = {{ min = [-1e7, {0}, -1e7], "
                               "max = [1e7, {1}, 1e7] }}\n",
                               i % 7, i % 7 + 1)
                         : std::string("[[volume]]\nfile = \"slab.vdb\"\n");
        volumes += fmt::format("scale = {}\nalbedo = ALBEDO\n", digits(sigma));
    }
    const auto with = [&](const char* albedo) {
        std::string text = volumes;
        for (std::size_t at; (at = text.find("ALBEDO")) != std::string::npos;)
            text.replace(at, 6, albedo);
        return text;
    };
    Precision precision = extremePrecision(lab);
    lab.add(caseOf("transmittance, a thousand volumes", std::exp(-2.0),
                   watch(lab, "a thousand volumes, absorbing",
                         sceneIn(lab, with("0") + evenLight + cameraAbove(1)), precision,
                         {.side = 8, .mostSteps = 4e3})[0],
                   precision));
    const oracle::Face face = oracle::solveSlab({.layers = {{2, 0.8, 0}}}, {1}).above;
    precision.relative *= lab.pick(3.0, 5.0);
    Case both = caseOf(
        "reflected and transmitted, a thousand volumes",
        face.reflectance[0] + face.transmittance[0],
        watch(lab, "a thousand volumes", sceneIn(lab, with("0.8") + evenLight + cameraAbove(1)),
              precision, {.side = 8, .mostSteps = 4e3})[0],
        precision);
    both.allowance += 3e-6;
    lab.add(both);
}

}  // namespace

std::vector<Check> extremeRays() {
    return {{Kind::Extreme, "rays along axes, edges, corners and faces", rays},
            {Kind::Extreme, "camera on the boundary", boundary},
            {Kind::Extreme, "light next to the eye", nearLight},
            {Kind::Extreme, "a thousand overlapping volumes", crowd}};
}

}  // namespace woodcock::proof
