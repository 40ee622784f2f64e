// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "woodcock/render/scene.h"
#include "woodcock/scene/description.h"

namespace woodcock {

/// A way to render a scene: changes to what its file says.
struct Candidate {
    std::string name;
    std::string quality;               ///< as of --quality; empty: what the scene says
    std::vector<std::string> choices;  ///< KEY=VALUE, as of --set

    /// All of it as for --set.
    std::vector<std::string> overrides() const;
    /// Where its choices come from; empty where nobody wrote it down.
    std::string papers() const;
};

/// What decides which choices mean something.
struct SceneFacts {
    bool grids = false;  ///< media that are looked up
    bool scattering = false;
    int mostScatterings = 0;    ///< that the scene allows
    double largestG = 0;        ///< of |g|
    bool dielectrics = false;   ///< that shadow rays meet
    bool cameraInside = false;  ///< the media's box
    double meanRadiance = 0;    ///< of the picture, roughly
};
/// All but the mean radiance, of a complete description and the scene that it gives.
SceneFacts sceneFacts(const SceneDescription& description, const Scene& scene);

/// Every choice in a few strengths, or the most promising ones in one, where time is short.
enum class Extent { All, Few };
/// The scene as it is, each choice by itself, and the qualities.
std::vector<Candidate> builtInCandidates(const SceneFacts& facts, Extent extent);

/// Those of a TOML file: [[candidate]] name = "...", quality = "...", set = ["render.clamp=10"].
/// Throws Error{Input} on what cannot be compared: a key that is no choice, two of one name, none.
std::vector<Candidate> readCandidates(const std::filesystem::path& file);

/// The scene with so many more overrides.
using ParseScene = std::function<SceneDescription(const std::vector<std::string>& overrides)>;

/// A candidate and the scene that it draws.
struct ResolvedCandidate {
    Candidate candidate;
    SceneDescription scene;
};
/// Applies each candidate to `complete` (see completeScene), which `parse` gives without overrides.
/// `strict`, for those of a user: throws Error{Input} where a candidate contradicts itself or the
/// scene, or two come to the same; otherwise these are left out.
std::vector<ResolvedCandidate> resolveCandidates(const std::vector<Candidate>& candidates,
                                                 const SceneDescription& complete,
                                                 const ParseScene& parse, bool strict);

/// `complete` with the choices of `parsed`.
SceneDescription withChoices(const SceneDescription& complete, const SceneDescription& parsed);

}  // namespace woodcock
