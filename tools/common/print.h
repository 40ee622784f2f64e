// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/core.h>

#include <string_view>
#include <utility>

namespace woodcock::tool {

// What the program says on stdout, and its progress on stderr. Neither throws where the stream
// takes no more: a reader that ends is no reason to lose a render. finishStdout() tells at the end.

/// Text for people: what could drive a terminal is spelled out, see printableLines().
void printText(std::string_view text);
template <class... A>
void print(fmt::format_string<A...> text, A&&... args) {
    printText(fmt::format(text, std::forward<A>(args)...));
}

/// Text for programs, as JSON and TOML: as it is.
void printData(std::string_view text);

/// Progress, on stderr, as it is and at once.
void printProgressText(std::string_view text);
template <class... A>
void printProgress(fmt::format_string<A...> text, A&&... args) {
    printProgressText(fmt::format(text, std::forward<A>(args)...));
}

/// Opens what the caller of the program closed of stdin, stdout and stderr, so that no other file
/// gets their numbers.
void holdStandardStreams();

/// Throws Error{Failure} where stdout did not take everything that was printed.
void finishStdout();

}  // namespace woodcock::tool
