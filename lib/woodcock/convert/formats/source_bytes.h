// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "woodcock/convert/dense_volume.h"
#include "woodcock/grid/vdb/file_bytes.h"

namespace woodcock {

/// Gives `volume` (dims, channels and type are set) its samples: all bytes of the file from `begin`
/// on. Errors: Input where the dims are none, where they do not need just these bytes (with a hint
/// where one number explains it), and where the bytes are more than the machine's memory.
void loadSamples(DenseVolume& volume, std::shared_ptr<FileBytes> file, std::uint64_t begin);

/// Throws where dims x channels are not positive or beyond all bounds; returns their bytes.
std::uint64_t requireDims(const DenseVolume& volume, const std::filesystem::path& file);

/// Throws Error{Input} where `bytes` for `what` are more than the memory of the machine.
void requireMemory(double bytes, const std::string& what);

}  // namespace woodcock
