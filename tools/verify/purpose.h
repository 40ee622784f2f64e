// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace woodcock::tool {

/// What the help says of `verify`, in the program that holds the proof and in the one that calls it.
constexpr const char* verifyPurpose =
    "Hold this build on this machine against closed forms, published tables and properties that "
    "any volume has";

}  // namespace woodcock::tool
