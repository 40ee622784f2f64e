// SPDX-License-Identifier: Apache-2.0
// Each kind of phase function against its paper's formula, and slabs of some against their
// Legendre moments by adding-doubling.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "woodcock/base/random.h"
#include "woodcock/medium/phase.h"
#include "woodcock/proof/checks/cells.h"
#include "woodcock/proof/checks/measure.h"
#include "woodcock/proof/checks/subjects.h"
#include "woodcock/proof/oracles/adding_doubling.h"
#include "woodcock/proof/oracles/closed_forms.h"
#include "woodcock/proof/oracles/phase_functions.h"
#include "woodcock/proof/oracles/published_phase_functions.h"
#include "woodcock/proof/support/read_back.h"
#include "woodcock/proof/support/sky.h"
#include "woodcock/proof/support/write_vdb.h"

namespace woodcock::proof {

namespace {

using medium::PhaseFunction;
using Density = std::function<double(double cosine)>;

/// A table of densities at cosines that lie evenly in angle; each column integrates to 1.
medium::PhaseTable tableOf(const std::vector<Density>& densities, int rows) {
    medium::PhaseTable::Columns columns;
    for (int i = 0; i <= rows; ++i)
        columns.cosines.push_back(i == 0 ? -1 : i == rows ? 1 : -std::cos(pi * i / rows));
    for (const Density& density : densities) {
        columns.densities.emplace_back();
        for (const double c : columns.cosines)
            columns.densities.back().push_back(std::max(0.0, density(c)));
    }
    return medium::PhaseTable(columns, true);
}

Density seriesOf(const std::vector<double>& moments) {
    return [&](double c) { return oracle::legendreSeries(c, moments); };
}
Density henyeyGreenstein(double g) {
    return [=](double c) { return oracle::henyeyGreenstein(c, g); };
}

struct PhaseCase {
    std::string name;
    PhaseFunction phase;
    Density density;
    std::vector<double> kinks = {};
    double beside = 1e-9;  ///< relative difference of value and oracle that rounding makes
    double peak = 0;       ///< 1 - cos within which the oracle's digits do not suffice
    double pole = 0;       ///< 1 - cos where it divides nothing by nothing; 0: nowhere
};

/// Straight lines between few rows, one of which is empty.
const std::vector<double> coarseCosines{-1, -0.7, -0.2, 0.1, 0.6, 0.95, 1};
const std::vector<std::vector<double>> coarseDensities{{0.2, 0, 0, 0.05, 0.1, 0.3, 2},
                                                       {0, 0.1, 0.1, 0.1, 0.1, 0.05, 0},
                                                       {1, 0.1, 0, 0, 0.02, 0.2, 0.1}};

/// The straight lines of a column, over their integral.
Density linesOf(const std::vector<double>& densities) {
    const std::vector<double>& c = coarseCosines;
    double integral = 0;
    for (std::size_t i = 0; i + 1 < c.size(); ++i)
        integral += 2 * pi * (c[i + 1] - c[i]) * (densities[i] + densities[i + 1]) / 2;
    return [=](double x) {
        std::size_t i = 0;
        while (i + 2 < coarseCosines.size() && x > coarseCosines[i + 1]) ++i;
        const double a = coarseCosines[i], b = coarseCosines[i + 1];
        return (densities[i] * (b - x) + densities[i + 1] * (x - a)) / (b - a) / integral;
    };
}

PhaseFunction colouredTable() { return medium::PhaseTable({coarseCosines, coarseDensities}, true); }

std::vector<PhaseCase> kindsOfPhase() {
    std::vector<PhaseCase> list{{"isotropic", {}, [](double) { return 1 / (4 * pi); }},
                                {"Rayleigh", medium::Rayleigh(), oracle::rayleigh}};
    for (const auto& [g, g2, mix] :
         {std::array{0.8, -0.4, 0.3}, {0.99, -0.95, 0.5}, {0.5, 0.0, 1.0}})
        list.push_back({fmt::format("two lobes of g {} and {}, mix {}", g, g2, mix),
                        medium::TwoLobes(g, g2, mix),
                        [=](double c) { return oracle::twoLobes(c, g, g2, mix); }});
    for (const auto& [g, a] : {std::pair{0.5, 1.0},
                               {0.8, 20.0},
                               {-0.7, 3.0},
                               {0.0, 1.0},
                               {0.99, 0.1},
                               {1e-7, 50.0},
                               {-0.3, 0.0}})
        list.push_back({fmt::format("Draine of g {}, alpha {}", g, a), medium::Draine(g, a),
                        [=](double c) { return oracle::draine(c, g, a); }});
    for (const double d : {5.0, 20.0, 50.0})
        list.push_back({fmt::format("Mie of {} micrometres", d),
                        medium::MieDroplets(d),
                        [=](double c) { return oracle::mieDroplets(c, d); },
                        {},
                        1e-8});
    for (const auto& [ior, b] : {std::pair{1.33, 0.1}, {1.05, 0.0183}, {1.15, 0.3}})
        list.push_back({fmt::format("Fournier-Forand of ior {}, backscatter {}", ior, b),
                        medium::FournierForand(ior, b),
                        [=](double c) {
                            return oracle::fournierForand(2 * std::asin(std::sqrt((1 - c) / 2)),
                                                          ior, b);
                        },
                        {},
                        1e-6,
                        1e-9,
                        1.5 * (ior - 1) * (ior - 1)});
    list.push_back({"a coarse table",
                    medium::PhaseTable({coarseCosines, {coarseDensities[0]}}, true),
                    linesOf(coarseDensities[0]), coarseCosines});
    list.push_back({"a table of three colours", colouredTable(),
                    [](double c) {
                        double sum = 0;
                        for (const auto& column : coarseDensities) sum += linesOf(column)(c);
                        return sum / 3;
                    },
                    coarseCosines});
    return list;
}

const Vec3d forward = normalize(Vec3d{0.3, -0.5, -0.7});

void eachKind(Lab& lab) {
    const int n = lab.pick(20000, 500000);
    for (const PhaseCase& k : kindsOfPhase()) {
        const oracle::TurnDistribution exact(k.density, k.kinks);
        const oracle::TurnDistribution own([&](double c) { return k.phase.value(c); }, k.kinks);
        RandomStream random(lab.seed("kind of phase function, " + k.name));
        Cells cells(20, 8);
        Moments cosine;
        double sampled = 0, evaluated = 0;
        for (int i = 0; i < n; ++i) {
            const medium::PhaseSample s =
                k.phase.sample(forward, random.uniform(), random.uniform());
            const double c = 1 - below(s.direction, forward);
            cells.add(std::min(exact(c), 1 - 1e-12), turn(forward, s.direction));
            cosine.add(c);
            const double rounding = 1e-15 / std::max(1 - c, 1e-15);
            sampled = std::max(sampled, std::abs(k.phase.value(c) / s.pdf - 1) - rounding);
            const bool known = 1 - c > k.peak && std::abs((1 - c) - k.pole) > 1e-3 * k.pole;
            if (known)
                evaluated =
                    std::max(evaluated, std::abs(k.phase.value(c) / k.density(c) - 1) - rounding);
        }
        const double peak = k.peak > 0 ? 1e-4 : 0;  // of what scatters straight on
        lab.add(cells.asCase("directions, " + k.name));
        lab.add(meanCase("mean cosine of samples, " + k.name, exact.meanCosine(), cosine,
                         lab.pick(1e-2, 2e-3)));
        lab.add(exactCase("mean cosine, " + k.name, exact.meanCosine(), k.phase.meanCosine(),
                          1e-9 + peak));
        lab.add(exactCase("integral over the sphere, " + k.name, 1, own.total(), 1e-9 + peak));
        lab.add(exactCase("largest difference of sampled and evaluated density, " + k.name, 0,
                          sampled, k.beside));
        lab.add(exactCase("largest difference from the paper's formula, " + k.name, 0, evaluated,
                          k.beside));
    }
}

/// Samples for paths whose channels count unequally: the density, and each channel by its weights.
void colours(Lab& lab) {
    const int n = lab.pick(50000, 500000);
    const PhaseFunction phase = colouredTable();
    for (const Rgb throughput : {Rgb(1.0f), Rgb(0.2f, 1, 0.5f), Rgb(0, 0.01f, 1), Rgb(1, 0, 0)}) {
        const std::string name = fmt::format("colours of throughput {}, {}, {}", throughput[0],
                                             throughput[1], throughput[2]);
        const double sum = double{throughput[0]} + throughput[1] + throughput[2];
        std::vector<Density> channels;
        for (const auto& column : coarseDensities) channels.push_back(linesOf(column));
        const oracle::TurnDistribution exact(
            [&](double c) {
                double density = 0;
                for (int i = 0; i < 3; ++i)
                    density += double{throughput[i]} * channels[static_cast<std::size_t>(i)](c);
                return density / sum;
            },
            coarseCosines);
        RandomStream random(lab.seed(name));
        Cells cells(20, 8);
        Moments weight[3], cosine[3];
        double worst = 0;
        for (int i = 0; i < n; ++i) {
            const medium::PhaseSample s =
                phase.sampleMixed(forward, throughput, random.uniform(), random.uniform());
            const double c = dot(s.direction, forward);
            const PhaseFunction::Mixed mixed = phase.mixed(c, throughput);
            cells.add(std::min(exact(c), 1 - 1e-12), turn(forward, s.direction));
            worst = std::max(worst, std::abs(mixed.density / s.pdf - 1));
            for (int channel = 0; channel < 3; ++channel) {
                weight[channel].add(double{throughput[channel] * mixed.weight[channel]});
                cosine[channel].add(double{throughput[channel] * mixed.weight[channel]} * c);
            }
        }
        lab.add(cells.asCase("directions, " + name));
        lab.add(exactCase("largest difference of densities, " + name, 0, worst, 1e-5,
                          "densities of channels are floats"));
        for (std::size_t i = 0; i < 3; ++i) {
            const double carried = throughput[static_cast<int>(i)];
            if (carried == 0) continue;
            const oracle::TurnDistribution own(channels[i], coarseCosines);
            lab.add(meanCase(fmt::format("weight of channel {}, {}", i, name), carried, weight[i],
                             0.02));
            lab.add(meanCase(fmt::format("mean cosine of channel {}, {}", i, name),
                             carried * own.meanCosine(), cosine[i], 0.02));
        }
    }
}

render::Scene withPhase(const render::Scene& scene, const PhaseFunction& phase) {
    return withParts(scene, [&](medium::MediumPart::Description& d) { d.phase = phase; });
}

/// In light that is the same from everywhere, a cloud that absorbs nothing cannot be seen.
void furnaces(Lab& lab) {
    writeFloats(lab.file("even.exr"), 4, 2, 3, std::vector<float>(4 * 2 * 3, 1.0f));
    const render::Scene scene =
        sceneIn(lab,
                "[[volume]]\nbox = { min = [-1, -1, -1], max = [1, 1, 1] }\nsigma_a = 0\n"
                "sigma_s = [1.5, 1.4, 1.6]\n[[light]]\ntype = \"environment\"\nimage = "
                "\"even.exr\"\n" +
                    pencilCamera({0.2, 0.1, 5}, {0, 0, -1}));
    const Precision precision = dearPrecision(lab);
    for (const PhaseFunction& phase : std::vector<PhaseFunction>{
             medium::TwoLobes(0.8, -0.4, 0.3), medium::Rayleigh(), medium::Draine(0.6, 5),
             medium::MieDroplets(10), medium::FournierForand(1.1, 0.05), colouredTable()}) {
        const std::string name = fmt::format("furnace, {}", phase.name());
        const RgbEstimate e = evenPicture(lab, name, withPhase(scene, phase), precision);
        for (std::size_t c = 0; c < 3; ++c)
            lab.add(caseOf(fmt::format("{}, channel {}", name, c), 1, e[c], precision));
    }
}

/// A table with a column for each colour, in light of every kind, against each colour by itself.
void coloursApart(Lab& lab) {
    writeTwoColouredSky(lab);
    const std::string lights =
        "[[light]]\ntype = \"environment\"\nimage = \"sky.exr\"\n"
        "[[light]]\ntype = \"environment\"\nradiance = 0.3\n"
        "[[light]]\ntype = \"sun\"\ndirection = [1, -2, -0.5]\nirradiance = 2\n"
        "angular_diameter = 20\n"
        "[[light]]\ntype = \"point\"\nposition = [0.5, 1.5, 0.3]\nintensity = 2\n"
        "[[light]]\ntype = \"sphere\"\nposition = [-2, 0, 1]\nradius = 0.5\nradiance = 3\n";
    const render::Scene scene =
        sceneIn(lab,
                "[[volume]]\nbox = { min = [-1, -1, -1], max = [1, 1, 1] }\nsigma_a = 0.2\n"
                "sigma_s = 1.2\n" +
                    lights + pencilCamera({0.2, 0.1, 5}, {0, 0, -1}));
    const Precision precision = dearPrecision(lab);
    const std::vector<double> g{0.7, 0, -0.5};
    const RgbEstimate together = evenPicture(
        lab, "colours together",
        withPhase(scene,
                  tableOf({henyeyGreenstein(g[0]), henyeyGreenstein(g[1]), henyeyGreenstein(g[2])},
                          2000)),
        precision);
    for (std::size_t c = 0; c < 3; ++c) {
        const std::string name = fmt::format("channel {} of a table against g {}", c, g[c]);
        const Estimate apart =
            evenPicture(lab, name, withPhase(scene, medium::HenyeyGreenstein(g[c])), precision)[c];
        Case both =
            caseOf(name, apart.mean, {together[c].mean, std::hypot(together[c].error, apart.error)},
                   {2 * precision.relative, precision.floor});
        both.allowance += 1e-5, both.note = "straight lines between 2000 rows";
        lab.add(std::move(both));
    }
}

// ---- slabs --------------------------------------------------------------------------------------

struct Scatterer {
    std::string name;
    PhaseFunction phase;
    std::vector<double> moments;
    std::size_t nodes = 64;
};

Scatterer ofMoments(const std::string& name, const std::vector<double>& moments,
                    std::size_t nodes = 64) {
    return {name, tableOf({seriesOf(moments)}, 4000), moments, nodes};
}
Scatterer ofDensity(const std::string& name, const PhaseFunction& phase, const Density& density,
                    std::size_t moments, std::size_t nodes = 64) {
    return {name, phase, oracle::legendreMoments(density, moments), nodes};
}

void addSlab(Lab& lab, const std::string& name, const PhaseFunction& phase, double depth,
             double albedo, double mu, double reflected, double transmitted, double allowance,
             const std::string& source) {
    const Precision precision = dearPrecision(lab);
    const render::Scene scene = withPhase(
        sceneIn(lab, fmt::format("[[volume]]\nfile = \"slab.vdb\"\nscale = {}\nalbedo = {}\n",
                                 depth, albedo) +
                         twoColouredSky + cameraAbove(mu)),
        phase);
    const RgbEstimate e = evenPicture(lab, name, scene, precision, {0, 2});
    for (const auto& [what, expected, channel] :
         {std::tuple{"reflectance", reflected, 0}, {"transmittance", transmitted, 2}}) {
        Case c = caseOf(fmt::format("{}, {}", what, name), expected,
                        e[static_cast<std::size_t>(channel)], precision);
        c.allowance += allowance + horizonAllowance, c.note = source;
        lab.add(std::move(c));
    }
}

/// DISORT's own answers for Rayleigh scattering, haze and, in full, cloud.
void publishedSlabs(Lab& lab) {
    writeTwoColouredSky(lab);
    writeSlab(lab, "slab.vdb", {1, 2, 1, 3});
    for (const oracle::PublishedFlux& f : oracle::disortFluxes) {
        if (!lab.full() && f.opticalDepth > 10) continue;  // hundreds of scatterings
        const PhaseFunction phase = &f.moments == &oracle::rayleighMoments
                                        ? PhaseFunction(medium::Rayleigh())
                                        : tableOf({seriesOf(f.moments)}, 4000);
        addSlab(lab, f.name, phase, f.opticalDepth, f.albedo, f.mu, f.up / f.beam, f.down / f.beam,
                1e-4, "DISORT");
    }
}

void slabsOfMoments(Lab& lab) {
    writeTwoColouredSky(lab);
    writeSlab(lab, "slab.vdb", {1, 2, 1, 3});
    struct Row {
        Scatterer scatterer;
        double depth, albedo, mu;
    };
    std::vector<double> lobes;
    for (int l = 0; l < 100; ++l) lobes.push_back(0.7 * std::pow(0.8, l) + 0.3 * std::pow(-0.4, l));
    const auto draine = [](double c) { return oracle::draine(c, 0.6, 5); };
    const auto mie = [](double c) { return oracle::mieDroplets(c, 5); };
    for (const Row& r : std::vector<Row>{
             {{"two lobes", medium::TwoLobes(0.8, -0.4, 0.3), lobes}, 2, 0.9, 0.7},
             {{"Rayleigh", medium::Rayleigh(), oracle::rayleighMoments}, 1, 1, 0.5},
             {ofDensity("Draine", medium::Draine(0.6, 5), draine, 120), 4, 0.95, 1},
             {ofDensity("Mie, 5 micrometres", medium::MieDroplets(5), mie, 300, 150), 4, 0.99, 0.8},
             {ofMoments("Haze L", oracle::hazeL), 3, 0.99, 0.6},
             {ofMoments("Cloud C.1", oracle::cloudC1, 150), 4, 0.99, 1}}) {
        const oracle::Face face =
            oracle::solveSlab({.layers = {{r.depth, r.albedo, 0, r.scatterer.moments}}}, {r.mu},
                              r.scatterer.nodes)
                .above;
        const std::string name = fmt::format("{}, depth {}, albedo {}, mu {}", r.scatterer.name,
                                             r.depth, r.albedo, r.mu);
        addSlab(lab, name, r.scatterer.phase, r.depth, r.albedo, r.mu, face.reflectance[0],
                face.transmittance[0], 2e-5, "adding-doubling");
    }
}

}  // namespace

std::vector<Check> phaseFunctions() {
    return {{Kind::Slab, "slabs of other phase functions, published", publishedSlabs},
            {Kind::Slab, "slabs of other phase functions", slabsOfMoments},
            {Kind::Property, "furnaces of each phase function", furnaces},
            {Kind::Property, "phase functions of three colours", coloursApart},
            {Kind::Sampling, "kinds of phase functions", eachKind},
            {Kind::Sampling, "phase functions by colour", colours}};
}

}  // namespace woodcock::proof
