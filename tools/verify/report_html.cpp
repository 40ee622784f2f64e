// SPDX-License-Identifier: Apache-2.0
#include <string_view>

#include "tools/pages/page.h"
#include "tools/verify/report.h"

namespace woodcock::tool {

// Of page/, see CMakeLists.txt.
extern const std::string_view verifyPageStyle, verifyPageCases, verifyPagePlots, verifyPageStart;

std::string reportHtml(const VerifyReport& report) {
    return makePage({"woodcock verify",
                     {verifyPageStyle},
                     {{"report", reportJson(report)}},
                     {verifyPageCases, verifyPagePlots, verifyPageStart}});
}

}  // namespace woodcock::tool
