// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace woodcock::tool {

/// A Blender, or a Python that has Blender as its module bpy.
struct Blender {
    std::string program;
    bool isPython = false;
    std::string version;  ///< as it tells: "Blender 3.4.1", "Python 3.11.7"

    /// The command that runs a Python script with one argument.
    std::vector<std::string> command(const std::filesystem::path& script,
                                     const std::string& argument) const;
};

/// The program `wanted`, else $BLENDER, else `blender` on the PATH, else a `python3` there that has
/// bpy. Throws Error{Usage} where there is none, with how to get one, and where it is neither of
/// the two.
Blender findBlender(const std::string& wanted, const std::function<bool()>& shouldStop);

}  // namespace woodcock::tool
