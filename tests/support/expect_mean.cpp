// SPDX-License-Identifier: Apache-2.0
#include "tests/support/expect_mean.h"

#include <gtest/gtest.h>

#include <cmath>

namespace woodcock::test {

void expectMean(const Moments& samples, double expected, double largestError,
                const std::string& what) {
    const double error = samples.standardError();
    EXPECT_LE(std::abs(samples.mean() - expected), 4 * error + 1e-6 * std::abs(expected))
        << what << ": mean " << samples.mean() << " +- " << error << ", expected " << expected;
    EXPECT_LE(error, largestError) << what << ": too noisy to mean anything";
}

}  // namespace woodcock::test
