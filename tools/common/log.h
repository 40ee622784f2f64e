// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace woodcock::tool {

/// How spdlog's default logger speaks on stderr: lines for people, or JSON objects, one for each
/// line: {"event": "log", "level": "info", "message": "..."}; or lines for people, with what ends
/// the job on stdout, too, as Open Job Description has it: "openjd_fail: ...".
enum class LogStyle { Text, Json, OpenJd };

/// `level` is one of spdlog's names: trace, debug, info, warning, error, off.
void setUpLog(LogStyle style, const std::string& level);

}  // namespace woodcock::tool
