// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <OpenColorIO/OpenColorIO.h>

#include <filesystem>
#include <string>
#include <vector>

namespace woodcock {

/// Follows what a config's colour spaces, looks, views, view transforms and named transforms refer
/// to. OpenColorIO follows it without an end where they lead in a circle. Returns the files of
/// look-up tables that are named and exist. `origin` names the config in messages. Throws
/// Error{Input} on circles, on references nested too deeply, on more steps than anybody writes, and
/// on tables that are no regular files or too large.
std::vector<std::filesystem::path> checkConfigGraph(const OCIO_NAMESPACE::Config& config,
                                                    const std::string& origin);

}  // namespace woodcock
