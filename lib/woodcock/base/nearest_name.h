// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace woodcock {

/// The name of `known` that a user who typed `word` most likely meant: the one with the fewest
/// edits, the first among equals. An edit adds, drops or changes a letter, or swaps two neighbours;
/// case is ignored. Empty when no name is within as many edits as a third of the letters.
std::string nearestName(std::string_view word, std::span<const std::string> known);

/// "a, b, c", or "none" for an empty list, or "a, b and 98 more" for a long one.
std::string joinNames(std::span<const std::string> names);

/// The end of a message about an unknown name: "; did you mean 'albedo'? known keys: albedo, file".
/// `label` comes before the list ("known keys"). The question is left out when no name is near.
std::string suggestName(std::string_view word, std::string_view label,
                        std::span<const std::string> known);

}  // namespace woodcock
