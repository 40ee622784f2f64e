// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <filesystem>
#include <string>

#include "woodcock/convert/dense_volume.h"

namespace woodcock::convert {

/// Which axis varies fastest in a file. Channels are innermost in both.
enum class VoxelOrder { XFastest, ZFastest };

/// A file of a header and the values behind it.
struct DenseFileLayout {
    std::string header{};  ///< its bytes, never packed
    VoxelOrder order = VoxelOrder::XFastest;
    SampleType type = SampleType::F32;
    bool packed = false;  ///< the values by gzip
};

/// Writes the volume's values in little-endian byte order, the whole file or none. Integer types
/// take the nearest number. Returns the largest difference between a value and what is written for
/// it. Errors: Input for a value that the type cannot hold; Failure where the file cannot be
/// written.
double writeDenseFile(const std::filesystem::path& file, const DenseVolume& volume,
                      const DenseFileLayout& layout, const WorkProgress& progress);

/// Appends the bytes of a number, in little-endian order, to a header.
template <class T>
void appendLittleEndian(std::string& bytes, T value) {
    if (std::endian::native == std::endian::big) value = swapBytes(value);
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

}  // namespace woodcock::convert
