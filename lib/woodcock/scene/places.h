// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>

#include <map>
#include <string>
#include <string_view>

#include "woodcock/base/error.h"

namespace woodcock::scene {

/// Where the values of a scene were written, for messages: "volume[0].scale" -> "scene.toml:4:9",
/// or the "--set ..." or option that gave it. Values that nobody wrote are not in it.
using Places = std::map<std::string, std::string, std::less<>>;

/// Of `value`; empty where nobody wrote it.
inline std::string findPlace(const Places& places, std::string_view value) {
    const auto found = places.find(value);
    return found == places.end() ? std::string() : found->second;
}

/// What `action` returns; its errors gain the place before them.
template <class Action>
decltype(auto) inPlace(const std::string& place, Action action) {
    try {
        return action();
    } catch (const Error& e) {
        if (place.empty()) throw;
        throw Error(e.kind(), fmt::format("{}: {}", place, e.what()));
    }
}

}  // namespace woodcock::scene
