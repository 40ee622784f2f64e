// SPDX-License-Identifier: Apache-2.0
#include "woodcock/proof/checks/stills.h"

#include <cmath>

#include "woodcock/scene/animation.h"
#include "woodcock/scene/build.h"
#include "woodcock/scene/scene_file.h"

namespace woodcock::proof {

Case asStillPictures(const Lab& lab, const std::string& name, const std::string& text,
                     const Precision& precision) {
    const Picture picture{.samples = lab.pick(64, 512), .seed = lab.seed(name)};
    const auto redOf = [](const image::Film& film) { return meanRadiance(film, 0); };
    const Estimate moving = meanOverSeeds(sceneIn(lab, text), picture, 16, redOf);
    scene::SceneDescription description = scene::parseSceneText(text, name, lab.directory());
    // Two of each time: their differences tell the noise, which motion does not scatter.
    double still = 0, variance = 0;
    const int frames = lab.pick(64, 512);
    for (int i = 0; i < frames; ++i) {
        scene::SceneDescription there = scene::atFrame(description, (i + 0.5) / frames - 0.5);
        there.camera.shutter = {};
        const render::Scene built = scene::buildScene(there, scene::loadScene(there));
        double red[2];
        for (std::uint64_t k = 0; k < 2; ++k) {
            Picture one = picture;
            one.samples = 16;
            one.seed = lab.seed(name + " still") + 2 * static_cast<std::uint64_t>(i) + k;
            red[k] = redOf(renderScene(built, one).film);
        }
        still += (red[0] + red[1]) / 2 / frames;
        variance += (red[0] - red[1]) * (red[0] - red[1]) / 4 / (double(frames) * frames);
    }
    Case c = caseOf(name, still, {moving.mean, std::sqrt(moving.error * moving.error + variance)},
                    precision);
    c.note = "expected: the mean of still pictures";
    return c;
}

}  // namespace woodcock::proof
