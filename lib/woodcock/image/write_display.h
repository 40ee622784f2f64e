// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "woodcock/image/display.h"
#include "woodcock/image/film.h"

namespace woodcock {

/// Writes the film's crop as an 8-bit picture, PNG or JPEG by the extension. With `withAlpha`, a
/// PNG keeps alpha (straight, as PNG wants it, which hides light where alpha is 0); otherwise, and
/// in a JPEG, the picture is opaque, on black. Whole or not at all; throws Error{Failure}.
void writeDisplay(const std::filesystem::path& file, const Film& film,
                  const DisplayTransform& transform, bool withAlpha);

}  // namespace woodcock
