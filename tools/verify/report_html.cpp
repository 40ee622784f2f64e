// SPDX-License-Identifier: Apache-2.0
#include <string_view>

#include "tools/pages/page.h"
#include "tools/verify/report.h"

namespace woodcock {
extern const std::string_view verifyPageStyle;   // verify_page.css
extern const std::string_view verifyPageScript;  // verify_page.js
}  // namespace woodcock

namespace woodcock::tool {

std::string reportHtml(const VerifyReport& report) {
    return makePage({"woodcock verify",
                     {verifyPageStyle},
                     {{"report", reportJson(report)}},
                     {verifyPageScript}});
}

}  // namespace woodcock::tool
