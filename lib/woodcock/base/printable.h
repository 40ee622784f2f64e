// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace woodcock {

/// The text for one line of a message: control characters, which could break the line or drive a
/// terminal, as \x0a.
std::string printable(std::string_view text);

}  // namespace woodcock
