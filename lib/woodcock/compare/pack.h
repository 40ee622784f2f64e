// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>

namespace woodcock::compare {

// Bytes and numbers as text for a page.

std::string base64(std::span<const unsigned char> bytes);

/// Compressed as zlib does, in base64.
std::string packBytes(std::span<const unsigned char> bytes);

/// Floats rounded to their upper 24 bits, which keep 5 digits: first the highest byte of each, then
/// the next bytes, as this compresses better.
std::string packFloats(std::span<const float> values);

}  // namespace woodcock::compare
