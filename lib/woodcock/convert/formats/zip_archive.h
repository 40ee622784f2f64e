// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "woodcock/grid/vdb/file_bytes.h"

namespace woodcock::convert {

/// A file within a zip archive.
struct ZipEntry {
    std::string name;
    std::uint64_t header = 0;  ///< where its local header begins
    std::uint64_t stored = 0;  ///< bytes in the archive
    std::uint64_t size = 0;    ///< bytes unpacked
    std::uint32_t checksum = 0;
    bool deflated = false;  ///< else stored as they are
};

/// All files of an archive, by its central directory, of 32 or 64 bits. Positions are checked, and
/// no entry claims more bytes than deflate can make of its stored ones. Errors: Input where the
/// file is not an archive, is damaged, encrypted, or packed in another way.
std::vector<ZipEntry> listZip(grid::FileBytes& file);

struct UnpackedEntry {
    std::shared_ptr<const char[]> owner;
    std::span<const char> bytes;
};

/// The bytes of an entry. Errors: Input where they are damaged, by their checksum too, and where
/// they are more than the memory of the machine.
UnpackedEntry unpackZipEntry(grid::FileBytes& file, const ZipEntry& entry);

}  // namespace woodcock::convert
