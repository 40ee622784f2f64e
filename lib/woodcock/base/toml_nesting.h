// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace woodcock {

/// Parts of a dotted key, "a.b.c": the TOML library nests a table for each part, by recursive
/// functions.
inline constexpr std::size_t mostKeyParts = 32;

/// Throws Error{Input} where a TOML text has a key of more parts. `name` is the file's name in
/// messages.
void refuseDeepKeys(std::string_view text, const std::string& name);

}  // namespace woodcock
