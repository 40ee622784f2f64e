// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "tools/common/print.h"

namespace woodcock::tool {

/// The text of a document, in lines of this indentation; -1: in one line. What is not UTF-8, as
/// files' names may be, becomes a mark of replacement, and numbers that are not finite null.
template <class Json>
std::string jsonText(const Json& document, int indentation = 2) {
    return document.dump(indentation, ' ', false, Json::error_handler_t::replace);
}

/// A document on stdout, with a line's end.
template <class Json>
void printJson(const Json& document, int indentation = 2) {
    printData(jsonText(document, indentation) + "\n");
}

}  // namespace woodcock::tool
