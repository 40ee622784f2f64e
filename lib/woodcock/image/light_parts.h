// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace woodcock::image {

/// How light came to the camera: by the first event of its path as the camera sees it, and by
/// whether there were more. An event is a scattering in a medium, or a reflection or refraction of
/// a surface. Boundaries that light passes unchanged are none.
enum class LightKind : std::uint8_t {
    VolumeDirect,     ///< scattered once, in a medium
    VolumeIndirect,   ///< first in a medium, and more than once
    Emission,         ///< from what glows, without any event: media, surfaces, lamps in sight
    SurfaceDirect,    ///< scattered once, by a surface
    SurfaceIndirect,  ///< first by a surface, and more than once
    Background        ///< from infinitely far away, without any event
};
/// Their layers, in the same order.
inline const std::array<std::string, 6> lightKindNames{"volume_direct",    "volume_indirect",
                                                       "emission",         "surface_direct",
                                                       "surface_indirect", "background"};

/// The number of a light group: 0 is the rest, of all that names none; else groups[number - 1].
using LightGroup = std::uint8_t;
inline constexpr std::size_t mostLightGroups = 255;

/// Into which parts a picture's light is split. All kinds sum to the picture, and so do all groups
/// with the rest.
struct LightParts {
    bool kinds = false;
    std::vector<std::string> groups = {};  ///< names, without the rest; empty: groups are not split

    std::size_t kindCount() const { return kinds ? lightKindNames.size() : 0; }
    std::size_t groupCount() const { return groups.empty() ? 0 : groups.size() + 1; }
    std::size_t count() const { return kindCount() + groupCount(); }
    /// The places of a kind and of a group among all parts; only where they are split.
    std::size_t placeOf(LightKind kind) const { return static_cast<std::size_t>(kind); }
    std::size_t placeOf(LightGroup group) const { return kindCount() + group; }
    /// The layer of a part: "volume_direct", "lightgroup_key".
    std::string name(std::size_t part) const;
    bool operator==(const LightParts&) const = default;
};

/// Layers of light groups are called so, and the group's name; that of the rest is `restOfGroups`.
inline const std::string groupPrefix = "lightgroup_";
inline const std::string restOfGroups = "rest";

/// Why a light group may not be called so, such as "holds ' '; ..."; empty where it may. Nuke takes
/// letters, digits, _ and -. Blender cuts names of channels beyond 63 bytes.
std::string flawOfGroupName(const std::string& name);

}  // namespace woodcock::image
