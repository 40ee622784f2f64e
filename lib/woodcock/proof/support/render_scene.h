// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "woodcock/proof/support/estimate.h"
#include "woodcock/render/session.h"

namespace woodcock::proof {

/// Parses, loads and builds the scene of a text whose relative paths start in `directory`.
render::Scene sceneFrom(const std::string& text, const std::filesystem::path& directory = ".");

/// `scene` with each part of its medium made anew from an edited description.
render::Scene withParts(const render::Scene& scene,
                        const std::function<void(medium::MediumPart::Description&)>& edit);

struct Picture {
    int width = 8, height = 8, samples = 16;
    std::uint64_t seed = 0;
    std::optional<int> maxScatterings{};
    bool depthLayers = false, featureLayers = false;
};

/// From here on, whether renderScene() samples adaptively, with twice the samples, as proofs set
/// them for the errors of even ones: a proof of what does is one of that.
void sampleAdaptively(bool adaptive);

/// Renders; throws where a sample was NaN or infinite.
render::RenderResult renderScene(const render::Scene& scene, const Picture& picture);

/// Of pixels that all expect the same radiance (or alpha): their mean, with the error that their
/// scatter tells. The samples of one pixel are not independent, pixels are.
RgbEstimate evenRadiance(const image::Film& film);
Estimate evenAlpha(const image::Film& film);
RgbEstimate evenTransmittance(const image::Film& film);  ///< of the layer

/// Mean of the whole picture (or of any function of the film) over renders with different seeds,
/// picture.seed and following, with the error that their scatter tells.
RgbEstimate meanOverSeeds(const render::Scene& scene, Picture picture, int seeds);
Estimate meanOverSeeds(const render::Scene& scene, Picture picture, int seeds,
                       const std::function<double(const image::Film&)>& measure);
double meanRadiance(const image::Film& film, int channel);

/// An orthographic [camera] that sends all rays of the picture along one and the same line.
std::string pencilCamera(Vec3d eye, Vec3d direction);

}  // namespace woodcock::proof
