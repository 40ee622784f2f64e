// SPDX-License-Identifier: Apache-2.0
// Input: a scene file; after a NUL byte, lines of --set overrides.
#include <cstdint>
#include <cstdlib>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "woodcock/base/error.h"
#include "woodcock/scene/scene_file.h"

namespace {

using namespace woodcock;

std::vector<std::string> linesOf(std::string_view text) {
    std::vector<std::string> lines;
    std::istringstream stream{std::string(text)};
    for (std::string line; std::getline(stream, line);) lines.push_back(line);
    return lines;
}

/// What has been parsed can be written, and parsed again to the same scene.
void roundTrip(const scene::SceneDescription& scene) {
    std::string text;
    try {
        text = scene::writeScene(scene);
    } catch (const Error& e) {
        if (e.kind() == ErrorKind::Usage) return;  // TOML cannot say it
        throw;
    }
    if (scene::sceneDigest(scene::parseSceneText(text, "written", ".")) !=
        scene::sceneDigest(scene))
        std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view input(reinterpret_cast<const char*>(data), size);
    const std::size_t end = std::min(input.find('\0'), size);
    scene::SceneDescription scene;
    try {
        scene = scene::parseSceneText(input.substr(0, end), "fuzz", ".",
                                      end < size ? linesOf(input.substr(end + 1)) : linesOf(""));
    } catch (const Error&) {
        return 0;
    }
    roundTrip(scene);
    return 0;
}
