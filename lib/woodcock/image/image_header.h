// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include "woodcock/base/regular_file.h"

namespace woodcock {

/// What is read: "OpenEXR, PNG, JPEG, ...".
std::string imageFormatsRead();

/// The format of an image file, by its contents (TGA, which has no mark, by its name too), as
/// OpenImageIO calls it: "openexr". What its header claims must fit the file: nothing is decoded
/// or allocated before that is known. Throws Error{Input}, of formats that are not read too.
std::string checkImageHeader(const RegularFile& file, const std::filesystem::path& name);

/// Throws Error{Input} where a file is too small for so many bytes of pixels at the best ratio that
/// their compression reaches. Small pictures are always believed.
void requirePlausible(const RegularFile& file, double width, double height, double pixelBytes,
                      double bestRatio);

/// Walks the header of an OpenEXR file within the file's bounds, before OpenEXR allocates what it
/// claims: attributes must fit the file, the table of chunks too, and the pixels must be what so
/// many bytes can hold at the best ratio of their compression. Deep pixels are refused.
/// Throws Error{Input}.
void checkExrHeader(const RegularFile& file);

}  // namespace woodcock
