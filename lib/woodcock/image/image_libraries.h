// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace woodcock {

/// The libraries that read and write images, with the versions that are loaded: "OpenImageIO
/// 2.4.7, OpenColorIO 2.1.2, OpenEXR 3.1.5".
std::string imageLibraries();

}  // namespace woodcock
