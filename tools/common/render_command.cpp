// SPDX-License-Identifier: Apache-2.0
#include "tools/common/render_command.h"

#include <fmt/core.h>

namespace woodcock::tool {

std::string shellWord(const std::string& word) {
    if (!word.empty() && word.find_first_of(" \t\n'\"\\$&|;<>()*?{}`#~!") == std::string::npos)
        return word;
    std::string text = "'";
    for (const char c : word) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return text + "'";
}

RenderCommand::RenderCommand(const SceneInput& input, bool namesOutput)
    : start_("woodcock render") {
    for (const auto& file : input.files) start_ += " " + shellWord(file.string());
    if (input.overlay) start_ += " --overlay";
    if (namesOutput) end_ = " -o " + shellWord(input.files.front().stem().string() + ".exr");
    if (input.size) {
        start_ += fmt::format(" --res {}", input.size->width);
        if (input.size->height) start_ += fmt::format("x{}", *input.size->height);
    }
    for (const std::string& set : input.overrides) sets_ += " --set " + shellWord(set);
}

std::string optionsOf(const trade::Candidate& candidate) {
    std::string text;
    if (!candidate.quality.empty()) text += " --quality " + candidate.quality;
    for (const std::string& choice : candidate.choices) text += " --set " + shellWord(choice);
    return text;
}

std::string RenderCommand::of(const trade::Candidate& candidate) const {
    return start_ + sets_ + optionsOf(candidate) + end_;
}

std::string RenderCommand::ofSamples(const trade::Candidate& candidate, double samples) const {
    return fmt::format("{} --spp {:.0f}", of(candidate), samples);
}

std::string RenderCommand::ofSeconds(const trade::Candidate& candidate, double seconds) const {
    return fmt::format("{} --spp {} --time-limit {:g}", of(candidate), endlessSamples, seconds);
}

}  // namespace woodcock::tool
