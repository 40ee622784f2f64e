// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <OpenColorIO/OpenColorIO.h>

#include <filesystem>
#include <string>
#include <vector>

namespace woodcock::image {

/// Checks the references of a config's colour spaces, looks, views, view transforms and named
/// transforms: OpenColorIO would follow a circle for ever. Returns the files of look-up tables that
/// exist. `origin` names the config in messages. Throws Error{Input} on circles, on references
/// nested too deeply, on more steps than anybody writes, and on tables that are too large or not
/// regular files.
std::vector<std::filesystem::path> checkConfigGraph(const OCIO_NAMESPACE::Config& config,
                                                    const std::string& origin);

}  // namespace woodcock::image
