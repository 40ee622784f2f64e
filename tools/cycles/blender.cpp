// SPDX-License-Identifier: Apache-2.0
#include "tools/cycles/blender.h"

#include <fmt/ranges.h>

#include <cstdlib>
#include <optional>

#include "tools/common/child_process.h"
#include "woodcock/base/error.h"

namespace woodcock::tool {

namespace {

/// What it prints when asked for its version; nullopt where there is no such program.
std::optional<ChildResult> tryRun(const std::vector<std::string>& command,
                                  const std::function<bool()>& shouldStop) {
    try {
        return runChild(
            command, [](const std::string&) {}, shouldStop);
    } catch (const Error& e) {
        if (e.kind() != ErrorKind::Usage) throw;
        return std::nullopt;
    }
}

Blender identify(const std::string& program, const std::string& origin,
                 const std::function<bool()>& shouldStop) {
    const ChildResult answer = runChild(
        {program, "--version"}, [](const std::string&) {}, shouldStop);
    for (const std::string& line : answer.lastLines) {
        if (line.starts_with("Blender ")) return {program, false, line};
        if (line.starts_with("Python 3")) return {program, true, line};
    }
    throw usageError(
        "{} '{}' is neither Blender nor a Python: asked for its --version, it ended with code {} "
        "and said: {}",
        origin, program, answer.exitCode, fmt::join(answer.lastLines, "\n"));
}

}  // namespace

std::vector<std::string> Blender::command(const std::filesystem::path& script,
                                          const std::string& argument) const {
    if (isPython) return {program, script.string(), argument};
    return {program, "-b",    "--factory-startup", "--python-exit-code", "1", "-P", script.string(),
            "--",    argument};
}

Blender findBlender(const std::string& wanted, const std::function<bool()>& shouldStop) {
    if (!wanted.empty()) return identify(wanted, "--blender", shouldStop);
    if (const char* variable = std::getenv("BLENDER"); variable && *variable)
        return identify(variable, "$BLENDER", shouldStop);
    if (tryRun({"blender", "--version"}, shouldStop))
        return identify("blender", "on the PATH,", shouldStop);
    const char* hasBpy =
        "import importlib.util, sys; sys.exit(not importlib.util.find_spec('bpy'))";
    const auto python = tryRun({"python3", "-c", hasBpy}, shouldStop);
    if (python && python->exitCode == 0) return identify("python3", "on the PATH,", shouldStop);
    throw usageError(
        "no Blender is found: neither --blender nor $BLENDER names one, and on the PATH there is "
        "neither 'blender' nor a 'python3' with the module bpy. Install it (Debian: apt install "
        "blender; blender.org; or pip install bpy) or name its program with --blender");
}

}  // namespace woodcock::tool
