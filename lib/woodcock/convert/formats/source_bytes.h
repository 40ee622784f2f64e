// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "woodcock/convert/dense_volume.h"
#include "woodcock/grid/vdb/file_bytes.h"

namespace woodcock::convert {

/// Gives `volume` (dims, channels and type are set) its samples: all bytes of the file from `begin`
/// on. Errors: Input where the dims are not valid, where they need another number of bytes (with a
/// hint where one number explains it), and where the bytes exceed the machine's memory.
void loadSamples(DenseVolume& volume, std::shared_ptr<grid::FileBytes> file, std::uint64_t begin);

/// Returns the bytes of dims x channels samples. Throws Error{Input} where a number is not positive
/// or too large.
std::uint64_t requireDims(const DenseVolume& volume, const std::filesystem::path& file);

/// Throws Error{Input} where `bytes` for `what` are more than the memory of the machine.
void requireMemory(double bytes, const std::string& what);

}  // namespace woodcock::convert
