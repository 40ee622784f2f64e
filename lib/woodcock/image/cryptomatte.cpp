// SPDX-License-Identifier: Apache-2.0
#include "woodcock/image/cryptomatte.h"

#include <OpenEXR/ImfIDManifest.h>
#include <fmt/format.h>

#include <bit>
#include <nlohmann/json.hpp>

namespace woodcock::image {

namespace {

std::uint32_t hashOf(std::string_view name) {
    return Imf::IDManifest::MurmurHash32(std::string(name));
}

}  // namespace

std::uint32_t matteBits(std::string_view name) {
    std::uint32_t bits = hashOf(name);
    const std::uint32_t exponent = bits >> 23 & 255;
    if (exponent == 0 || exponent == 255) bits ^= std::uint32_t{1} << 23;
    return bits;
}

float matteId(std::string_view name) { return std::bit_cast<float>(matteBits(name)); }

std::vector<std::string> matteKinds() { return {"object", "material"}; }

std::vector<std::string> matteChannels(const MatteLayer& layer) {
    std::vector<std::string> channels;
    for (int level = 0; level < matteRanks / 2; ++level)
        for (const char* channel : {"r", "g", "b", "a"})  // lower case, as Blender has them
            channels.push_back(fmt::format("{}{:02}.{}", layer.name, level, channel));
    return channels;
}

std::vector<std::pair<std::string, std::string>> matteAttributes(const MatteLayer& layer) {
    const std::string key =
        fmt::format("cryptomatte/{:.7}/", fmt::format("{:08x}", hashOf(layer.name)));
    nlohmann::ordered_json manifest = nlohmann::ordered_json::object();
    for (const std::string& name : layer.names)
        manifest[name] = fmt::format("{:08x}", matteBits(name));
    return {{key + "name", layer.name},
            {key + "hash", "MurmurHash3_32"},
            {key + "conversion", "uint32_to_float32"},
            {key + "manifest", manifest.dump()}};
}

}  // namespace woodcock::image
