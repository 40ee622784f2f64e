// SPDX-License-Identifier: Apache-2.0
// Pictures whose every pixel is known by theory, or that two scenes must share.
#include <fmt/format.h>

#include "woodcock/proof/checks/measure.h"
#include "woodcock/proof/checks/properties.h"
#include "woodcock/proof/checks/volume.h"

namespace woodcock::proof {

namespace {

/// A camera that sees the whole volume.
camera::Camera framing(const Volume& v) {
    const Vec3d direction = normalize(Vec3d{1, 0.7, 1.3});
    return camera::Camera::perspective(v.centre() + direction * (3 * v.radius()), v.centre(),
                                       {0, 1, 0}, 40);
}

// ---- white furnace --------------------------------------------------------------------------

light::Environment imageOfOnes() {
    return {light::EnvironmentMap(8, 4, std::vector<float>(8 * 4 * 3, 1)), Rgb(1.0f), {}, true};
}

/// A volume that scatters without loss is invisible in uniform light.
void furnace(Lab& lab) {
    const Precision precision{lab.pick(1e-2, 1e-3), 0};
    const light::Environment constant(Rgb(1.0f), true), image = imageOfOnes();
    for (const Volume& v : volumes(lab, Endless::Not)) {
        const Vec3d inside = v.matter[0];
        const camera::Camera around =
            camera::Camera::perspective(inside, inside + Vec3d{1, 0.2, -0.5}, {0, 1, 0}, 100);
        const medium::MediumPart white = v.part(Rgb(0.0f), Rgb(1.0f), 0.5);
        double furthest = 0;
        for (const camera::Camera& camera : {around, framing(v)}) {
            const image::Film film = renderScene({{{white}}, light::LightSet({constant}), camera},
                                                 {16, 16, lab.pick(2, 32), lab.seed(v.name)})
                                         .film;
            for (int y = 0; y < 16; ++y)
                for (int x = 0; x < 16; ++x)
                    furthest = std::max(furthest, std::abs(double{film.radiance(x, y)[1]} - 1));
        }
        lab.add({.name = "white furnace, the pixel furthest off, " + v.name, .measured = furthest});

        const auto addEven = [&](const std::string& what, const render::Scene& scene) {
            const std::string name = fmt::format("white furnace, {}, {}", what, v.name);
            const RgbEstimate e = evenPicture(lab, name, scene, precision);
            for (int c = 0; c < 3; ++c)
                lab.add(caseOf(fmt::format("{}, channel {}", name, c), 1,
                               e[static_cast<std::size_t>(c)], precision));
        };
        addEven("light as an image", {{{white}}, light::LightSet({image}), around});
        medium::MediumPart::Description turned =
            v.part(Rgb(0.0f), {0.1f, 0.5f, 0.9f}, -0.3).description();
        turned.worldFromIndex = Affine3d::translate(inside) * Affine3d::rotate(0, 70) *
                                Affine3d::rotate(2, 20) * Affine3d::scale({0.8, -1.1, 0.6}) *
                                Affine3d::translate(-inside) * turned.worldFromIndex;
        addEven("coloured pair",
                {{{v.part(Rgb(0.0f), {1, 0.6f, 0.3f}, 0.8), medium::MediumPart(turned)}},
                 light::LightSet({constant}),
                 around});
    }
}

// ---- equal scenes ---------------------------------------------------------------------------

/// A volume in sun and uniform light, seen along one line through its matter: two scenes can
/// describe it in different ways.
struct Setting {
    Vec3d through, view, up{0, 1, 0}, sun;
    double distance;

    /// After a similarity.
    Setting moved(const Affine3d& m) const {
        return {m.point(through), m.vector(view), m.vector(up), m.vector(sun), distance};
    }
    render::Scene scene(std::vector<medium::MediumPart> parts) const {
        const Vec3d eye = through - view * distance;
        return {{std::move(parts)},
                light::LightSet(
                    {light::Sun(sun, Rgb(4.0f), 0, false), light::Environment(Rgb(0.5f), true)}),
                camera::Camera::orthographic(eye, through, up, distance * 1e-12)};
    }
};

render::Scene withMajorants(const render::Scene& scene, double scale, int smallestLog2) {
    return withParts(scene, [&](medium::MediumPart::Description& d) {
        d.majorantScale = scale, d.majorantSmallestLog2 = smallestLog2;
    });
}

medium::MediumPart placed(const medium::MediumPart& part, const Affine3d& m, float density) {
    medium::MediumPart::Description d = part.description();
    d.worldFromIndex = m * d.worldFromIndex;
    d.absorption *= density, d.scattering *= density;
    return medium::MediumPart(d);
}

void equalScenes(Lab& lab) {
    const Precision precision{lab.pick(2e-2, 4e-3), 0};
    for (const Volume& v : volumes(lab, Endless::Not)) {
        const Setting setting{
            v.matter[1], normalize(Vec3d{-1, -0.5, 0.3}), {0, 1, 0}, {1, -2, 0.5}, 3 * v.radius()};
        const medium::MediumPart grey = v.part(Rgb(0.1f), Rgb(0.9f), 0.4),
                                 coloured = v.part({0.01f, 0.1f, 0.3f}, {1, 0.8f, 0.5f}, 0.4);
        /// A scene of a grey medium or of a coloured one, with its first and last channel.
        struct Told {
            render::Scene scene;
            std::vector<int> channels;
        };
        const auto tell = [](const Setting& at, std::vector<medium::MediumPart> parts) {
            const bool chromatic = parts[0].chromatic();
            return Told{at.scene(std::move(parts)), chromatic ? std::vector{0, 2} : std::vector{0}};
        };
        const auto picture = [&](const std::string& name, const Told& told) {
            return evenPicture(lab, fmt::format("{}, {}", name, v.name), told.scene,
                               {0.6 * precision.relative, 0}, told.channels);
        };
        const Told plainGrey = tell(setting, {grey}), plainColoured = tell(setting, {coloured});
        const RgbEstimate greyTruth = picture("grey", plainGrey),
                          colouredTruth = picture("coloured", plainColoured);
        const auto add = [&](const std::string& name, const Told& told) {
            const RgbEstimate e = picture(name, told);
            for (const int channel : told.channels) {
                const auto c = static_cast<std::size_t>(channel);
                const Estimate& truth = (told.channels.size() == 1 ? greyTruth : colouredTruth)[c];
                Case welch = caseOf(fmt::format("{}, channel {}, {}", name, c, v.name), truth.mean,
                                    {e[c].mean, std::hypot(e[c].error, truth.error)}, precision);
                welch.note = "expected: the same scene told plainly";
                lab.add(std::move(welch));
            }
        };
        const auto addMajorants = [&](const std::string& name, const Told& plain, double scale,
                                      int smallestLog2) {
            add(name, {withMajorants(plain.scene, scale, smallestLog2), plain.channels});
        };
        addMajorants("majorants x 2", plainGrey, 2, 1);
        addMajorants("majorants x 8", plainGrey, 8, 1);
        addMajorants("coarse majorants", plainGrey, 1, 6);
        addMajorants("coarse majorants x 2, coloured", plainColoured, 2, 4);
        const medium::MediumPart half = placed(coloured, {}, 0.5f);
        add("two halves", tell(setting, {half, half}));

        const double far = 1e5 * v.radius();
        const Affine3d away = Affine3d::translate({far, -far, far});
        add("far from the origin", tell(setting.moved(away), {placed(grey, away, 1)}));
        const Affine3d turn = Affine3d::translate(setting.through) * Affine3d::rotate(2, 25) *
                              Affine3d::rotate(0, 50) * Affine3d::rotate(1, 80) *
                              Affine3d::translate(-setting.through);
        add("turned with its lights and camera",
            tell(setting.moved(turn), {placed(coloured, turn, 1)}));
        constexpr double k = 1000;
        Setting larger = setting.moved(Affine3d::scale({k, k, k}));
        larger.view = setting.view, larger.distance *= k;
        add("a thousand times larger and thinner",
            tell(larger, {placed(grey, Affine3d::scale({k, k, k}), 1 / float{k})}));
    }
}

// ---- reciprocity ----------------------------------------------------------------------------

/// The light that leaves along `out`, of parallel light that comes along `in`: radiance over the
/// whole visible area, in units of the pictured square.
RgbEstimate turnedAside(const Lab& lab, const std::string& name, const Volume& v,
                        const medium::MediumPart& part, Vec3d in, Vec3d out, double relative) {
    const double size = 2.001 * v.radius();
    const Vec3d up = std::abs(out.y) < 0.9 ? Vec3d{0, 1, 0} : Vec3d{1, 0, 0};
    const render::Scene scene{
        {{part}},
        light::LightSet({light::Sun(in, Rgb(1.0f), 0, false)}),
        camera::Camera::orthographic(v.centre() + out * size, v.centre(), up, size)};
    const int seeds = lab.pick(32, 64);
    constexpr int firstSeeds = 16;
    Picture picture{24, 24, 1, hashOf(lab.seed(name), 0)};
    const RgbEstimate first = meanOverSeeds(scene, picture, firstSeeds);
    double samples = 1;
    for (const Estimate& e : first) {
        const double ratio = 1.3 * e.error / (relative * e.mean);
        samples = std::max(samples, ratio * ratio * firstSeeds / seeds);
    }
    picture.samples = static_cast<int>(std::min(samples, 1e4));
    picture.seed = hashOf(lab.seed(name), 1);
    return meanOverSeeds(scene, picture, seeds);
}

/// Reciprocity: sun and view change places.
void reciprocity(Lab& lab) {
    const Precision precision{lab.pick(3e-2, 5e-3), 0};
    for (const Volume& v : volumes(lab, Endless::Not)) {
        if (v.name == "far apart") continue;  // it covers hardly a pixel
        const medium::MediumPart part = v.part({0.01f, 0.1f, 0.3f}, {1, 0.8f, 0.5f}, 0.6);
        RandomStream random(lab.seed("reciprocity, " + v.name));
        for (int i = 0; i < lab.pick(1, 3); ++i) {
            const std::string name = fmt::format("reciprocity {}, {}", i + 1, v.name);
            const Vec3d a = anyDirection(random), b = anyDirection(random);
            const double relative = 0.6 * precision.relative;
            const RgbEstimate there = turnedAside(lab, name + ", there", v, part, a, -b, relative),
                              back = turnedAside(lab, name + ", back", v, part, b, -a, relative);
            for (std::size_t c = 0; c < 3; ++c)
                lab.add(caseOf(fmt::format("{}, channel {}", name, c), there[c].mean,
                               {back[c].mean, std::hypot(there[c].error, back[c].error)},
                               precision));
        }
    }
}

}  // namespace

std::vector<Check> propertiesOfPictures() {
    return {{Kind::Property, "white furnace", furnace},
            {Kind::Property, "equal scenes", equalScenes},
            {Kind::Property, "reciprocity", reciprocity}};
}

}  // namespace woodcock::proof
