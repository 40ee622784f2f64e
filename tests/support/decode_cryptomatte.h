// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>

#include "woodcock/proof/support/read_back.h"

namespace woodcock::test {

/// MurmurHash3_x86_32 with seed 0, as Appleby describes it.
inline std::uint32_t murmur3(const std::string& text) {
    const auto rotate = [](std::uint32_t v, int by) { return std::rotl(v, by); };
    const auto scramble = [&](std::uint32_t k) {
        return rotate(k * 0xcc9e2d51u, 15) * 0x1b873593u;
    };
    const auto byte = [&](std::size_t i) {
        return std::uint32_t{static_cast<unsigned char>(text[i])};
    };
    std::uint32_t hash = 0;
    std::size_t i = 0;
    for (; i + 4 <= text.size(); i += 4) {
        hash ^= scramble(byte(i) | byte(i + 1) << 8 | byte(i + 2) << 16 | byte(i + 3) << 24);
        hash = rotate(hash, 13) * 5 + 0xe6546b64u;
    }
    std::uint32_t tail = 0;
    for (std::size_t k = text.size(); k > i; --k) tail = tail << 8 | byte(k - 1);
    if (i < text.size()) hash ^= scramble(tail);
    hash ^= static_cast<std::uint32_t>(text.size());
    hash ^= hash >> 16, hash *= 0x85ebca6bu;
    hash ^= hash >> 13, hash *= 0xc2b2ae35u;
    return hash ^ hash >> 16;
}

/// Reads the mattes of an image as compositors do, by the specification alone (Cryptomatte 1.2.0):
/// it shares nothing with what writes them.
class CryptomatteDecoder {
public:
    /// The layer of this name, such as CryptoObject. Throws where the header says nothing of it.
    CryptomatteDecoder(const proof::ReadBack& image, const std::string& layer)
        : image_(image), layer_(layer) {
        const std::string suffix = "/name";
        for (const auto& [attribute, value] : image.attributes)
            if (attribute.starts_with("cryptomatte/") && attribute.ends_with(suffix) &&
                value == layer)
                prefix_ = attribute.substr(0, attribute.size() - suffix.size() + 1);
        if (prefix_.empty()) throw std::runtime_error("no cryptomatte layer " + layer);
        const auto manifest = nlohmann::json::parse(image.attributes.at(prefix_ + "manifest"));
        for (const auto& [name, hex] : manifest.items())
            ids_[name] = std::bit_cast<float>(
                static_cast<std::uint32_t>(std::stoul(hex.get<std::string>(), nullptr, 16)));
    }

    const std::string& prefix() const { return prefix_; }  ///< "cryptomatte/KEY/"
    const std::map<std::string, float>& ids() const { return ids_; }

    /// Calls f(id, coverage) for all ranks of a pixel, from the first on.
    template <class F>
    void forEachRank(int x, int y, F f) const {
        for (int level = 0; image_.has(channel(level, "r")); ++level) {
            f(image_.at(x, y, channel(level, "r")), image_.at(x, y, channel(level, "g")));
            f(image_.at(x, y, channel(level, "b")), image_.at(x, y, channel(level, "a")));
        }
    }
    /// The matte of a name.
    float coverage(int x, int y, const std::string& name) const {
        float sum = 0;
        forEachRank(x, y, [&](float id, float coverage) {
            if (id == ids_.at(name)) sum += coverage;
        });
        return sum;
    }
    float total(int x, int y) const {
        float sum = 0;
        forEachRank(x, y, [&](float, float coverage) { sum += coverage; });
        return sum;
    }

private:
    std::string channel(int level, const char* c) const {
        return layer_ + (level < 10 ? "0" : "") + std::to_string(level) + "." + c;
    }

    const proof::ReadBack& image_;
    std::string layer_, prefix_;
    std::map<std::string, float> ids_;
};

}  // namespace woodcock::test
