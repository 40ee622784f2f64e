// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

namespace woodcock::image {

/// A whole OpenEXR file of one part: of lines, not of tiles, and flat.
struct ExrPart {
    std::string name;  ///< that it is to have; each another one
    std::vector<unsigned char> file;
};

/// One file of all these parts, in their order: their headers, with the name, the type and the
/// number of chunks that a file of several parts has to say, and their chunks as they are
/// ("OpenEXR File Layout"). OpenImageIO 2.4 cannot encode several parts in memory. Throws
/// Error{Failure} on what is no such file.
std::vector<unsigned char> joinExrParts(std::span<const ExrPart> parts);

}  // namespace woodcock::image
