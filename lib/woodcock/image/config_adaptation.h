// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <compare>
#include <string>
#include <string_view>
#include <vector>

namespace woodcock::image {

struct ConfigVersion {
    int major = 0, minor = 0;
    auto operator<=>(const ConfigVersion&) const = default;
};

/// The version in an OpenColorIO config (ocio_profile_version); 0.0 where there is none.
ConfigVersion configVersion(std::string_view text);

struct AdaptedConfig {
    std::string text;
    std::vector<std::string> missing;  ///< built-in transforms that the library does not have
};

/// Changes a config of a later minor version so that an older library can read it. It claims
/// `library`'s version. Each built-in transform that is not among `known` becomes a reference to a
/// file of its name, which does not exist. Views without these work as written. Others fail when
/// they are used, with the name in OpenColorIO's message.
AdaptedConfig adaptConfig(std::string_view text, ConfigVersion library,
                          const std::vector<std::string>& known);

/// An upper bound of the nodes of a YAML text whose aliases (*name) are replaced by the contents of
/// their anchors (&name): aliases of aliases multiply.
double yamlExpansion(std::string_view text);

}  // namespace woodcock::image
