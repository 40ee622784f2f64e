// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace woodcock::tool {

/// What one kind of page has beside what all share: frame.html, style.css and
/// common.js.
struct PageParts {
    std::string_view title;
    std::vector<std::string_view> styles;                        ///< CSS, in this order
    std::vector<std::pair<std::string_view, std::string>> data;  ///< id and JSON; see dataOf()
    std::vector<std::string_view> scripts;                       ///< JavaScript, in this order
};

/// A page that needs nothing but itself. Whatever strings the JSON holds, none ends its script.
std::string makePage(const PageParts& parts);

}  // namespace woodcock::tool
