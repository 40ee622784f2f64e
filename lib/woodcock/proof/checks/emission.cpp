// SPDX-License-Identifier: Apache-2.0
// Media that emit: along straight lines, from a half-space of uniform temperature, and in thermal
// equilibrium, where nothing can be seen.
#include <fmt/format.h>

#include <cmath>

#include "woodcock/proof/checks/measure.h"
#include "woodcock/proof/checks/slab_kinds.h"
#include "woodcock/proof/checks/subjects.h"
#include "woodcock/proof/checks/volume.h"
#include "woodcock/proof/oracles/chandrasekhar.h"

namespace woodcock::proof {

namespace {

constexpr const char* dark = "[[light]]\ntype = \"environment\"\nradiance = 0\n";

/// Emission and absorption in proportion, whatever their profile:
/// L = j / sigma_a (1 - exp(-sigma_a l)), and j l where nothing absorbs.
void alongLines(Lab& lab) {
    slab::write(lab);
    const Precision precision{lab.pick(1e-2, 2e-3), 0};
    for (const char* kind : slab::kinds)
        for (const double mu : {1.0, 0.2})
            for (const double depth : {0.0, 1.0, 20.0}) {
                const std::string name =
                    fmt::format("glow of {} of depth {}, mu {}", slab::nameOf(kind), depth, mu);
                const double sigma[]{depth, depth / 4, depth / 20};
                const RgbEstimate e =
                    evenPicture(lab, name,
                                sceneIn(lab, fmt::format("[[volume]]\n{}sigma_a = [{}, {}, {}]\n"
                                                         "emission = [1, 2, 4]\n",
                                                         kind, sigma[0], sigma[1], sigma[2]) +
                                                 dark + cameraAbove(mu)),
                                precision);
                for (std::size_t c = 0; c < 3; ++c) {
                    const double j = std::array{1, 2, 4}[c], along = sigma[c] / mu;
                    const double expected = along > 0 ? j / sigma[c] * -std::expm1(-along) : j / mu;
                    Case one =
                        caseOf(fmt::format("{}, channel {}", name, c), expected, e[c], precision);
                    one.allowance += expected * 1e-5;  // voxels of a slab, as floats
                    lab.add(std::move(one));
                }
            }
}

constexpr const char* materials =
    "[[material]]\nname = \"interface\"\ntype = \"interface\"\n"
    "[[material]]\nname = \"glass\"\ntype = \"dielectric\"\nior = 1.5\n";

void addColours(Lab& lab, const std::string& name, const std::array<double, 3>& expected,
                const RgbEstimate& e, const Precision& precision, double allowance = 1e-5) {
    for (std::size_t c = 0; c < 3; ++c) {
        Case one = caseOf(fmt::format("{}, channel {}", name, c), expected[c], e[c], precision);
        one.allowance += expected[c] * allowance;
        lab.add(std::move(one));
    }
}

/// Media inside surfaces emit as the same media without them: along chords of a ball, and where a
/// surface cuts a volume in two (the part outside is left out).
void insideSurfaces(Lab& lab) {
    slab::write(lab);
    const Precision precision{lab.pick(1e-2, 2e-3), 0};
    const std::array<double, 3> sigma{0, 0.7, 5}, q{1, 2, 4};
    const auto glow = [&](double length) {
        std::array<double, 3> light{};
        for (std::size_t c = 0; c < 3; ++c)
            light[c] =
                sigma[c] > 0 ? q[c] / sigma[c] * -std::expm1(-sigma[c] * length) : q[c] * length;
        return light;
    };
    for (const double aside : {0.0, 0.5, 0.9}) {
        const std::string name = fmt::format("a glowing ball, {} off its middle", aside);
        const RgbEstimate e = evenPicture(
            lab, name,
            sceneIn(lab, std::string(materials) +
                             "[[surface]]\nsphere = {}\nmaterial = \"interface\"\n"
                             "medium = { sigma_a = [0, 0.7, 5], emission = [1, 2, 4] }\n" +
                             dark + pencilCamera({aside, 0, 9}, {0, 0, -1})),
            precision);
        addColours(lab, name, glow(2 * std::sqrt(1 - aside * aside)), e, precision);
    }
    for (const double mu : {1.0, 0.2}) {
        const std::string name = fmt::format("half a slab inside a surface, mu {}", mu);
        // The slab lies about y = 1.5.
        const RgbEstimate e =
            evenPicture(lab, name,
                        sceneIn(lab, std::string(materials) +
                                         "[[surface]]\nname = \"half\"\nmaterial = \"interface\"\n"
                                         "box = { min = [-1e6, -9, -1e6], max = [1e6, 1.5, 1e6] }\n"
                                         "[[volume]]\n" +
                                         slab::even + "inside = \"half\"\nsigma_a = [0, 0.7, 5]\n" +
                                         "emission = [1, 2, 4]\n" + dark + cameraAbove(mu)),
                        precision);
        addColours(lab, name, glow(0.5 / mu), e, precision);
    }
    // In glass as well, where radiance changes at the surface: n^2 B inside is B outside.
    const RgbEstimate e = evenPicture(
        lab, "thermal equilibrium in glass",
        sceneIn(lab, std::string(materials) +
                         "[[surface]]\nsphere = {}\nmaterial = \"glass\"\nmedium = { sigma_a = "
                         "[0.2, 1, 5], sigma_s = [3, 1, 0.5], emission = [0.45, 2.25, 11.25] }\n"
                         "[[light]]\ntype = \"environment\"\n" +
                         pencilCamera({0.4, 0.3, 9}, {0, 0, -1})),
        precision);
    addColours(lab, "thermal equilibrium in glass", {1, 1, 1}, e, precision);
}

/// A box that scatters, absorbs and emits is the same inside an interface as without it.
void insideAndAlone(Lab& lab) {
    const Precision precision = usualPrecision(lab);
    const std::string lights =
        std::string(dark) +
        "[[light]]\ntype = \"sphere\"\nposition = [0.2, 0.1, 0]\nradius = 0.1\nradiance = 3\n" +
        pencilCamera({3, 1, 2}, {-3, -1.2, -2.1});
    const RgbEstimate inside = evenPicture(
        lab, "a glowing fog inside",
        sceneIn(lab, std::string(materials) +
                         "[[surface]]\nmaterial = \"interface\"\nbox = { min = [-1, -1, -1], max "
                         "= [1, 1, 1] }\nmedium = { sigma_a = [0.3, 0.1, 0], sigma_s = [0.5, 1, "
                         "2], g = 0.4, emission = [1, 0.5, 0.25] }\n" +
                         lights),
        precision);
    const RgbEstimate alone =
        evenPicture(lab, "a glowing fog alone",
                    sceneIn(lab,
                            "[[volume]]\nbox = { min = [-1, -1, -1], max = [1, 1, 1] }\n"
                            "sigma_a = [0.3, 0.1, 0]\nsigma_s = [0.5, 1, 2]\ng = 0.4\n"
                            "emission = [1, 0.5, 0.25]\n" +
                                lights),
                    precision);
    for (std::size_t c = 0; c < 3; ++c) {
        const double ratio = inside[c].mean / alone[c].mean;
        const double error =
            ratio * std::hypot(inside[c].error / inside[c].mean, alone[c].error / alone[c].mean);
        lab.add(
            caseOf(fmt::format("glowing fog in an interface over the same alone, channel {}", c), 1,
                   {ratio, error}, {1.6 * precision.relative, 0}));
    }
}

/// Kirchhoff: a half-space at the temperature of a black body of radiance 1 emits sqrt(1 - albedo)
/// H(mu).
void warmHalfSpace(Lab& lab) {
    slab::write(lab);
    const Precision precision = usualPrecision(lab);
    for (const auto& [albedo, mu] : {std::pair{0.2, 1.0}, {0.5, 0.5}, {0.8, 0.2}, {0.95, 1.0}}) {
        const std::string name = fmt::format("warm half-space of albedo {}, mu {}", albedo, mu);
        constexpr double depth = 60;  // as good as infinite: 20 diffusion lengths
        const RgbEstimate e = evenPicture(
            lab, name,
            sceneIn(lab, fmt::format("[[volume]]\n{}scale = {}\nalbedo = {}\nemission = {}\n",
                                     slab::even, depth, albedo, depth * (1 - albedo)) +
                             dark + cameraAbove(mu)),
            precision, {0});
        Case c = caseOf(name, oracle::halfSpaceEmissivity(albedo, mu), e[0], precision);
        c.note = "sqrt(1 - albedo) H(mu)";
        c.allowance += 1e-5;
        lab.add(std::move(c));
    }
}

/// j = sigma_a B in an environment of B: every ray sees B, whatever the scattering.
void equilibrium(Lab& lab) {
    slab::write(lab);
    const Precision precision{lab.pick(1e-2, 2e-3), 0};
    const double black[]{0.5, 1, 2};
    for (const char* kind : slab::kinds)
        for (const double g : {-0.5, 0.0, 0.9})
            for (const bool coloured : {false, true}) {
                const double a[]{1.0, coloured ? 0.3 : 1.0, coloured ? 3.0 : 1.0};
                const double s[]{2.0, coloured ? 4.0 : 2.0, coloured ? 0.5 : 2.0};
                const std::string name =
                    fmt::format("thermal equilibrium, {}, g {}{}", slab::nameOf(kind), g,
                                coloured ? ", by colour" : "");
                const RgbEstimate e = evenPicture(
                    lab, name,
                    sceneIn(lab,
                            fmt::format("[[volume]]\n{}sigma_a = [{}, {}, {}]\n"
                                        "sigma_s = [{}, {}, {}]\nemission = [{}, {}, {}]\ng = {}\n"
                                        "[[light]]\ntype = \"environment\"\n"
                                        "radiance = [{}, {}, {}]\n",
                                        kind, a[0], a[1], a[2], s[0], s[1], s[2], a[0] * black[0],
                                        a[1] * black[1], a[2] * black[2], g, black[0], black[1],
                                        black[2]) +
                                cameraAbove(0.7)),
                    precision);
                for (std::size_t c = 0; c < 3; ++c) {
                    Case one =
                        caseOf(fmt::format("{}, channel {}", name, c), black[c], e[c], precision);
                    one.allowance += black[c] * 1e-6;
                    lab.add(std::move(one));
                }
            }
}

/// The same of any volume, seen from within.
void equilibriumOfVolumes(Lab& lab) {
    const Precision precision{lab.pick(1e-2, 2e-3), 0};
    const Rgb black(0.5f, 1, 2), absorbed(0.2f, 0.5f, 1), scattered(1, 0.5f, 0.1f);
    for (const Volume& v : volumes(lab, Endless::Not)) {
        medium::EmissionPart::Description glow;
        glow.field = v.field;
        glow.worldFromIndex = v.worldFromIndex;
        glow.scale = absorbed * black * static_cast<float>(v.sigma);
        const std::string name = fmt::format("thermal equilibrium, {}", v.name);
        const Vec3d eye = v.matter[0];
        const RgbEstimate e = evenPicture(
            lab, name,
            {{{v.part(absorbed, scattered, 0.5)}, {medium::EmissionPart(std::move(glow))}},
             light::LightSet({light::Environment(black, true)}),
             camera::Camera::perspective(eye, eye + Vec3d{1, 0.2, -0.5}, {0, 1, 0}, 100)},
            precision);
        addColours(lab, name, {0.5, 1, 2}, e, precision, 1e-6);
    }
}

}  // namespace

std::vector<Check> emission() {
    return {{Kind::ClosedForm, "glow along a line", alongLines},
            {Kind::ClosedForm, "glow inside surfaces", insideSurfaces},
            {Kind::Property, "glow inside a surface and without it", insideAndAlone},
            {Kind::Slab, "warm half-spaces", warmHalfSpace},
            {Kind::Property, "thermal equilibrium", equilibrium},
            {Kind::Property, "thermal equilibrium of any volume", equilibriumOfVolumes}};
}

}  // namespace woodcock::proof
