// SPDX-License-Identifier: Apache-2.0
#include <string_view>

#include "verify_report.h"

namespace woodcock {
extern const std::string_view verifyPage;  // verify_page.html
}

namespace woodcock::tool {

std::string reportHtml(const VerifyReport& report) {
    constexpr std::string_view place = "@REPORT@";
    // JSON has < in strings only, where it may be written so: no name can end the script.
    std::string json;
    for (const char c : reportJson(report))
        json += c == '<' ? std::string("\\u003c") : std::string(1, c);
    const std::size_t at = verifyPage.find(place);
    return std::string(verifyPage.substr(0, at)) + json +
           std::string(verifyPage.substr(at + place.size()));
}

}  // namespace woodcock::tool
