// SPDX-License-Identifier: Apache-2.0
// Grids of the optical depth to suns and lamps: whatever they hold, the mean is right.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "woodcock/base/random.h"
#include "woodcock/base/statistics.h"
#include "woodcock/medium/corrected_transmittance.h"
#include "woodcock/medium/tracking.h"
#include "woodcock/proof/checks/measure.h"
#include "woodcock/proof/checks/subjects.h"
#include "woodcock/proof/support/plain_medium.h"
#include "woodcock/proof/support/small_pictures.h"

namespace woodcock::proof {

namespace {

/// Two overlapping parts of rough grids, unlike in colour.
PlainMedium clouds(double density, Vec3d shift) {
    const Affine3d placed = Affine3d::translate(shift) * Affine3d::rotate(1, 25);
    return PlainMedium({{.grid = mixedGrid(2),
                         .worldFromIndex = placed * Affine3d::scale({0.5, 0.4, 0.5}),
                         .absorption = Rgb(static_cast<float>(0.1 * density)),
                         .scattering = Rgb(static_cast<float>(0.2 * density))},
                        {.grid = mixedGrid(5),
                         .worldFromIndex = placed * Affine3d::rotate(0, 50),
                         .absorption = Rgb{0.01f, 0.05f, 0.2f} * static_cast<float>(density),
                         .scattering = Rgb(0.05f) * static_cast<float>(density)}});
}

/// What a grid is made of that is to be wrong.
struct Wrong {
    const char* what;
    double density;
    Vec3d shift;
};
constexpr Wrong kinds[]{{"right", 1, {}},
                        {"of half the density", 0.5, {}},
                        {"of thrice the density", 3, {}},
                        {"moved by some voxels", 1, {1.3, -0.9, 2.1}}};

/// The transmittance from points within, to a sun or to a lamp, by brute force.
void transmittances(Lab& lab, bool toLamp) {
    const PlainMedium plain = clouds(1, {});
    const medium::Medium right = plain.medium();
    const Vec3d sun = normalize(Vec3d{0.4, 0.8, -0.3});
    const Box3d box = right.worldBounds();
    const Vec3d lamp = box.centre() + sun * (0.7 * length(box.size()));
    RandomStream places(lab.seed("places"));
    for (const Wrong& wrong : kinds) {
        const medium::Medium other = clouds(wrong.density, wrong.shift).medium();
        const auto grid =
            toLamp ? medium::DepthGrid::makeForLamp(other, lamp + wrong.shift, 0, 1 << 24)
                   : medium::DepthGrid::make(other, sun, 1 << 24);
        Moments excess[3];  // over what is expected, of all places
        double expected[3]{};
        constexpr int count = 40;
        for (int place = 0; place < count; ++place) {
            const Vec3d from = box.lower + box.size() * Vec3d{places.uniform(), places.uniform(),
                                                              places.uniform()};
            const Vec3d towards = toLamp ? normalize(lamp - from) : sun;
            const Vec3d exact = plain.transmittance(from, towards, 2 * length(box.size()));
            RandomStream random(lab.seed(fmt::format("{} {}", wrong.what, place)));
            medium::TrackingCounters counters;
            for (int i = 0; i < lab.pick(500, 20000); ++i) {
                const Rgb t = medium::correctedTransmittance<3>(right, *grid, from, towards,
                                                                Rgb(0.1f), random, counters);
                for (int c = 0; c < 3; ++c) excess[c].add(double{t[c]} - exact[c]);
            }
            for (int c = 0; c < 3; ++c) expected[c] += exact[c] / count;
        }
        for (int c = 0; c < 3; ++c) {
            Case one =
                caseOf(fmt::format("transmittance to a {} by a grid that is {}, channel {}",
                                   toLamp ? "lamp" : "sun", wrong.what, c),
                       expected[c], {expected[c] + excess[c].mean(), excess[c].standardError()},
                       {lab.pick(2e-2, 3e-3), 0});
            one.allowance = 1e-6;
            one.note = "brute force";
            lab.add(one);
        }
    }
}

struct Subject {
    const char* name;
    double thickness, g;
    bool surfaces;
    int effort;  ///< one over it, against the others'
    bool lamps = false;
};
/// In thick clouds, several next events are drawn near the light.
constexpr Subject subjects[]{{"of fog", 1, 0.5, false, 1},
                             {"with surfaces", 1, 0.5, true, 1},
                             {"of a thick cloud", 20, 0.85, false, 9},
                             {"of fog by lamps", 1, 0.5, false, 1, true},
                             {"with surfaces by lamps", 1, 0.5, true, 1, true},
                             {"of a thick cloud by lamps", 20, 0.85, false, 9, true}};

/// Fog under a delta sun and a disc, or under a spot and a sphere; with surfaces above a floor and
/// around a ball of glass and a bubble. The disc is wide there: paths meet it through the glass by
/// chance alone.
std::string foggyScene(const Subject& subject, double density, double shift) {
    const char* const solid =
        "[[material]]\nname = \"glass\"\ntype = \"dielectric\"\nior = 1.4\n"
        "[[surface]]\nmaterial = \"glass\"\n"
        "sphere = { centre = [0.4, 0.5, 0.5], radius = 0.4 }\n"
        "[[material]]\nname = \"skin\"\ntype = \"interface\"\n"
        "[[surface]]\nmaterial = \"skin\"\n"
        "sphere = { centre = [-0.5, 0.5, 0.2], radius = 0.5 }\n"
        "[[surface]]\nplane = {}\ntransform = { translate = [0, -1, 0] }\n";
    const std::string suns = fmt::format(
        "[[light]]\ntype = \"sun\"\ndirection = [0.5, -1, -0.3]\nirradiance = [2, 1, 1]\n"
        "[[light]]\ntype = \"sun\"\ndirection = [-0.2, -1, 0.3]\nirradiance = [0.5, 1, 2]\n"
        "angular_diameter = {}\n",
        subject.surfaces ? 10 : 0.5);
    const char* const lamps =
        "[[light]]\ntype = \"spot\"\nposition = [-1, 3, 1]\nlook_at = [0, 0, 0]\n"
        "intensity = [20, 10, 10]\ncone = 70\n"
        "[[light]]\ntype = \"sphere\"\nposition = [2.5, 2, -1]\nradius = 0.4\n"
        "radiance = [5, 10, 20]\n";
    return fmt::format(
        "[[volume]]\nbox = {{ min = [{1}, -1, -1], max = [{2}, 1.2, 1] }}\n"
        "sigma_a = [{3}, {4}, {5}]\nsigma_s = {6}\ng = {8}\n"
        "[[volume]]\nbox = {{ min = [-0.5, -0.2, -2], max = [0.4, 0.9, 0.3] }}\n"
        "transform = {{ translate = [{0}, 0, 0], rotate = [0, 30, 10] }}\nsigma_s = {6}\n"
        "{9}"
        "[camera]\neye = [0, 0.5, 5]\nlook_at = [0, 0, 0]\nfov = 30\n{7}",
        shift, -1 + shift, 1 + shift, 0.2 * density, 0.5 * density, density,
        1.5 * density * subject.thickness, subject.surfaces ? solid : "", subject.g,
        subject.lamps ? lamps : suns);
}

/// Mean radiance of a small picture by so many seeds.
/// Pictures by right and by wrong grids against shadow rays that are tracked.
void comparePictures(Lab& lab) {
    for (const Subject& subject : subjects) {
        const render::Scene scene = sceneIn(lab, foggyScene(subject, 1, 0));
        const int seeds = lab.pick(800, 12000) / subject.effort;
        const auto tracked = meansOf(scene, {}, lab.seed("tracked"), seeds).radiance;
        for (const Wrong& wrong : kinds) {
            const render::Scene other = sceneIn(
                lab, foggyScene(subject, wrong.density, wrong.shift.x / (4 * subject.thickness)));
            const render::LightDepths depths(other, {}, render::ApproximateMedia(other, {}));
            const std::string name =
                fmt::format("picture {} by a grid that is {}", subject.name, wrong.what);
            const auto means =
                meansOf(scene, {.lightDepths = &depths}, lab.seed(name), seeds).radiance;
            for (std::size_t c = 0; c < 3; ++c) {
                const double error =
                    std::hypot(means[c].standardError(), tracked[c].standardError());
                Case one = caseOf(fmt::format("{}, channel {}", name, c), tracked[c].mean(),
                                  {means[c].mean(), error},
                                  {lab.pick(6e-2, 1.5e-2) * std::sqrt(subject.effort), 0});
                one.note = "by tracked shadow rays";
                lab.add(one);
            }
        }
    }
}

}  // namespace

std::vector<Check> lightDepths() {
    return {{Kind::Sampling, "transmittance by grids of depths",
             [](Lab& lab) { transmittances(lab, false), transmittances(lab, true); }},
            {Kind::Sampling, "pictures by grids of depths", comparePictures}};
}

}  // namespace woodcock::proof
