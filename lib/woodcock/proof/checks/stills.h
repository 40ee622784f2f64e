// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "woodcock/proof/checks/measure.h"

namespace woodcock::proof {

/// The red of a picture of a scene whose shutter is open from frame -0.5 to 0.5, against the mean
/// of pictures of it as it stands still at even times.
Case asStillPictures(const Lab& lab, const std::string& name, const std::string& scene,
                     const Precision& precision);

}  // namespace woodcock::proof
