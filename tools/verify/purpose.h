// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace woodcock::tool {

/// What the help says of `verify`, in the program that holds the proof and in the one that calls
/// it.
constexpr const char* verifyPurpose =
    "Test this build on this machine against closed forms, published tables and known properties "
    "of volumes";

}  // namespace woodcock::tool
