// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <compare>
#include <string>
#include <string_view>
#include <vector>

namespace woodcock {

struct ConfigVersion {
    int major = 0, minor = 0;
    auto operator<=>(const ConfigVersion&) const = default;
};

/// What an OpenColorIO config says of itself (ocio_profile_version); 0.0 where it says nothing.
ConfigVersion configVersion(std::string_view text);

struct AdaptedConfig {
    std::string text;
    std::vector<std::string> missing;  ///< built-in transforms that the library does not have
};

/// A config of a later minor version, so that an older library reads it: it claims `library`'s
/// version, and each built-in transform that is not among `known` becomes a reference to a file of
/// its name, which does not exist. All that does not use those works as written; what does fails
/// when it is used, with the name in OpenColorIO's message.
AdaptedConfig adaptConfig(std::string_view text, ConfigVersion library,
                          const std::vector<std::string>& known);

/// How many nodes a YAML text stands for at most once its aliases (*name) are what their anchors
/// (&name) hold: aliases of aliases multiply.
double yamlExpansion(std::string_view text);

}  // namespace woodcock
