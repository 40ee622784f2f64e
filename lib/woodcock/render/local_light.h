// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <variant>

#include "woodcock/light/light.h"

namespace woodcock::render {

/// Where a local light is, of whatever kind; absent for lights without one place.
inline std::optional<Vec3d> localLightPosition(const light::Light& light) {
    return std::visit(
        [](const auto& l) -> std::optional<Vec3d> {
            if constexpr (requires { Vec3d{l.position}; })
                return l.position;
            else
                return std::nullopt;
        },
        light);
}

}  // namespace woodcock::render
