// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace woodcock {

/// The one of `known` that a user who typed `word` most likely meant: the fewest edits away (a
/// letter added, dropped, changed, or two neighbours swapped; case is ignored), the first among
/// equals. Empty when none is near, that is within a third of the letters.
std::string nearestName(std::string_view word, std::span<const std::string> known);

/// "a, b, c", or "none" where there is nothing to list; "a, b and 98 more" where there is too much.
std::string joinNames(std::span<const std::string> names);

/// The end of a message about an unknown name: "; did you mean 'albedo'? known keys: albedo, file".
/// `label` is what stands before the list ("known keys"); the question is left out when no name is
/// near.
std::string suggestName(std::string_view word, std::string_view label,
                        std::span<const std::string> known);

}  // namespace woodcock
