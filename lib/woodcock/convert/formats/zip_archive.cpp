// SPDX-License-Identifier: Apache-2.0
#include "woodcock/convert/formats/zip_archive.h"

#include <zlib.h>

#include <algorithm>
#include <limits>
#include <new>

#include "woodcock/base/error.h"
#include "woodcock/base/printable.h"
#include "woodcock/convert/formats/source_bytes.h"
#include "woodcock/convert/sample_type.h"

namespace woodcock::convert {

namespace {

// PKWARE's APPNOTE 6.3.10, sections 4.3.7 to 4.3.16 and 4.5.3.
constexpr std::uint32_t localSign = 0x04034b50, entrySign = 0x02014b50, endSign = 0x06054b50,
                        end64Sign = 0x06064b50, locator64Sign = 0x07064b50;
constexpr std::uint64_t localBytes = 30, entryBytes = 46, endBytes = 22, locator64Bytes = 20;
constexpr std::uint64_t longestComment = 65535;
constexpr std::uint32_t in64 = 0xffffffff;  // the number is that of 64 bits
constexpr std::uint64_t mostEntries = 100000;

template <class T>
T little(grid::FileBytes& file) {
    const T value = file.value<T>();
    return std::endian::native == std::endian::little ? value : swapBytes(value);
}

struct Directory {
    std::uint64_t begin = 0, entries = 0;
};

Directory readDirectory64(grid::FileBytes& file, std::uint64_t endPlace) {
    if (endPlace < locator64Bytes) throw file.damaged("no directory of the archive");
    file.seek(endPlace - locator64Bytes);
    if (little<std::uint32_t>(file) != locator64Sign)
        throw file.damaged("no directory of the archive");
    file.skip(4);
    const auto end64 = little<std::uint64_t>(file);
    if (end64 > file.size()) throw file.damaged("a directory beyond the end");
    file.seek(end64);
    if (little<std::uint32_t>(file) != end64Sign)
        throw file.damaged("no end of the archive's directory");
    file.skip(28);
    Directory directory;
    directory.entries = little<std::uint64_t>(file);
    file.skip(8);
    directory.begin = little<std::uint64_t>(file);
    return directory;
}

Directory findDirectory(grid::FileBytes& file) {
    file.enter(0, file.size(), "its directory");
    const std::uint64_t reach = std::min(file.size(), endBytes + longestComment);
    file.seek(file.size() - reach);
    const std::span<const char> tail = file.bytes(reach);
    for (std::uint64_t i = reach >= endBytes ? reach - endBytes + 1 : 0; i-- > 0;) {
        std::uint32_t sign = 0;
        std::memcpy(&sign, tail.data() + i, sizeof sign);
        if (std::endian::native == std::endian::big) sign = swapBytes(sign);
        if (sign != endSign) continue;
        const std::uint64_t place = file.size() - reach + i;
        file.seek(place + 10);
        Directory directory;
        directory.entries = little<std::uint16_t>(file);
        file.skip(4);
        directory.begin = little<std::uint32_t>(file);
        if (directory.entries == 0xffff || directory.begin == in64)
            return readDirectory64(file, place);
        return directory;
    }
    throw inputError("{} is not a zip archive, or its end is missing", file.path().string());
}

/// The 64-bit numbers of an entry, in their fixed order, for those that do not fit 32.
void readExtra(grid::FileBytes& file, std::uint64_t length, ZipEntry& entry) {
    constexpr std::uint16_t numbers64 = 1;
    const std::uint64_t end = file.position() + length;
    while (file.position() + 4 <= end) {
        const auto kind = little<std::uint16_t>(file);
        const std::uint64_t next = file.position() + 2 + little<std::uint16_t>(file);
        if (kind == numbers64)
            for (std::uint64_t* number : {&entry.size, &entry.stored, &entry.header})
                if (*number == in64 && file.position() + 8 <= next)
                    *number = little<std::uint64_t>(file);
        file.seek(std::min(next, end));
    }
    file.seek(end);
}

ZipEntry readEntry(grid::FileBytes& file) {
    if (file.left() < entryBytes || little<std::uint32_t>(file) != entrySign)
        throw file.damaged("an entry of the archive's directory");
    ZipEntry entry;
    file.skip(4);
    const auto flags = little<std::uint16_t>(file), method = little<std::uint16_t>(file);
    file.skip(4);
    entry.checksum = little<std::uint32_t>(file);
    entry.stored = little<std::uint32_t>(file);
    entry.size = little<std::uint32_t>(file);
    const auto name = little<std::uint16_t>(file), extra = little<std::uint16_t>(file),
               comment = little<std::uint16_t>(file);
    file.skip(8);
    entry.header = little<std::uint32_t>(file);
    const std::span<const char> text = file.bytes(name);
    entry.name = printable(std::string(text.begin(), text.end()));
    readExtra(file, extra, entry);
    file.skip(comment);
    if (flags & 1u)
        throw inputError("{}: '{}' in it is encrypted", file.path().string(), entry.name);
    if (method != 0 && method != 8)
        throw inputError(
            "{}: '{}' in it is packed by method {}; stored (0) and deflated (8) are "
            "read",
            file.path().string(), entry.name, method);
    entry.deflated = method == 8;
    return entry;
}

/// Deflate makes of one byte 1032 at most.
constexpr std::uint64_t largestInflation = 1032;

void requireSize(const grid::FileBytes& file, const ZipEntry& entry) {
    const bool fits =
        entry.deflated ? entry.size / largestInflation <= entry.stored : entry.size == entry.stored;
    if (!fits || entry.stored > file.size())
        throw file.damaged(fmt::format("{} bytes of '{}' cannot unpack to {}", entry.stored,
                                       entry.name, entry.size));
}

/// Brings the entry's bytes into memory.
std::span<const char> loadStored(grid::FileBytes& file, const ZipEntry& entry) {
    const std::string place = fmt::format("'{}'", entry.name);
    file.enter(std::min(entry.header, file.size()), file.size(), place);
    if (file.left() < localBytes || little<std::uint32_t>(file) != localSign)
        throw file.damaged("the header of an entry");
    file.skip(22);
    const std::uint64_t name = little<std::uint16_t>(file), extra = little<std::uint16_t>(file);
    file.skip(name + extra);
    const std::uint64_t begin = file.position();
    if (entry.stored > file.size() - begin) throw file.damaged("bytes beyond the end");
    file.enter(begin, begin + entry.stored, place);
    return file.bytes(entry.stored);
}

bool inflateInto(std::span<const char> packed, std::span<char> to) {
    z_stream stream{};
    if (inflateInit2(&stream, -MAX_WBITS) != Z_OK) throw std::bad_alloc();
    constexpr std::size_t most = 1u << 30;
    std::size_t in = 0, out = 0;
    int status = Z_OK;
    while (status == Z_OK) {
        // Only read.
        stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(packed.data() + in));
        stream.avail_in = static_cast<uInt>(std::min(most, packed.size() - in));
        stream.next_out = reinterpret_cast<Bytef*>(to.data() + out);
        stream.avail_out = static_cast<uInt>(std::min(most, to.size() - out));
        const uInt give = stream.avail_in, room = stream.avail_out;
        status = inflate(&stream, Z_NO_FLUSH);
        in += give - stream.avail_in;
        out += room - stream.avail_out;
    }
    inflateEnd(&stream);
    return status == Z_STREAM_END && out == to.size();
}

}  // namespace

std::vector<ZipEntry> listZip(grid::FileBytes& file) {
    const Directory directory = findDirectory(file);
    if (directory.begin > file.size() || directory.entries > mostEntries)
        throw file.damaged(fmt::format("a directory of {} entries at byte {}", directory.entries,
                                       directory.begin));
    file.seek(directory.begin);
    std::vector<ZipEntry> entries;
    for (std::uint64_t i = 0; i < directory.entries; ++i) {
        entries.push_back(readEntry(file));
        requireSize(file, entries.back());
    }
    return entries;
}

UnpackedEntry unpackZipEntry(grid::FileBytes& file, const ZipEntry& entry) {
    requireMemory(static_cast<double>(entry.size) + static_cast<double>(entry.stored),
                  fmt::format("{}: '{}'", file.path().string(), entry.name));
    const std::span<const char> stored = loadStored(file, entry);
    auto bytes = std::shared_ptr<char[]>(new char[entry.size]);
    const std::span<char> to(bytes.get(), entry.size);
    if (!entry.deflated)
        std::copy(stored.begin(), stored.end(), to.begin());
    else if (!inflateInto(stored, to))
        throw file.damaged("packed bytes");
    if (entry.checksum != crc32_z(0, reinterpret_cast<const Bytef*>(to.data()), to.size()))
        throw file.damaged("a wrong checksum");
    return {bytes, {bytes.get(), static_cast<std::size_t>(entry.size)}};
}

}  // namespace woodcock::convert
