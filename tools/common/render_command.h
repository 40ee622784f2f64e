// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "tools/common/scene_input.h"
#include "woodcock/trade/candidates.h"

namespace woodcock::tool {

/// Samples per pixel of renders that a time limit or the noise ends.
inline constexpr int endlessSamples = 1000000;

/// A word as the shell takes it, quoted where it must be.
std::string shellWord(const std::string& word);

/// What a candidate adds to a command: " --quality draft --set render.clamp=10".
std::string optionsOf(const trade::Candidate& candidate);

/// Commands to copy: "woodcock render scene.toml --set ... -o scene.exr".
class RenderCommand {
public:
    /// Repeats what `input` says. `namesOutput`: the scene does not, so that -o must.
    RenderCommand(const SceneInput& input, bool namesOutput);

    std::string of(const trade::Candidate& candidate) const;
    /// The same, for so many samples per pixel.
    std::string ofSamples(const trade::Candidate& candidate, double samples) const;
    /// The same, for so many seconds.
    std::string ofSeconds(const trade::Candidate& candidate, double seconds) const;

private:
    std::string start_, sets_, end_;
};

}  // namespace woodcock::tool
