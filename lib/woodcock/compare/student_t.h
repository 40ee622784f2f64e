// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace woodcock::compare {

/// Probability that a number of Student's t distribution is further from zero than `t`. Infinite
/// `degrees` make it the normal distribution. Relative error below 1e-9, in the far tail too.
double studentTwoSided(double t, double degrees);

}  // namespace woodcock::compare
