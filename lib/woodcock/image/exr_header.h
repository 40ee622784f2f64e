// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "woodcock/base/regular_file.h"

namespace woodcock {

/// Walks the header of an OpenEXR file within the file's bounds, before OpenEXR allocates what it
/// claims: attributes must fit the file, the table of chunks too, and the pixels must be what so
/// many bytes can hold at the best ratio of their compression. Deep pixels are refused.
/// Throws Error{Input}.
void checkExrHeader(const RegularFile& file);

}  // namespace woodcock
