// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <functional>
#include <string>
#include <vector>

namespace woodcock::tool {

struct ChildResult {
    int exitCode = -1;                   ///< 128 + signal where one ended it
    bool stopped = false;                ///< by shouldStop
    std::vector<std::string> lastLines;  ///< of what it wrote, to stdout or stderr
};

/// Runs a program, found by PATH, with no input, to its end. `onLine` gets what it writes, line by
/// line. Once `shouldStop` says so, which is asked all the time, the program and what it started
/// are ended: by SIGTERM, and by SIGKILL where that takes longer than `patience`. Throws
/// Error{Usage} where it cannot be started.
ChildResult runChild(const std::vector<std::string>& command,
                     const std::function<void(const std::string&)>& onLine,
                     const std::function<bool()>& shouldStop,
                     std::chrono::seconds patience = std::chrono::seconds(3));

}  // namespace woodcock::tool
