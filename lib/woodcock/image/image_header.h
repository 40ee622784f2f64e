// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include "woodcock/base/regular_file.h"

namespace woodcock::image {

/// The formats that are read: "OpenEXR, PNG, JPEG, ...".
std::string imageFormatsRead();

/// The format of an image file, by its contents (of TGA, which has no mark, also by its name), as
/// OpenImageIO calls it: "openexr". The claims of its header are checked against the file's size
/// before anything is decoded or allocated. Throws Error{Input}, also for formats that are not
/// read.
std::string checkImageHeader(const RegularFile& file, const std::filesystem::path& name);

/// Throws Error{Input} where a file is too small for so many bytes of pixels at the best ratio of
/// their compression. Small pictures always pass.
void requirePlausible(const RegularFile& file, double width, double height, double pixelBytes,
                      double bestRatio);

/// Checks the header of an OpenEXR file before OpenEXR allocates what it claims. Attributes and the
/// table of chunks must fit the file, and its bytes must be able to hold the pixels at the best
/// ratio of their compression. Throws Error{Input}, also for deep pixels.
void checkExrHeader(const RegularFile& file);

}  // namespace woodcock::image
