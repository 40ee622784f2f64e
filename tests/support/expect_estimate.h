// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include "woodcock/proof/support/estimate.h"

namespace woodcock::test {

/// Within four standard errors, of which one is at most `largestError` of the truth: a pass means
/// something. The slack beside it is a float's rounding, for estimators without variance.
inline void expectAgrees(proof::Estimate e, double truth, double largestError) {
    EXPECT_NEAR(e.mean, truth, 4 * e.error + 2e-6 * std::abs(truth))
        << (e.mean - truth) / e.error << " standard errors of " << e.error;
    EXPECT_LE(e.error, largestError * std::abs(truth)) << "at " << truth;
}

/// The same of two estimates with independent errors (Welch).
inline void expectAgree(proof::Estimate a, proof::Estimate b, double largestError) {
    expectAgrees({a.mean, std::hypot(a.error, b.error)}, b.mean, largestError);
}

inline void expectAgrees(const proof::RgbEstimate& e, const std::array<double, 3>& truth,
                         double largestError) {
    for (std::size_t c = 0; c < 3; ++c) {
        SCOPED_TRACE(testing::Message() << "channel " << c);
        expectAgrees(e[c], truth[c], largestError);
    }
}
inline void expectAgree(const proof::RgbEstimate& a, const proof::RgbEstimate& b,
                        double largestError) {
    for (std::size_t c = 0; c < 3; ++c) {
        SCOPED_TRACE(testing::Message() << "channel " << c);
        expectAgree(a[c], b[c], largestError);
    }
}

}  // namespace woodcock::test
