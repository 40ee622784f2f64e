// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "woodcock/render/session.h"
#include "woodcock/trade/timing.h"

namespace woodcock::trade {

/// A need of the path loop: a member of Needs for which it has code of its own.
enum class Need {
    Chromatic,
    Scattering,
    Emission,
    LightSampling,
    LocalLights,
    Surfaces,
};
inline const std::array<std::string, 6> needNames{
    "three colour channels", "scattering",           "emission",
    "light sampling",        "equiangular sampling", "surfaces"};

bool has(const render::Needs& needs, Need need);

/// The scene, rendered as if it had a need that it does not have: the same picture up to noise, by
/// more general code. Grey media have three equal channels, and a scene without surfaces has an
/// empty set of them.
render::Scene forceNeed(render::Scene scene, Need need);

/// Whether radiance and alpha of two films of equal size agree to the last bit.
bool sameBits(const image::Film& a, const image::Film& b);

/// The cost of a feature for a scene that does not need it.
struct NeedCost {
    Need need{};
    bool needed = false;  ///< then there is nothing to compare, and the rest is empty
    /// Processor seconds of one sample of every pixel: with the need forced, and as the scene is;
    /// and the median of the ratios of neighbouring runs.
    Measured with{}, without{}, ratio{};
    /// Median of the ratios of the variances of a sample: some general code is also noisier.
    Measured variance{};
    int pairs = 0;          ///< of runs
    bool sameBits = false;  ///< all pictures were the same to the last bit
    Measured difference{};  ///< of the means of the pictures, relative

    /// Time x variance with the need over that without: the ratio of times to the same noise.
    Measured cost() const;
    /// A specialisation is worth its code where the general code costs a tenth more.
    static constexpr double leastRatio = 1.1;
    bool earns() const { return cost().value >= leastRatio; }
};

struct NeedsCostOptions {
    double budget = 60;       ///< seconds for all needs together
    double precision = 0.01;  ///< of a ratio: its standard error to stop at
    std::function<void(const NeedCost&)> onResult = {};
};

/// Measures every need. A small picture is rendered by one thread, in pairs of runs with and
/// without the need, alternately and with the same random numbers. Throws Error{Usage} where the
/// budget is too small for three pairs of each need.
std::vector<NeedCost> needsCost(const render::Scene& scene, render::RenderSettings settings,
                                const NeedsCostOptions& options);

}  // namespace woodcock::trade
