// SPDX-License-Identifier: Apache-2.0
// Slabs of voxels, as wide as infinite, against published tables and adding-doubling.
#include <fmt/format.h>

#include <cmath>

#include "woodcock/proof/checks/measure.h"
#include "woodcock/proof/checks/subjects.h"
#include "woodcock/proof/oracles/adding_doubling.h"
#include "woodcock/proof/oracles/chandrasekhar.h"
#include "woodcock/proof/oracles/published.h"
#include "woodcock/proof/support/statistics.h"

namespace woodcock::proof {

namespace {

/// The distribution of optical depth over the height of a slab, on which its answer does not
/// depend.
struct Profile {
    const char* name;
    std::vector<double> weights;
};
const Profile even{"even", {1, 1, 1, 1}};
const Profile layered{"layered", {5, 0, 1, 0.125, 0, 0, 8, 3, 0.5, 2, 0, 4}};

void writeProfiles(const Lab& lab) {
    writeTwoColouredSky(lab);
    for (const Profile& p : {even, layered})
        writeSlab(lab, std::string(p.name) + ".vdb", p.weights);
}

struct Parameters {
    double g, depth, albedo, mu;
    const Profile& profile = even;
    std::string name() const {
        return fmt::format("g {}, depth {}, albedo {}, mu {}, {}", g, depth, albedo, mu,
                           profile.name);
    }
};

std::string slabVolume(const Parameters& p) {
    return fmt::format("[[volume]]\nfile = \"{}.vdb\"\nscale = {}\nalbedo = {}\ng = {}\n",
                       p.profile.name, p.depth, p.albedo, p.g);
}

/// How light from above is told from light from below: by a sky of two colours, which next-event
/// estimation samples, or by black boxes in uniform light, which cost less in deep slabs.
enum class Divide { Sky, Boxes };
constexpr const char* evenLight = "[[light]]\ntype = \"environment\"\nradiance = 1\n";
std::string blackBox(double bottom, double top) {
    return fmt::format(
        "[[volume]]\nbox = {{ min = [-1e9, {}, -1e9], max = [1e9, {}, 1e9] }}\n"
        "sigma_a = 10\nsigma_s = 0\n",
        bottom, top);
}

enum class Part { Reflected, Transmitted };
/// By black boxes.
Estimate measure(const Lab& lab, const Parameters& p, const Precision& precision, Part part) {
    const bool above = part == Part::Transmitted;
    const std::string box = above ? blackBox(100, 1000) : blackBox(-1000, -100);
    return evenPicture(lab, p.name() + (above ? ", transmitted" : ", reflected"),
                       sceneIn(lab, slabVolume(p) + evenLight + box + cameraAbove(p.mu)), precision,
                       {0})[0];
}

/// By reciprocity, the radiance seen at mu is the slab's answer to a beam at mu.
struct Measured {
    Estimate reflected, transmitted;
};
Measured measure(const Lab& lab, const Parameters& p, const Precision& precision, Divide divide) {
    if (divide == Divide::Boxes)
        return {measure(lab, p, precision, Part::Reflected),
                measure(lab, p, precision, Part::Transmitted)};
    const RgbEstimate e =
        evenPicture(lab, p.name(), sceneIn(lab, slabVolume(p) + twoColouredSky + cameraAbove(p.mu)),
                    precision, {0, 2});
    return {e[0], e[2]};
}

void addSlab(Lab& lab, const Parameters& p, double reflected, double transmitted, double rounding,
             const std::string& source, const Precision& precision, Divide divide) {
    const Measured m = measure(lab, p, precision, divide);
    const auto add = [&](const char* what, double expected, const Estimate& measured) {
        if (expected < 4 * precision.floor) return;  // too few paths to know their scatter
        Case c = caseOf(fmt::format("{}, {}", what, p.name()), expected, measured, precision);
        c.allowance += rounding + horizonAllowance;
        c.note = source;
        c.curve = fmt::format("{} at g {}, albedo {}, mu {}", what, p.g, p.albedo, p.mu);
        c.xName = "optical depth", c.x = p.depth;
        lab.add(std::move(c));
    };
    add("reflectance", reflected, m.reflected);
    add("transmittance", transmitted, m.transmitted);
}

/// The table of reflectance and transmittance along the normal, layers of either kind in turn.
void table(Lab& lab) {
    writeProfiles(lab);
    const Precision precision = usualPrecision(lab);
    int row = 0;
    for (const oracle::ComputedSlab& s : oracle::computedSlabs) {
        if (!lab.full() && s.albedo != 0.9 && s.albedo != 1) continue;
        addSlab(lab, {s.g, s.opticalDepth, s.albedo, 1, row++ % 2 ? layered : even}, s.reflectance,
                s.transmittance, 5e-7, "table of six decimals", precision,
                !lab.full() && row % 4 < 2 ? Divide::Sky : Divide::Boxes);  // a third of the cost
    }
}

/// Beyond the tables: oblique, strongly forward, backward, thick, nearly conservative.
void beyondTheTables(Lab& lab) {
    writeProfiles(lab);
    std::vector<Parameters> list{
        {0, 100, 0.9999, 1},  {0, 100, 1, 1},        {0.85, 100, 0.9999, 1, layered},
        {0, 10, 0.9999, 0.5}, {0.85, 1, 0.99, 1},    {0.85, 8, 0.9, 0.5, layered},
        {0.95, 2, 0.99, 1},   {0.95, 8, 1, 0.7},     {-0.5, 1, 0.9, 1, layered},
        {-0.5, 4, 0.99, 0.3}, {0.5, 0.1, 0.5, 0.2},  {0, 2, 0, 0.6, layered},
        {0.3, 32, 0.99, 0.8}, {0.75, 32, 0.9999, 1},
    };
    for (const Parameters& p : list) {
        if (!lab.full() && p.depth > 10) continue;  // thousands of scatterings
        const Precision precision = p.depth > 50 ? Precision{5e-3, 2e-5} : dearPrecision(lab);
        const oracle::SlabAnswer answer =
            oracle::solveSlab({.layers = {{p.depth, p.albedo, p.g}}}, {p.mu});
        addSlab(lab, p, answer.above.reflectance[0], answer.above.transmittance[0], 3e-6,
                "adding-doubling", precision, Divide::Boxes);
    }
}

/// Each channel has a depth, an albedo and an asymmetry of its own, by its grids.
void chromatic(Lab& lab) {
    writeProfiles(lab);
    const Precision precision = dearPrecision(lab);
    struct Set {
        double sigmaA[3], sigmaS[3], g, mu;
    };
    for (const Set& s :
         {Set{{0.5, 0.1, 0}, {0.5, 3.9, 8}, 0.5, 1}, Set{{1, 0.01, 4}, {0.1, 0.99, 12}, 0, 0.5},
          Set{{0, 2, 0.001}, {16, 2, 1}, 0.75, 1}}) {
        const std::string volume = fmt::format(
            "[[volume]]\nfile = \"layered.vdb\"\nsigma_a = [{}]\nsigma_s = [{}]\ng = {}\n",
            fmt::join(s.sigmaA, ", "), fmt::join(s.sigmaS, ", "), s.g);
        const std::string name =
            fmt::format("sigma_a {}, sigma_s {}, g {}, mu {}", fmt::join(s.sigmaA, "/"),
                        fmt::join(s.sigmaS, "/"), s.g, s.mu);
        // Seen from above, light from everywhere is reflected and transmitted light.
        const RgbEstimate both =
            evenPicture(lab, name,
                        sceneIn(lab, volume + "[[light]]\ntype = \"environment\"\nradiance = 1\n" +
                                         cameraAbove(s.mu)),
                        precision);
        const RgbEstimate parts = evenPicture(
            lab, name + ", parts", sceneIn(lab, volume + twoColouredSky + cameraAbove(s.mu)),
            precision, {0, 2});
        for (int c = 0; c < 3; ++c) {
            const double depth = s.sigmaA[c] + s.sigmaS[c];
            const oracle::Face face =
                oracle::solveSlab({.layers = {{depth, s.sigmaS[c] / depth, s.g}}}, {s.mu}).above;
            const auto i = static_cast<std::size_t>(c);
            Case whole = caseOf(fmt::format("reflected and transmitted, channel {}, {}", c, name),
                                face.reflectance[0] + face.transmittance[0], both[i], precision);
            whole.allowance += 3e-6;
            lab.add(whole);
            if (c == 1) continue;
            Case part =
                caseOf(fmt::format("{}, channel {}, {}", c == 0 ? "reflectance" : "transmittance",
                                   c, name),
                       c == 0 ? face.reflectance[0] : face.transmittance[0], parts[i], precision);
            part.allowance += 3e-6 + horizonAllowance;
            lab.add(part);
        }
    }
}

/// Media of different albedo and asymmetry on top of each other: homogeneous boxes, whose faces are
/// sharp.
void stacks(Lab& lab) {
    writeTwoColouredSky(lab);
    const Precision precision = dearPrecision(lab);
    const std::vector<std::vector<oracle::Layer>> all{{{1, 0.99, 0.8}, {2, 0.6, 0}},
                                                      {{0.5, 1, -0.4}, {4, 1, 0.9}},
                                                      {{1, 0.2, 0}, {0.5, 1, 0.5}, {3, 0.95, 0}}};
    for (const std::vector<oracle::Layer>& layers : all) {
        std::string volumes, name;
        double top = 0;
        for (const oracle::Layer& l : layers) {
            volumes += fmt::format(
                "[[volume]]\nbox = {{ min = [-1e7, {}, -1e7], max = [1e7, {}, 1e7] }}\n"
                "sigma_a = {}\nsigma_s = {}\ng = {}\n",
                top - 1, top, l.opticalDepth * (1 - l.albedo), l.opticalDepth * l.albedo, l.g);
            name += fmt::format("{}{}/{}/{}", name.empty() ? "" : " over ", l.opticalDepth,
                                l.albedo, l.g);
            top -= 1;
        }
        for (const double mu : {1.0, 0.4}) {
            const std::string what = fmt::format("depth/albedo/g {}, mu {}", name, mu);
            const RgbEstimate e =
                evenPicture(lab, what, sceneIn(lab, volumes + twoColouredSky + cameraAbove(mu)),
                            precision, {0, 2});
            const oracle::Face face = oracle::solveSlab({.layers = layers}, {mu}).above;
            Case r = caseOf("reflectance, " + what, face.reflectance[0], e[0], precision);
            Case t = caseOf("transmittance, " + what, face.transmittance[0], e[2], precision);
            r.allowance += 3e-6 + horizonAllowance, t.allowance += 3e-6 + horizonAllowance;
            lab.add(r), lab.add(t);
        }
    }
}

/// A finite grid is used for an infinite slab: the effect of its width.
void width(Lab& lab) {
    writeTwoColouredSky(lab);
    const Precision precision = usualPrecision(lab);
    const double truth = oracle::solveSlab({.layers = {{4, 1, 0}}}, {1}).above.reflectance[0];
    for (const double voxel : {1e5, 1e6, 1e7}) {
        writeSlab(lab, "wide.vdb", even.weights, voxel);
        const std::string name =
            fmt::format("reflectance of a slab {:g} times as wide as high", voxel * 16 / 5);
        Case c = caseOf(
            name, truth,
            evenPicture(
                lab, name,
                sceneIn(lab, "[[volume]]\nfile = \"wide.vdb\"\nscale = 4\nalbedo = 1\ng = 0\n" +
                                 std::string(twoColouredSky) + cameraAbove(1)),
                precision, {0})[0],
            precision);
        c.allowance += 3e-6 + horizonAllowance;
        lab.add(c);
    }
}

/// White-sky albedo and transmittance: 2 mu times the above over mu, by Gauss-Legendre.
Estimate whiteSky(const Lab& lab, Parameters p, const Precision& precision, Part part) {
    double mean = 0, variance = 0;
    const oracle::Quadrature rule = oracle::gaussLegendre(8);
    for (std::size_t i = 0; i < rule.nodes.size(); ++i) {
        p.mu = rule.nodes[i];
        const Estimate e = measure(lab, p, precision, part);
        const double weight = 2 * p.mu * rule.weights[i];
        mean += weight * e.mean;
        variance += weight * e.error * weight * e.error;
    }
    return {mean, std::sqrt(variance)};
}

/// Published numbers that are not of beams along the normal.
void diffuseLight(Lab& lab) {
    writeProfiles(lab);
    const Precision precision = dearPrecision(lab);
    for (const oracle::PublishedRadiance& r : oracle::disortRadiances) {
        Case c = caseOf(fmt::format("radiance at mu {} of depth 32, albedo 0.99", r.mu), r.radiance,
                        measure(lab, {0, 32, 0.99, r.mu}, precision, Part::Reflected), precision);
        c.allowance += 5e-7 + horizonAllowance, c.note = "DISORT 1f";
        lab.add(c);
    }
    Case flux =
        caseOf("flux back from depth 32, albedo 0.99, over pi", oracle::disortReflectedFlux / pi,
               whiteSky(lab, {0, 32, 0.99, 0}, precision, Part::Reflected), precision);
    flux.allowance += 2e-6 + horizonAllowance, flux.note = "DISORT 1f";
    lab.add(flux);
    for (const oracle::PublishedTransmittance& t : oracle::conservativeSlabs) {
        if (!lab.full() && t.opticalDepth != 1) continue;  // eight pictures each
        Case c =
            caseOf(fmt::format("diffuse light through depth {}, albedo 1", t.opticalDepth),
                   t.whiteSkyTransmittance,
                   whiteSky(lab, {0, t.opticalDepth, 1, 0, layered}, precision, Part::Transmitted),
                   precision);
        // Eight angles miss 1e-4 at most of what grazing light does to thin slabs.
        c.allowance += 5e-7 + horizonAllowance + (t.opticalDepth < 1 ? 1e-4 : 1e-5);
        c.note = "Heaslet and Warming 1965";
        c.curve = "diffuse transmittance, albedo 1", c.xName = "optical depth",
        c.x = t.opticalDepth;
        lab.add(c);
    }
}

/// A half-space reflects 1 - sqrt(1 - albedo) H(mu), of which the rest is what it would emit
/// (Kirchhoff): Chandrasekhar's H, measured.
void halfSpace(Lab& lab) {
    const Precision precision = usualPrecision(lab);
    writeSlab(lab, "even.vdb", even.weights);
    for (const auto& [albedo, mu] : {std::pair{0.2, 1.0},
                                     {0.5, 1.0},
                                     {0.8, 0.5},
                                     {0.9, 1.0},
                                     {0.95, 0.2},
                                     {0.99, 1.0},
                                     {0.999, 0.5}}) {
        const std::string name = fmt::format("half-space of albedo {}, mu {}", albedo, mu);
        const RgbEstimate e = evenPicture(
            lab, name,
            sceneIn(lab, slabVolume({0, 2000, albedo, mu}) +
                             "[[light]]\ntype = \"environment\"\nradiance = 1\n" + cameraAbove(mu)),
            precision, {0});
        Case c = caseOf(name, oracle::halfSpaceAlbedo(albedo, mu), e[0], precision);
        c.note = "1 - sqrt(1 - albedo) H(mu)";
        lab.add(c);
    }
}

/// From below, light comes through a deep conservative slab as Milne's problem says, and fades in
/// an absorbing one with Case's diffusion length.
void deep(Lab& lab) {
    writeProfiles(lab);
    const Precision precision{lab.pick(3e-2, 3e-3), 1e-7};
    const auto through = [&](double depth, double albedo, double mu) {
        return measure(lab, {0, depth, albedo, mu}, precision, Part::Transmitted);
    };
    const auto ratio = [](Estimate a, Estimate b) {
        const double mean = a.mean / b.mean;
        return Estimate{mean, mean * std::hypot(a.error / a.mean, b.error / b.mean)};
    };
    const Precision ofRatio{2 * precision.relative, 0};
    const Estimate straight = through(30, 1, 1);
    for (const double mu : {0.2, 0.5})
        lab.add(caseOf(fmt::format("limb darkening at mu {}", mu), oracle::milneLimbDarkening(mu),
                       ratio(through(30, 1, mu), straight), ofRatio));
    const double length = oracle::caseEigenvalue(0.95);
    Case fade =
        caseOf("diffusion length, albedo 0.95: depth 12 over depth 8", std::exp(-4 / length),
               ratio(through(12, 0.95, 1), through(8, 0.95, 1)), ofRatio);
    fade.allowance += 1e-3 * fade.expected;
    fade.note = "the faces' own light has died to 1e-3";
    lab.add(fade);
}

}  // namespace

std::vector<Check> slabs() {
    return {{Kind::Slab, "table of slabs", table},
            {Kind::Slab, "beyond the tables", beyondTheTables},
            {Kind::Slab, "chromatic slabs", chromatic},
            {Kind::Slab, "stacked slabs", stacks},
            {Kind::Slab, "width of slabs", width},
            {Kind::Slab, "diffuse light", diffuseLight},
            {Kind::Slab, "half-spaces", halfSpace},
            {Kind::Slab, "deep slabs", deep}};
}

}  // namespace woodcock::proof
