// SPDX-License-Identifier: Apache-2.0
#include "verify_report.h"

namespace woodcock::tool {

std::string reportHtml(const VerifyReport& report) { return reportJson(report); }

}  // namespace woodcock::tool
