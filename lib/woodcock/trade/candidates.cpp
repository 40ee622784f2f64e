// SPDX-License-Identifier: Apache-2.0
#include "woodcock/trade/candidates.h"

#include <algorithm>
#include <set>

#include "woodcock/base/nearest_name.h"
#include "woodcock/base/toml_reader.h"
#include "woodcock/scene/overrides.h"
#include "woodcock/scene/quality.h"

namespace woodcock::trade {
namespace {

/// Keys that a candidate may set beside volume[N].storage: those that concern how a picture is
/// rendered, not what it shows.
std::vector<std::string> allowedKeys() {
    std::vector<std::string> keys;
    for (const std::string& key : scene::choiceKeys())
        if (key != "quality") keys.push_back("render." + key);
    for (const std::string& key : scene::methodKeys()) keys.push_back("render." + key);
    return keys;
}

bool isVolumeStorage(const std::string& key) {
    return key.starts_with("volume[") && key.ends_with("].storage");
}

void checkKey(const TomlValue& value, const std::string& text) {
    const std::string key = scene::overriddenKey(text);
    if (text.find('=') == std::string::npos)
        throw value.error("is '{}'; expected KEY=VALUE, such as \"render.clamp=10\"", text);
    if (key == "render.quality")
        throw value.error("sets the quality; write quality = \"...\" instead");
    const std::vector<std::string> allowed = allowedKeys();
    if (isVolumeStorage(key) || std::find(allowed.begin(), allowed.end(), key) != allowed.end())
        return;
    throw value.error(
        "sets '{}', which changes the picture: candidates must render the same picture by other "
        "means{}",
        key, suggestName(key, "known", allowed));
}

Candidate readCandidate(const TomlTable& table) {
    table.allowOnly({"name", "quality", "set"}, "[[candidate]]");
    Candidate candidate;
    candidate.name = table.need("name", "name = \"fast\"").text();
    if (const auto quality = table.find("quality"))
        candidate.quality = scene::qualityNames[quality->choice("quality", scene::qualityNames)];
    std::set<std::string> keys;
    if (const auto set = table.find("set"))
        for (const TomlValue& value : set->elements("a list, such as [\"render.clamp=10\"]")) {
            const std::string text = value.text();
            checkKey(value, text);
            if (!keys.insert(scene::overriddenKey(text)).second)
                throw value.error("sets '{}' again", scene::overriddenKey(text));
            candidate.choices.push_back(text);
        }
    return candidate;
}

/// What a candidate renders, without its source.
scene::SceneDescription content(scene::SceneDescription scene) {
    scene.places.clear();
    return scene;
}

}  // namespace

std::vector<std::string> Candidate::overrides() const {
    std::vector<std::string> all;
    if (!quality.empty()) all.push_back("render.quality=" + quality);
    all.insert(all.end(), choices.begin(), choices.end());
    return all;
}

std::string Candidate::papers() const {
    static const std::vector<std::pair<std::string, std::string>> known{
        {"render.march_step", "Peters 2025"},
        {"render.similarity_after", "Zhao et al. 2014"},
        {"render.octaves", "Wrenninge et al. 2013"}};
    std::vector<std::string> keys, papers;
    for (const std::string& choice : choices) keys.push_back(scene::overriddenKey(choice));
    for (std::size_t q = 0; q < scene::qualityNames.size(); ++q)
        if (scene::qualityNames[q] == quality)
            for (const scene::RenderChoice& choice :
                 scene::qualityChoices(static_cast<scene::Quality>(q)))
                keys.push_back("render." + choice.key);
    for (const auto& [key, paper] : known)
        if (std::find(keys.begin(), keys.end(), key) != keys.end()) papers.push_back(paper);
    return papers.empty() ? "" : joinNames(papers);
}

std::vector<Candidate> readCandidates(const std::filesystem::path& file) {
    const toml::table parsed = parseToml(readTomlFile(file, "file of candidates"), file.string());
    const TomlTable table(parsed, "");
    table.allowOnly({"candidate"}, "a file of candidates");
    const auto list = table.find("candidate");
    if (!list)
        throw inputError(
            "{}: there is no [[candidate]]; add at least\n[[candidate]]\nname = "
            "\"clamped\"\nset = [\"render.clamp=10\"]",
            file.string());
    if (list->isTable()) throw list->error("is a single table; write [[candidate]]");
    std::vector<Candidate> candidates;
    for (const TomlValue& value : list->elements("a list of [[candidate]] tables")) {
        Candidate candidate = readCandidate(value.table());
        for (const Candidate& other : candidates)
            if (other.name == candidate.name)
                throw value.error("is called '{}', as another one is", candidate.name);
        candidates.push_back(std::move(candidate));
    }
    if (candidates.empty()) throw inputError("{}: there is no [[candidate]]", file.string());
    return candidates;
}

scene::SceneDescription withChoices(const scene::SceneDescription& complete,
                                    const scene::SceneDescription& parsed) {
    scene::SceneDescription scene = complete;
    scene.render = parsed.render;
    scene.render.spp = complete.render.spp;
    scene.render.seed = complete.render.seed;
    scene.render.timeLimit = complete.render.timeLimit;
    scene.render.noise = complete.render.noise;
    for (std::size_t i = 0; i < scene.volumes.size(); ++i)
        scene.volumes[i].storage = parsed.volumes[i].storage;
    return scene;
}

std::vector<ResolvedCandidate> resolveCandidates(const std::vector<Candidate>& candidates,
                                                 const scene::SceneDescription& complete,
                                                 const ParseScene& parse, bool strict) {
    std::vector<ResolvedCandidate> resolved;
    for (const Candidate& candidate : candidates) {
        scene::SceneDescription parsed;
        try {
            parsed = parse(candidate.overrides());
        } catch (const Error& e) {
            if (!strict) continue;
            throw Error(e.kind(), fmt::format("candidate '{}': {}", candidate.name, e.what()));
        }
        ResolvedCandidate next{candidate, withChoices(complete, parsed)};
        const auto same =
            std::find_if(resolved.begin(), resolved.end(), [&](const ResolvedCandidate& other) {
                return content(other.scene) == content(next.scene);
            });
        if (same == resolved.end())
            resolved.push_back(std::move(next));
        else if (strict)
            throw inputError("candidates '{}' and '{}' make the same choices", same->candidate.name,
                             candidate.name);
    }
    return resolved;
}

}  // namespace woodcock::trade
