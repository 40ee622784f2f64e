// SPDX-License-Identifier: Apache-2.0
#include "woodcock/grid/vdb/write.h"

#include <openvdb/io/Archive.h>

#include <cerrno>
#include <fstream>
#include <system_error>
#include <vector>

#include "woodcock/base/error.h"
#include "woodcock/base/random.h"
#include "woodcock/base/whole_file.h"
#include "woodcock/grid/vdb/openvdb_grids.h"
#include "woodcock/grid/vdb/openvdb_trees.h"

namespace woodcock::grid {

namespace {

/// Magic number, version of the format and of the library (two numbers), flag of offsets.
constexpr std::streamoff identifierPlace = 8 + 4 + 4 + 4 + 1;
constexpr std::size_t identifierSize = 36;

/// OpenVDB's own File ignores a full disk; this one writes to a stream that throws.
class Writer : public openvdb::io::Archive {
public:
    using Archive::write;
};

std::uint32_t compressionFlags(VdbCompression compression) {
    switch (compression) {
        case VdbCompression::None:
            return openvdb::io::COMPRESS_NONE;
        case VdbCompression::Zip:
            return openvdb::io::COMPRESS_ZIP | openvdb::io::COMPRESS_ACTIVE_MASK;
        case VdbCompression::Blosc:
            break;
    }
    return openvdb::io::COMPRESS_BLOSC | openvdb::io::COMPRESS_ACTIVE_MASK;
}

/// Replaces the random identifier by a hash of the bytes after it.
void nameByContents(const std::filesystem::path& path) {
    std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
    file.seekg(identifierPlace + static_cast<std::streamoff>(identifierSize));
    std::uint64_t low = 1, high = 2;
    std::vector<std::uint64_t> block(1 << 16);
    while (file) {
        std::fill(block.begin(), block.end(), 0);
        file.read(reinterpret_cast<char*>(block.data()),
                  static_cast<std::streamsize>(block.size() * sizeof block[0]));
        const auto words = (static_cast<std::size_t>(file.gcount()) + 7) / 8;
        for (std::size_t i = 0; i < words; ++i)
            low = mixBits(low ^ block[i]), high = mixBits(high + block[i]);
    }
    file.clear();
    // Version 4, variant 1, as for a random identifier (RFC 4122).
    const std::string hex = fmt::format("{:016x}{:016x}", low, high);
    const std::string identifier =
        fmt::format("{}-{}-4{}-a{}-{}", hex.substr(0, 8), hex.substr(8, 4), hex.substr(13, 3),
                    hex.substr(17, 3), hex.substr(20, 12));
    file.seekp(identifierPlace);
    file.write(identifier.data(), static_cast<std::streamsize>(identifier.size()));
    file.close();
    if (!file) throw std::runtime_error("the file's identifier cannot be written");
}

}  // namespace

void writeVdb(const std::filesystem::path& file, const VdbGrids& grids,
              const VdbWriteOptions& options) {
    openvdb::initialize();
    if (options.compression == VdbCompression::Blosc &&
        !openvdb::io::Archive::hasBloscCompression())
        throw failure("cannot write '{}': this OpenVDB has no Blosc compression", file.string());
    openvdb::GridCPtrVec views;
    for (const openvdb::GridBase::Ptr& grid : grids.grids) {
        const openvdb::GridBase::Ptr view = grid->copyGrid();  // the tree is shared
        view->setTransform(grid->transformPtr());  // the copy's transform has lost digits
        view->setSaveFloatAsHalf(options.half);
        views.push_back(view);
    }
    openvdb::MetaMap metadata;
    for (const auto& [key, value] : options.metadata)
        metadata.insertMeta(key, openvdb::StringMetadata(value));
    FileInTheMaking making(file);
    try {
        std::ofstream out;
        out.exceptions(std::ios::failbit | std::ios::badbit);
        out.open(making.temporary(), std::ios::binary | std::ios::trunc);
        Writer writer;
        writer.setCompression(compressionFlags(options.compression));
        writer.write(out, views, true, metadata);
        out.close();
        nameByContents(making.temporary());
    } catch (const std::ios::failure&) {
        throw failure("cannot write '{}': {}", file.string(),
                      std::generic_category().message(errno ? errno : EIO));
    } catch (const std::exception& e) {
        throw failure("cannot write '{}': {}", file.string(), e.what());
    }
    making.commit();
}

}  // namespace woodcock::grid
