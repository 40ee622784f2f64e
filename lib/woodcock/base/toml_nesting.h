// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace woodcock {

/// Parts of a dotted key, "a.b.c": the TOML library makes a table within a table of each, by
/// functions that call themselves.
inline constexpr std::size_t mostKeyParts = 32;

/// Throws Error{Input} where a TOML text has a key of more parts. `name` stands for the file.
void refuseDeepKeys(std::string_view text, const std::string& name);

}  // namespace woodcock
