// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "woodcock/base/vec.h"
#include "woodcock/proof/proof.h"
#include "woodcock/proof/support/render_scene.h"

namespace woodcock::proof {

/// The wanted standard error of a mean: relative to it, but not below `floor`.
struct Precision {
    double relative, floor;
    double of(double value) const;
};
/// Two digits quickly. In full three, of numbers below 0.001 one in 200 000 of the whole.
Precision usualPrecision(const Lab& lab);
/// A quarter of that effort in full, for cases that would take hours.
Precision dearPrecision(const Lab& lab);

/// The scene of a text, with files in the lab's directory.
render::Scene sceneIn(const Lab& lab, const std::string& text);

/// A picture of a scene whose pixels all have one expectation (see pencilCamera), with as many
/// samples as needed. `excess` returns how many times larger than wanted a film's error is. A film
/// that is too noisy tells the number of samples and is discarded, so that no result decides its
/// own number of samples.
image::Film evenFilm(const Lab& lab, const std::string& name, const render::Scene& scene,
                     Picture picture, const std::function<double(const image::Film&)>& excess);

/// The radiance of such a picture, per channel, to the wanted precision of the channels in use.
RgbEstimate evenPicture(const Lab& lab, const std::string& name, const render::Scene& scene,
                        const Precision& precision, std::vector<int> channels = {0, 1, 2},
                        std::optional<int> maxScatterings = {});

/// Fills measured and standardError.
Case caseOf(std::string name, double expected, Estimate measured, const Precision& precision);

/// Writes sky.exr: red above the horizon (+y), blue below, green where `green`. The horizon is
/// smeared over a row of 1/2048 of half a circle, which holds 1e-6 of a face's flux.
void writeTwoColouredSky(const Lab& lab);
inline constexpr const char* twoColouredSky =
    "[[light]]\ntype = \"environment\"\nimage = \"sky.exr\"\n";
inline constexpr double horizonAllowance = 2e-6;

/// Writes a slab of voxels across y, 1 high each and as wide as infinite, with vertical optical
/// depth 1 where scale is 1. Layers are in proportion to `weights`, from the lowest; the linear
/// ramps of half a unit beyond the outer voxels belong to it.
void writeSlab(const Lab& lab, const std::string& file, const std::vector<double>& weights,
               double width = 1e6);

/// A camera all of whose rays look down at the slab at this cosine to its normal.
std::string cameraAbove(double mu);

}  // namespace woodcock::proof
