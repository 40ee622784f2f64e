// SPDX-License-Identifier: Apache-2.0
// Films must not depend on threads, ranges of samples, or the unit of length.
#include <cmath>
#include <cstring>

#include "woodcock/proof/checks/properties.h"
#include "woodcock/proof/checks/volume.h"
#include "woodcock/render/session.h"

namespace woodcock::proof {

namespace {

/// Sun, sky and a point light in the volume; all lengths in units of 1 / k.
render::Scene sceneOf(const Volume& v, double k) {
    medium::MediumPart::Description d =
        v.part({0.01f, 0.1f, 0.5f}, {1, 0.8f, 0.2f}, 0.4).description();
    d.worldFromIndex = Affine3d::scale({k, k, k}) * d.worldFromIndex;
    d.absorption *= static_cast<float>(1 / k), d.scattering *= static_cast<float>(1 / k);
    const double r = v.radius() * k;
    const Vec3d centre = v.centre() * k;
    const auto intensity = static_cast<float>(r * r);
    return {{{medium::MediumPart(d)}},
            light::LightSet({light::Sun({1, -2, 0.5}, Rgb(4.0f), 5, false),
                             light::Environment(Rgb(0.5f), true),
                             light::PointLight{v.matter[2] * k, Rgb(intensity)}}),
            camera::Camera::perspective(centre + Vec3d{1, 0.5, 2} * r, centre, {0, 1, 0}, 50)};
}

render::RenderSettings settings(const Lab& lab) {
    render::RenderSettings s;
    s.width = 20, s.height = 16;
    s.endSample = lab.pick(3, 40);
    s.seed = lab.seed("films");
    s.layers.depth = true;
    return s;
}

/// The number of pixels for which `differs` is true.
int countPixels(
    const image::Film& a, const image::Film& b,
    const std::function<bool(const image::Film::Pixel&, const image::Film::Pixel&)>& differs) {
    int count = 0;
    for (int y = 0; y < a.height(); ++y)
        for (int x = 0; x < a.width(); ++x) count += differs(a.at(x, y), b.at(x, y));
    return count;
}

bool otherBits(const image::Film::Pixel& a, const image::Film::Pixel& b) {
    return std::memcmp(&a, &b, sizeof a) != 0;
}

/// Beyond the last place of a float, in any of the sums.
bool otherFloats(const image::Film::Pixel& a, const image::Film::Pixel& b) {
    const auto differ = [](double x, double y) {
        const auto f = static_cast<float>(x);
        return std::abs(f - static_cast<float>(y)) >
               std::nextafter(std::abs(f), std::numeric_limits<float>::infinity()) - std::abs(f);
    };
    bool any = a.samples != b.samples || a.depthSamples != b.depthSamples ||
               differ(a.alpha, b.alpha) || differ(a.weightedDepth, b.weightedDepth) ||
               differ(a.depthWeight, b.depthWeight);
    for (int c = 0; c < 3; ++c)
        any |= differ(a.radiance[c], b.radiance[c]) ||
               differ(a.radianceSquared[c], b.radianceSquared[c]) ||
               differ(a.transmittance[c], b.transmittance[c]);
    return any;
}

/// The same sums, but for the unit of a depth.
bool otherRadiance(const image::Film::Pixel& a, const image::Film::Pixel& b) {
    return std::memcmp(a.radiance, b.radiance, sizeof a.radiance) != 0 || a.alpha != b.alpha;
}

void films(Lab& lab) {
    for (const Volume& v : volumes(lab, Endless::Too)) {
        const render::Scene scene = sceneOf(v, 1);
        render::RenderSettings s = settings(lab);
        s.threads = 1;
        const image::Film whole = render::render(scene, s).film;
        const auto add = [&](const std::string& what, int pixels) {
            lab.add({.name = "pixels that show " + what + ", " + v.name,
                     .measured = static_cast<double>(pixels)});
        };
        for (const int threads : {2, 5}) {
            s.threads = threads;
            add(std::to_string(threads) + " threads",
                countPixels(whole, render::render(scene, s).film, otherBits));
        }
        render::RenderSettings first = s, second = s;
        first.endSample = second.firstSample = s.endSample / 3;
        image::Film merged = render::render(scene, first).film;
        merged.merge(render::render(scene, second).film);
        add("two ranges of samples", countPixels(whole, merged, otherFloats));
        // Powers of two round nothing.
        for (const double k : {0x1p20, 0x1p-30})
            add(k > 1 ? "a scale of 2^20" : "a scale of 2^-30",
                countPixels(whole, render::render(sceneOf(v, k), s).film, otherRadiance));
    }
}

}  // namespace

std::vector<Check> propertiesOfFilms() { return {{Kind::Property, "what no film shows", films}}; }

}  // namespace woodcock::proof
