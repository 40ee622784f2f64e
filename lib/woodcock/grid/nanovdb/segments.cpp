// SPDX-License-Identifier: Apache-2.0
#ifdef WOODCOCK_WITH_NANOVDB

#include "woodcock/grid/nanovdb/segments.h"

#include <blosc.h>
#include <zlib.h>

#include <algorithm>

#include "woodcock/base/error.h"
#include "woodcock/base/memory.h"

namespace woodcock::grid {

namespace {

constexpr unsigned knownMajorVersion = 32;  // it changes where the layout does

/// What begins each segment of a file; the grids that it lists follow.
struct SegmentHeader {
    std::uint64_t magic;
    std::uint32_t version;
    std::uint16_t gridCount;
    NanoCodec codec;
};
static_assert(sizeof(SegmentHeader) == 16);

/// What a segment's header says of a grid, before its name.
struct GridEntry {
    std::uint64_t gridBytes, fileBytes, nameHash, activeVoxels;
    std::uint32_t type, gridClass;
    double worldBounds[6];
    std::int32_t indexBounds[6];
    double voxel[3];
    std::uint32_t nameBytes, nodeCounts[4], tileCounts[3];
    NanoCodec codec;
    std::uint16_t padding;
    std::uint32_t version;
};
static_assert(sizeof(GridEntry) == 176);

/// As the characters "NanoVDB" and a digit: '0' of older writers, '2' of newer ones.
constexpr bool isMagic(std::uint64_t magic) {
    return magic == 0x304244566f6e614e || magic == 0x324244566f6e614e;
}

SegmentHeader readHeader(FileBytes& file) {
    const std::string& path = file.path().string();
    if (file.left() < sizeof(SegmentHeader)) {
        if (file.position() > 0) throw file.damaged("the header of a segment");
        throw inputError("{} is not a NanoVDB file: it has {} bytes", path, file.left());
    }
    const std::uint64_t place = file.position();
    const auto header = file.value<SegmentHeader>();
    if (!isMagic(header.magic)) {
        if (isMagic(__builtin_bswap64(header.magic)))
            throw inputError("{} was written by a machine of the other byte order", path);
        if (place > 0)
            throw inputError("{} is cut short or damaged: no segment begins at byte {}", path,
                             place);
        throw inputError("{} is not a NanoVDB file: it does not begin with 'NanoVDB0'", path);
    }
    if (const unsigned major = header.version >> 21; major != knownMajorVersion)
        throw inputError("{} is of NanoVDB's format {}, where {} is expected", path, major,
                         knownMajorVersion);
    if (header.codec > NanoCodec::Blosc)
        throw file.damaged(
            fmt::format("unknown compression {}", static_cast<unsigned>(header.codec)));
    if (header.gridCount == 0) throw file.damaged("a segment without grids");
    return header;
}

NanoListing readEntry(FileBytes& file, NanoCodec codec) {
    const auto entry = file.value<GridEntry>();
    const std::span<const char> name = file.bytes(entry.nameBytes);
    NanoListing grid;
    grid.name.assign(name.begin(), std::find(name.begin(), name.end(), '\0'));
    grid.size = entry.gridBytes;
    grid.stored = entry.fileBytes;
    grid.codec = codec;
    return grid;
}

/// Deflate packs 1032 bytes into one at best, and lz4 255.
constexpr std::uint64_t mostPerByte = 1100;

void requireSize(const FileBytes& file, const NanoListing& grid) {
    if (grid.codec == NanoCodec::None ? grid.size != grid.stored
                                      : grid.size / mostPerByte > grid.stored)
        throw file.damaged(fmt::format("{} bytes of grid '{}' cannot unpack to {}", grid.stored,
                                       grid.name, grid.size));
}

/// Blosc makes pieces of this size.
constexpr std::uint64_t bloscPiece = std::uint64_t(1) << 30;

void unpackBlosc(FileBytes& file, std::span<std::uint8_t> to) {
    while (!to.empty()) {
        const std::size_t expected = std::min<std::size_t>(to.size(), bloscPiece);
        const std::span<const char> packed = file.bytes(file.value<std::uint64_t>());
        std::size_t unpacked = 0;
        if (blosc_cbuffer_validate(packed.data(), packed.size(), &unpacked) != 0 ||
            unpacked != expected ||
            blosc_decompress_ctx(packed.data(), to.data(), expected, 1) !=
                static_cast<int>(expected))
            throw file.damaged("compressed values");
        to = to.subspan(expected);
    }
}

void unpackZip(FileBytes& file, std::span<std::uint8_t> to) {
    const std::span<const char> packed = file.bytes(file.value<std::uint64_t>());
    uLongf unpacked = to.size();
    if (uncompress(to.data(), &unpacked, reinterpret_cast<const Bytef*>(packed.data()),
                   packed.size()) != Z_OK ||
        unpacked != to.size())
        throw file.damaged("compressed values");
}

/// Inflates no more than is asked for.
void unpackZipHead(FileBytes& file, std::span<std::uint8_t> to) {
    const std::span<const char> packed = file.bytes(file.value<std::uint64_t>());
    z_stream stream{};
    if (inflateInit(&stream) != Z_OK) throw std::bad_alloc();
    // Only read.
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(packed.data()));
    stream.avail_in = static_cast<uInt>(std::min<std::size_t>(packed.size(), 1u << 20));
    stream.next_out = to.data();
    stream.avail_out = static_cast<uInt>(to.size());
    const int status = inflate(&stream, Z_SYNC_FLUSH);
    const bool whole = stream.avail_out == 0;
    inflateEnd(&stream);
    if ((status != Z_OK && status != Z_STREAM_END) || !whole)
        throw file.damaged("compressed values");
}

/// Unpacks the one block that holds the head.
void unpackBloscHead(FileBytes& file, std::span<std::uint8_t> to) {
    const std::span<const char> packed = file.bytes(file.value<std::uint64_t>());
    std::size_t unpacked = 0, type = 0;
    int flags = 0;
    if (blosc_cbuffer_validate(packed.data(), packed.size(), &unpacked) != 0 ||
        unpacked < to.size())
        throw file.damaged("compressed values");
    blosc_cbuffer_metainfo(packed.data(), &type, &flags);
    if (type == 0 || type > 255) throw file.damaged("compressed values");
    const std::size_t items = (to.size() + type - 1) / type;
    std::vector<std::uint8_t> head(items * type);
    if (head.size() > unpacked || blosc_getitem(packed.data(), 0, static_cast<int>(items),
                                                head.data()) != static_cast<int>(head.size()))
        throw file.damaged("compressed values");
    std::copy_n(head.begin(), to.size(), to.begin());
}

void copyPlain(FileBytes& file, std::span<std::uint8_t> to) {
    constexpr std::size_t piece = 1 << 20;
    while (!to.empty()) {
        const std::span<const char> bytes = file.bytes(std::min(to.size(), piece));
        std::copy(bytes.begin(), bytes.end(), to.begin());
        to = to.subspan(bytes.size());
    }
}

}  // namespace

std::vector<NanoListing> listNanoGrids(FileBytes& file) {
    std::vector<NanoListing> grids;
    do {
        const SegmentHeader header = readHeader(file);
        const std::size_t first = grids.size();
        for (unsigned i = 0; i < header.gridCount; ++i) {
            grids.push_back(readEntry(file, header.codec));
            grids.back().version = header.version;
        }
        for (std::size_t i = first; i < grids.size(); ++i) {
            grids[i].begin = file.position();
            file.skip(grids[i].stored);
            requireSize(file, grids[i]);
        }
    } while (file.left() > 0);
    return grids;
}

NanoBuffer unpackNanoGrid(FileBytes& file, const NanoListing& grid) {
    if (const std::uint64_t limit = memoryLimit(); grid.size > limit)
        throw failure("cannot read grid '{}' of '{}': it has {}, and there are {} of memory",
                      grid.name, file.path().string(), formatGiB(static_cast<double>(grid.size)),
                      formatGiB(static_cast<double>(limit)));
    file.enter(grid.begin, grid.begin + grid.stored, fmt::format("grid '{}'", grid.name));
    NanoBuffer buffer = NanoBuffer::create(grid.size);
    const std::span<std::uint8_t> to(buffer.data(), buffer.size());
    if (grid.codec == NanoCodec::Blosc)
        unpackBlosc(file, to);
    else if (grid.codec == NanoCodec::Zip)
        unpackZip(file, to);
    else
        copyPlain(file, to);
    return buffer;
}

NanoBuffer unpackNanoHead(FileBytes& file, const NanoListing& grid, std::uint64_t bytes) {
    file.enter(grid.begin, grid.begin + grid.stored, fmt::format("grid '{}'", grid.name));
    NanoBuffer buffer = NanoBuffer::create(std::min(bytes, grid.size));
    const std::span<std::uint8_t> to(buffer.data(), buffer.size());
    if (grid.codec == NanoCodec::Blosc)
        unpackBloscHead(file, to);
    else if (grid.codec == NanoCodec::Zip)
        unpackZipHead(file, to);
    else
        copyPlain(file, to);
    return buffer;
}

}  // namespace woodcock::grid

#endif
