// SPDX-License-Identifier: Apache-2.0
#include "woodcock/grid/vdb/check_header.h"

#include <algorithm>
#include <cctype>
#include <string_view>

#include "woodcock/base/error.h"
#include "woodcock/base/printable.h"
#include "woodcock/grid/foreign_format.h"
#include "woodcock/grid/vdb/check_grid_head.h"
#include "woodcock/grid/vdb/check_tree.h"

namespace woodcock::grid {

namespace {

constexpr std::int64_t magic = 0x56444220;    // "VDB ", as a number
constexpr std::uint32_t oldestVersion = 222;  // OpenVDB 3 writes 222 or 223
constexpr std::uint32_t newestVersion = 225;  // OpenVDB 5 to 12 write 224, OpenVDB 13 writes 225
constexpr std::string_view halfSuffix = "_HalfFloat";

/// The unique names of a file mark their number by a control character: "density\x1e1".
std::string readableName(std::string name) {
    if (const auto mark = name.find('\x1e'); mark != std::string::npos) {
        name[mark] = '[';
        name += ']';
    }
    return printable(name);
}

Error notVdb(FileBytes& file) {
    const std::string name = file.path().string();
    file.seek(0);
    const std::span<const char> bytes =
        file.bytes(std::min<std::uint64_t>(file.size(), foreignBytes));
    const std::string_view beginning(bytes.data(), std::min<std::size_t>(bytes.size(), 16));
    if (beginning.empty()) return inputError("{} is not a VDB file: it is empty", name);
    if (const auto foreign = foreignFormat(bytes, file.path()))
        return inputError("{} is not a VDB file but {}; {}", name, foreign->what, foreign->way);
    std::string shown;
    for (char c : beginning) {
        const auto u = static_cast<unsigned char>(c);
        shown += std::isprint(u) ? std::string(1, c) : fmt::format("\\x{:02x}", u);
    }
    return inputError("{} is not a VDB file: it begins with \"{}\"", name, shown);
}

VdbHeader::Entry readEntry(FileBytes& file) {
    VdbHeader::Entry entry;
    entry.uniqueName = readableName(file.text());
    entry.treeType = printable(file.text());
    if (entry.treeType.ends_with(halfSuffix)) {
        entry.savedAsHalf = true;
        entry.treeType.resize(entry.treeType.size() - halfSuffix.size());
    }
    entry.treeOf = readableName(file.text());
    entry.begin = file.value<std::uint64_t>();
    file.value<std::uint64_t>();  // where its voxels begin
    entry.end = file.value<std::uint64_t>();
    return entry;
}

/// Goes to the next entry by its offset, which must not lead back.
void followOffsets(FileBytes& file, const VdbHeader::Entry& entry) {
    if (entry.begin < file.position() || entry.end < entry.begin)
        throw file.damaged(
            fmt::format("grid '{}' from byte {} to {}", entry.uniqueName, entry.begin, entry.end));
    if (entry.end > file.size())
        throw inputError("{} is cut short: grid '{}' ends at byte {}, the file at byte {}{}",
                         file.path().string(), entry.uniqueName, entry.end, file.size(),
                         file.wayOut());
    file.seek(entry.end);
}

/// In a stream, the next entry can only be found by walking through the grid.
void walkThrough(FileBytes& file, VdbHeader::Entry& entry) {
    entry.begin = file.position();
    const VdbGridHead head = readGridHead(file);
    if (entry.treeOf.empty()) {
        const VdbValueType type = valueTypeOf(entry.treeType);
        if (type.channels == 0)
            throw inputError(
                "{} was written as a stream, where grid '{}' of {} cannot be skipped; save it as a "
                "file (OpenVDB: io::File)",
                file.path().string(), entry.uniqueName, type.name);
        findLayout(file, type, head.compression, head.savedAsHalf);
    }
    entry.end = file.position();
}

}  // namespace

VdbHeader readVdbHeader(FileBytes& file) {
    file.enter(0, file.size(), "its list of grids");
    if (file.size() < sizeof magic || file.value<std::int64_t>() != magic) throw notVdb(file);
    VdbHeader header;
    header.fileVersion = file.value<std::uint32_t>();
    if (header.fileVersion < oldestVersion)
        throw inputError(
            "{} has VDB file format {}, older than the {} of OpenVDB 3; save it again "
            "with a newer program",
            file.path().string(), header.fileVersion, oldestVersion);
    if (header.fileVersion > newestVersion)
        file.setDoubt(
            fmt::format("its VDB file format, {}, is newer than {}, the newest that is "
                        "known (of OpenVDB 13)",
                        header.fileVersion, newestVersion));
    header.libraryMajor = file.value<std::uint32_t>();
    header.libraryMinor = file.value<std::uint32_t>();
    header.hasOffsets = file.value<char>() != 0;
    file.skip(36);                                            // the file's UUID
    for (auto n = file.value<std::uint32_t>(); n > 0; --n) {  // metadata: name, type, value
        file.text();
        file.text();
        file.skip(file.value<std::uint32_t>());
    }
    for (auto n = file.value<std::uint32_t>(); n > 0; --n) {
        VdbHeader::Entry entry = readEntry(file);
        if (header.hasOffsets)
            followOffsets(file, entry);
        else
            walkThrough(file, entry);
        header.entries.push_back(std::move(entry));
    }
    return header;
}

}  // namespace woodcock::grid
