// SPDX-License-Identifier: Apache-2.0
// Light that is scattered once, and the half-space under a sun, for which all orders have a
// formula.
#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "woodcock/proof/checks/measure.h"
#include "woodcock/proof/checks/subjects.h"
#include "woodcock/proof/oracles/chandrasekhar.h"
#include "woodcock/proof/oracles/closed_forms.h"
#include "woodcock/proof/oracles/quadrature.h"
#include "woodcock/proof/support/write_vdb.h"

namespace woodcock::proof {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr const char* evenLight = "[[light]]\ntype = \"environment\"\nradiance = 1\n";

Precision oncePrecision(const Lab& lab) {
    return lab.full() ? Precision{2e-3, 4e-6} : Precision{1e-2, 0};
}

void writeSlabs(const Lab& lab) {
    writeSlab(lab, "even.vdb", {1, 1, 1, 1});
    writeSlab(lab, "layered.vdb", {5, 0, 1, 0.125, 0, 0, 8, 3, 0.5, 2, 0, 4});
}

/// Rows for the body of a [[volume]] of vertical depth 1 where scale is 1.
const std::pair<const char*, const char*> slabs[]{
    {"box", "box = { min = [-1e7, 0, -1e7], max = [1e7, 1, 1e7] }"},
    {"even voxels", "file = \"even.vdb\""},
    {"layered voxels", "file = \"layered.vdb\""}};

std::string sun(Vec3d travel) {
    return fmt::format(
        "[[light]]\ntype = \"sun\"\nirradiance = [1, 2, 0]\n"
        "direction = [{:.17g}, {:.17g}, {:.17g}]\n",
        travel.x, travel.y, travel.z);
}

/// Of the beam's first channel; the second has twice the irradiance, the third none.
void addSunLit(Lab& lab, const std::string& name, double expected, const RgbEstimate& measured,
               const Precision& precision) {
    lab.add(caseOf(name, expected, measured[0], precision));
    lab.add(caseOf(name + ", twice the sun", 2 * expected, measured[1],
                   {precision.relative, 2 * precision.floor}));
    lab.add(caseOf(name + ", no sun", 0, measured[2], precision));
}

void planeSlab(Lab& lab) {
    writeSlabs(lab);
    const Precision precision = oncePrecision(lab);
    struct Set {
        double depth, albedo, g, mu, mu0, azimuth;
    };
    const std::vector<Set> sets{
        {0.1, 1, 0, 1, 1, 0},         {1, 0.8, 0.5, 0.6, 0.8, 90},  {1, 0.8, -0.3, 0.6, 0.6, 0},
        {1, 0.5, 0.85, 0.5, 0.5, 40}, {5, 0.9, 0, 0.3, 0.9, 120},   {5, 1, 0.5, 0.9, 0.3, 180},
        {2, 0.7, 0.7, 0.2, 0.2, 180}, {20, 0.99, -0.6, 0.7, 1, 30}, {0.3, 1, 0.9, 0.05, 0.4, 10}};
    int row = 0;
    for (const Set& s : sets)
        for (const bool reflected : {true, false}) {
            const auto& [slabName, slab] = slabs[static_cast<std::size_t>(row++ % 3)];
            // The view goes down towards +x; the sun's light comes down, or up from below.
            const double sine = std::sqrt(1 - s.mu0 * s.mu0), turn = s.azimuth * pi / 180;
            const Vec3d travel{sine * std::cos(turn), reflected ? -s.mu0 : s.mu0,
                               sine * std::sin(turn)};
            const Vec3d back{-std::sqrt(1 - s.mu * s.mu), s.mu, 0};
            const double phase = oracle::henyeyGreenstein(dot(travel, back), s.g);
            const double expected =
                reflected ? oracle::singleScatterReflected(s.depth, s.albedo, phase, s.mu, s.mu0)
                          : oracle::singleScatterTransmitted(s.depth, s.albedo, phase, s.mu, s.mu0);
            if (expected < lab.pick(1.2e-3, 1e-7)) continue;  // rare events take long
            const std::string name =
                fmt::format("once {} by {}, depth {}, albedo {}, g {}, mu {}, mu0 {}, azimuth {}",
                            reflected ? "reflected" : "transmitted", slabName, s.depth, s.albedo,
                            s.g, s.mu, s.mu0, s.azimuth);
            const render::Scene scene =
                sceneIn(lab, fmt::format("[[volume]]\n{}\nscale = {}\nalbedo = {}\ng = {}\n", slab,
                                         s.depth, s.albedo, s.g) +
                                 sun(travel) + cameraAbove(s.mu));
            addSunLit(lab, name, expected, evenPicture(lab, name, scene, precision, {0}, 1),
                      precision);
        }
}

std::string halfSpace(const char* slab, double albedo) {
    return fmt::format("[[volume]]\n{}\nscale = 2000\nalbedo = {}\ng = 0\n", slab, albedo);
}

/// By reciprocity, the radiance seen under a uniform sky is the part of a beam that is reflected.
Estimate firstOrder(const Lab& lab, const char* slab, double albedo, double mu,
                    const Precision& precision) {
    const std::string name = fmt::format("first order {} {} {}", slab, albedo, mu);
    return evenPicture(lab, name,
                       sceneIn(lab, halfSpace(slab, albedo) + evenLight + cameraAbove(mu)),
                       precision, {0}, 1)[0];
}

void halfSpaceOnce(Lab& lab) {
    writeSlabs(lab);
    const Precision precision = oncePrecision(lab);
    for (const auto& [slabName, slab] : slabs) {
        for (const auto& [albedo, mu] : {std::pair{1.0, 1.0}, {0.5, 0.5}, {0.9, 0.1}})
            lab.add(caseOf(fmt::format("first order of a half-space ({}), albedo {}, mu {}",
                                       slabName, albedo, mu),
                           oracle::halfSpaceFirstOrderAlbedo(albedo, mu),
                           firstOrder(lab, slab, albedo, mu, precision), precision));
        if (slab != slabs[2].second) continue;
        // The integral of 2 mu times it, and what the rule leaves of the formula.
        const double albedo = 0.8;
        const oracle::Quadrature rule = oracle::gaussLegendre(8);
        double mean = 0, variance = 0, exact = 0;
        for (std::size_t i = 0; i < rule.nodes.size(); ++i) {
            const double mu = rule.nodes[i], weight = 2 * mu * rule.weights[i];
            const Estimate e = firstOrder(lab, slab, albedo, mu, {2 * precision.relative, 0});
            mean += weight * e.mean, variance += weight * weight * e.error * e.error;
            exact += weight * oracle::halfSpaceFirstOrderAlbedo(albedo, mu);
        }
        Case c = caseOf(fmt::format("first order of a half-space ({}), diffuse light", slabName),
                        oracle::halfSpaceFirstOrderWhiteSkyAlbedo(albedo),
                        {mean, std::sqrt(variance)}, precision);
        c.allowance += std::abs(exact - c.expected);
        c.note = "eight angles";
        lab.add(c);
    }
}

void halfSpaceUnderTheSun(Lab& lab) {
    writeSlabs(lab);
    const Precision precision = oncePrecision(lab);
    int row = 0;
    for (const auto& [albedo, mu, mu0] :
         std::initializer_list<std::array<double, 3>>{{0.2, 1, 1},
                                                      {0.5, 0.6, 0.3},
                                                      {0.8, 0.2, 0.9},
                                                      {0.9, 1, 0.5},
                                                      {0.99, 0.1, 0.2},
                                                      {0.99, 0.5, 0.5}}) {
        const auto& [slabName, slab] = slabs[static_cast<std::size_t>(row++ % 3)];
        if (!lab.full() && row > 5) break;
        const std::string name = fmt::format(
            "half-space ({}) under the sun, albedo {}, mu {}, mu0 {}", slabName, albedo, mu, mu0);
        const Vec3d travel{0, -mu0, std::sqrt(1 - mu0 * mu0)};
        const render::Scene scene =
            sceneIn(lab, halfSpace(slab, albedo) + sun(travel) + cameraAbove(mu));
        addSunLit(lab, name, oracle::halfSpaceRadiance(albedo, mu, mu0),
                  evenPicture(lab, name, scene, precision, {0}), precision);
    }
}

// ---- airlight ---------------------------------------------------------------------------------

constexpr double sigmaA = 0.3, sigmaS = 0.7, sigmaT = sigmaA + sigmaS;

std::string fogIn(const char* shape, double g) {
    return fmt::format("[[volume]]\n{}\nsigma_a = {}\nsigma_s = {}\ng = {}\n", shape, sigmaA,
                       sigmaS, g);
}
std::string point(Vec3d p) {
    return fmt::format("[[light]]\ntype = \"point\"\nposition = [{}, {}, {}]\nintensity = 1\n", p.x,
                       p.y, p.z);
}
/// As bright from afar as that point.
std::string sphere(Vec3d p, double radius) {
    return fmt::format(
        "[[light]]\ntype = \"sphere\"\nposition = [{}, {}, {}]\nradius = {}\nradiance = {}\n"
        "visible = false\n",
        p.x, p.y, p.z, radius, 1 / (pi * radius * radius));
}

/// Eye and light in fog that reaches 40 mean free paths and more: a box, or one tile of voxels.
void airlight(Lab& lab) {
    GridSpec tile;
    tile.tiles = {{{0, 0, 0}, 128, {1}}};
    tile.worldFromIndex = Affine3d::translate({-64, -64, -64});
    writeVdb(lab.file("fog.vdb"), {tile});
    const Precision precision = oncePrecision(lab);
    constexpr double radius = 1e-4;
    for (const bool voxels : {false, true})
        for (const double g : {0.0, 0.8, -0.5, 0.95})
            for (const double offset : {0.02, 0.5, 3.0})
                for (const double eye : {-2.0, 1.0}) {  // the light is ahead, or behind
                    const char* fog = voxels
                                          ? "file = \"fog.vdb\""
                                          : "box = { min = [-60, -60, -60], max = [60, 60, 60] }";
                    const bool ball = voxels && offset < 3;
                    const Vec3d lightPosition{0, offset, 0};
                    const std::string name = fmt::format(
                        "airlight of a {} in fog ({}), g {}, offset {}, eye at {}",
                        ball ? "small sphere" : "point", voxels ? "voxels" : "box", g, offset, eye);
                    const render::Scene scene = sceneIn(
                        lab, fogIn(fog, g) +
                                 (ball ? sphere(lightPosition, radius) : point(lightPosition)) +
                                 pencilCamera({eye, 0, 0}, {1, 0, 0}));
                    const double expected =
                        oracle::airlight({sigmaA, sigmaS, g, 1, offset}, eye, eye, infinity);
                    Case c = caseOf(name, expected,
                                    evenPicture(lab, name, scene, precision, {0}, 1)[0], precision);
                    // Light starts at the surface; the phase function is a mean over the sphere.
                    if (ball) c.allowance += expected * (sigmaT * radius + radius / offset);
                    lab.add(c);
                }
}

constexpr double half = 2;  // of the edge of a box of fog around the origin

/// The length of the straight line between two points inside of that box.
double inFog(Vec3d a, Vec3d b) {
    double t0 = 0, t1 = 1;
    for (int i = 0; i < 3; ++i) {
        const double d = b[i] - a[i];
        if (d == 0) continue;
        const double s = (-half - a[i]) / d, t = (half - a[i]) / d;
        t0 = std::max(t0, std::min(s, t)), t1 = std::min(t1, std::max(s, t));
    }
    return std::max(0.0, t1 - t0) * length(b - a);
}

/// Scattered once into a view along -z that enters the box at its face.
double airlightInBox(Vec3d lightPosition, double g) {
    const oracle::Quadrature rule = oracle::gaussLegendre(8);
    constexpr int panels = 1000;
    double sum = 0;
    for (int panel = 0; panel < panels; ++panel)
        for (std::size_t i = 0; i < rule.nodes.size(); ++i) {
            const double z = half * (2 * (panel + rule.nodes[i]) / panels - 1);
            const Vec3d at{0, 0, z}, toLight = lightPosition - at;
            const double distance = length(toLight);
            sum += rule.weights[i] * 2 * half / panels * sigmaS *
                   oracle::henyeyGreenstein(-toLight.z / distance, g) / (distance * distance) *
                   std::exp(-sigmaT * (half - z + inFog(at, lightPosition)));
        }
    return sum;
}

/// The eye outside of a box of fog; the light inside, or outside on any side.
void airlightOfABox(Lab& lab) {
    const Precision precision = oncePrecision(lab);
    const std::string fog = "box = { min = [-2, -2, -2], max = [2, 2, 2] }";
    for (const Vec3d lightPosition : {Vec3d{0.3, 0.2, 0.5}, Vec3d{0.05, 0, -1}, Vec3d{3, 0.5, 1},
                                      Vec3d{0.5, -1, 6}, Vec3d{1, 2.5, -4}})
        for (const double g : {0.0, 0.8, -0.5}) {
            const std::string name =
                fmt::format("airlight of a box of fog, light at {}/{}/{}, g {}", lightPosition.x,
                            lightPosition.y, lightPosition.z, g);
            const render::Scene scene = sceneIn(lab, fogIn(fog.c_str(), g) + point(lightPosition) +
                                                         pencilCamera({0, 0, 10}, {0, 0, -1}));
            Case c = caseOf(name, airlightInBox(lightPosition, g),
                            evenPicture(lab, name, scene, precision, {0}, 1)[0], precision);
            c.allowance += 1e-5 * c.expected;
            c.note = "quadrature to 1e-5, as panels hold the kinks of corners";
            lab.add(c);
        }
}

}  // namespace

std::vector<Check> singleScattering() {
    return {{Kind::ClosedForm, "slabs that scatter once", planeSlab},
            {Kind::ClosedForm, "half-spaces that scatter once", halfSpaceOnce},
            {Kind::ClosedForm, "half-spaces under the sun", halfSpaceUnderTheSun},
            {Kind::ClosedForm, "airlight", airlight},
            {Kind::ClosedForm, "airlight of a box", airlightOfABox}};
}

}  // namespace woodcock::proof
