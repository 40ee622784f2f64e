// SPDX-License-Identifier: Apache-2.0
#include "woodcock/compare/student_t.h"

#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <limits>

namespace woodcock::compare {

double studentTwoSided(double t, double degrees) {
    if (std::isnan(t) || std::isnan(degrees)) return std::numeric_limits<double>::quiet_NaN();
    if (std::isinf(t)) return 0;
    return 2 * cdf(complement(boost::math::students_t(degrees), std::abs(t)));
}

}  // namespace woodcock::compare
