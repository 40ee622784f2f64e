// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace woodcock::image {

// Cryptomatte 1.2.0: Friedman and Jones 2015, "Fully Automatic ID Mattes with Support for Motion
// Blur and Transparency", and the specification that goes with it.

/// The bits of the float that stands for a name: MurmurHash3_x86_32 of its UTF-8, with bit 23
/// flipped where they would be a float that is not normal.
std::uint32_t matteBits(std::string_view name);
/// These bits as a float: never 0, infinite or NaN.
float matteId(std::string_view name);

/// Coverage by name: of objects, or of materials.
struct MatteLayer {
    std::string name;                   ///< CryptoObject, CryptoMaterial
    std::vector<std::string> names;     ///< what may be seen; their ids differ
    std::vector<std::uint32_t> nameOf;  ///< by StoppedLight::Stop::owner: an index of `names`
};

/// The words of users for layers: "object", "material".
std::vector<std::string> matteKinds();

/// How many ids of a pixel a file keeps: those of most coverage.
inline constexpr int matteRanks = 6;
/// CryptoObject00.r, .g, .b, .a, CryptoObject01.r and so on: id and coverage of each rank.
std::vector<std::string> matteChannels(const MatteLayer& layer);
/// Names and texts of a header's attributes.
std::vector<std::pair<std::string, std::string>> matteAttributes(const MatteLayer& layer);

}  // namespace woodcock::image
