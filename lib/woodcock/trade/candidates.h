// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "woodcock/render/scene.h"
#include "woodcock/scene/description.h"

namespace woodcock::trade {

/// A way to render a scene: changes to what its file says.
struct Candidate {
    std::string name;
    std::string quality;               ///< as of --quality; empty: what the scene says
    std::vector<std::string> choices;  ///< KEY=VALUE, as of --set

    /// All of its changes, as for --set.
    std::vector<std::string> overrides() const;
    /// The source of its choices; empty for built-in candidates.
    std::string papers() const;
};

/// Facts of a scene that decide which choices have an effect.
struct SceneFacts {
    bool grids = false;  ///< media that are looked up
    bool scattering = false;
    int mostScatterings = 0;    ///< that the scene allows
    double largestG = 0;        ///< of |g|
    bool dielectrics = false;   ///< that shadow rays meet
    bool cameraInside = false;  ///< the media's box
    double meanRadiance = 0;    ///< of the picture, roughly
    bool denoiser = false;      ///< there is one
};
/// The facts, but for the mean radiance, of a complete description and its scene.
SceneFacts sceneFacts(const scene::SceneDescription& description, const render::Scene& scene);

/// Every choice in a few strengths; or the most promising choices in one strength, for short
/// budgets.
enum class Extent { All, Few };
/// The scene as it is, each choice by itself, and the qualities.
std::vector<Candidate> builtInCandidates(const SceneFacts& facts, Extent extent);

/// The candidates of a TOML file: [[candidate]] name = "...", quality = "...", set =
/// ["render.clamp=10"]. Throws Error{Input} on a key that candidates may not set, on two candidates
/// of one name, and on a file without candidates.
std::vector<Candidate> readCandidates(const std::filesystem::path& file);

/// The scene with more overrides.
using ParseScene =
    std::function<scene::SceneDescription(const std::vector<std::string>& overrides)>;

/// A candidate and the scene that it renders.
struct ResolvedCandidate {
    Candidate candidate;
    scene::SceneDescription scene;
};
/// Applies each candidate to `complete` (see completeScene), which `parse` gives without overrides.
/// `strict`, for a user's candidates: throws Error{Input} where a candidate contradicts itself or
/// the scene, or two are equal. Otherwise such candidates are left out.
std::vector<ResolvedCandidate> resolveCandidates(const std::vector<Candidate>& candidates,
                                                 const scene::SceneDescription& complete,
                                                 const ParseScene& parse, bool strict);

/// `complete` with the choices of `parsed`.
scene::SceneDescription withChoices(const scene::SceneDescription& complete,
                                    const scene::SceneDescription& parsed);

}  // namespace woodcock::trade
