// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace woodcock {

/// A number and its standard error.
struct Measured {
    double value = 0, se = 0;
};

}  // namespace woodcock
