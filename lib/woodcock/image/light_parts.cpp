// SPDX-License-Identifier: Apache-2.0
#include "woodcock/image/light_parts.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "woodcock/base/printable.h"
#include "woodcock/image/layers.h"

namespace woodcock::image {

std::string LightParts::name(std::size_t part) const {
    if (part < kindCount()) return lightKindNames[part];
    const std::size_t group = part - kindCount();
    return groupPrefix + (group == 0 ? restOfGroups : groups[group - 1]);
}

std::string flawOfGroupName(const std::string& name) {
    constexpr std::size_t longest = 48;
    constexpr std::string_view letters =
        "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-";
    if (name.empty()) return "is empty; leave the key out, and the light counts to the rest";
    if (const std::size_t at = name.find_first_not_of(letters); at != std::string::npos) {
        std::size_t end = at + 1;  // of the character, in UTF-8
        while (end < name.size() && (static_cast<unsigned char>(name[end]) & 0xc0) == 0x80) ++end;
        return fmt::format(
            "holds '{}'; names of layers hold letters, digits, _ and -, or compositors rename them",
            shown(name.substr(at, end - at)));
    }
    if (name.size() > longest)
        return fmt::format("is {} characters long; Blender cuts layers beyond {}", name.size(),
                           longest);
    if (name == restOfGroups)
        return "is the name of the layer of all lights without a group; take another one";
    const std::vector<std::string> known = layerNames();
    if (std::find(known.begin(), known.end(), name) != known.end())
        return "is the name of a layer; take another one";
    return "";
}

}  // namespace woodcock::image
