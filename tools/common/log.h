// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace woodcock::tool {

/// How spdlog's default logger speaks on stderr: lines for people, or JSON objects, one for each
/// line: {"event": "log", "level": "info", "message": "..."}.
enum class LogStyle { Text, Json };

/// `level` is one of spdlog's names: trace, debug, info, warning, error, off.
void setUpLog(LogStyle style, const std::string& level);

}  // namespace woodcock::tool
