// SPDX-License-Identifier: Apache-2.0
#include "woodcock/convert/nanovdb_file.h"
#include "woodcock/base/error.h"
#include "woodcock/grid/openvdb_grids.h"

#ifdef WOODCOCK_WITH_NANOVDB
#include <nanovdb/NanoVDB.h>
#include <openvdb/openvdb.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <set>
#include <type_traits>

#include "woodcock/convert/nanovdb_segments.h"
#include "woodcock/base/memory.h"

namespace woodcock {

namespace fs = std::filesystem;

namespace {

/// Later versions keep the layout, but compute checksums in other ways.
constexpr unsigned lastKnownMinorVersion = 4;
constexpr std::uint32_t noChecksum = 0xffffffff;

/// What a grid begins with. Its root follows.
constexpr std::uint64_t headBytes = sizeof(nanovdb::GridData) + sizeof(nanovdb::TreeData<3>);

struct GridName {
    const fs::path& file;
    const std::string& grid;

    Error damaged(const std::string& what) const {
        return inputError("{} is damaged: grid '{}': {}", file.string(), grid, what);
    }
};

std::uint32_t hash(std::span<const std::uint8_t> bytes) {
    return static_cast<std::uint32_t>(crc32_z(0, bytes.data(), bytes.size()));
}

/// NanoVDB's hashes are of the fast type of 32 bits, which is wider on some machines than on
/// others, and their hash is of that type's bytes.
template <class T>
std::uint32_t hashOfHashes(const std::vector<std::uint32_t>& hashes) {
    const std::vector<T> wide(hashes.begin(), hashes.end());
    const auto* const bytes = reinterpret_cast<const std::uint8_t*>(wide.data());
    return hash({bytes, wide.size() * sizeof(T)});
}

float toFloat(auto v) { return static_cast<float>(v); }
template <class T>
openvdb::Vec3f toFloat(const nanovdb::Vec3<T>& v) {
    return {toFloat(v[0]), toFloat(v[1]), toFloat(v[2])};
}

/// Walks the nodes of a grid in memory. Every offset is checked before it is followed.
template <class BuildT>
class TreeReader {
    using NanoRoot = typename nanovdb::NanoRoot<BuildT>::DataType;
    using NanoUpper = typename nanovdb::NanoUpper<BuildT>::DataType;
    using NanoLower = typename nanovdb::NanoLower<BuildT>::DataType;
    using NanoLeaf = typename nanovdb::NanoLeaf<BuildT>::DataType;

public:
    using Grid = std::conditional_t<nanovdb::TensorTraits<typename NanoRoot::ValueT>::IsVector,
                                    openvdb::Vec3SGrid, openvdb::FloatGrid>;

    /// `bytes`: headBytes at least.
    TreeReader(const GridName& name, std::span<const std::uint8_t> bytes)
        : name_(name),
          bytes_(bytes),
          head_(*reinterpret_cast<const nanovdb::GridData*>(bytes.data())),
          treeHead_(*reinterpret_cast<const nanovdb::TreeData<3>*>(&head_ + 1)) {}

    typename Grid::Ptr read() {
        const std::uint64_t place = sizeof(nanovdb::GridData) + treeHead_.mNodeOffset[3];
        if (place < headBytes) throw name_.damaged("a root that lies before its tree");
        const auto& root = at<NanoRoot>(place, "its root");
        using Tile = typename NanoRoot::Tile;
        const std::uint64_t room = bytes_.size() - place - sizeof(NanoRoot);
        if (root.mTableSize > room / sizeof(Tile))
            throw name_.damaged(fmt::format("a root of {} entries", root.mTableSize));
        requireHeadHash(headBytes + sizeof(NanoRoot) + root.mTableSize * sizeof(Tile));
        requireRoom();
        const auto grid = Grid::create(toFloat(root.mBackground));
        std::set<openvdb::Coord> origins;
        for (std::uint32_t i = 0; i < root.mTableSize; ++i) {
            const auto& tile = at<Tile>(place + sizeof(NanoRoot) + i * sizeof(Tile), "its root");
            const nanovdb::Coord corner = tile.origin();
            const openvdb::Coord origin(corner[0], corner[1], corner[2]);
            if (!origins.insert(origin).second)
                throw name_.damaged(fmt::format("two entries of its root at [{}, {}, {}]",
                                                origin.x(), origin.y(), origin.z()));
            if (tile.isChild())
                grid->tree().root().addChild(
                    readUpper(place + static_cast<std::uint64_t>(tile.child), origin).release());
            else
                grid->tree().root().addTile(origin, toFloat(tile.value), tile.state != 0);
        }
        for (std::size_t level = 0; level < 3; ++level)
            if (hashes_[level].size() != treeHead_.mNodeCount[level])
                throw name_.damaged(fmt::format("{} nodes of level {} where {} are expected",
                                                hashes_[level].size(), level,
                                                treeHead_.mNodeCount[level]));
        requireNodeHash(root.mTableSize == 0);
        return grid;
    }

private:
    using OpenUpper = typename Grid::TreeType::RootNodeType::ChildNodeType;
    using OpenLower = typename OpenUpper::ChildNodeType;
    using OpenLeaf = typename OpenLower::ChildNodeType;

    template <class T>
    const T& at(std::uint64_t place, const char* what) const {
        if (place % NanoBuffer::alignment != 0 || bytes_.size() < sizeof(T) ||
            place > bytes_.size() - sizeof(T))
            throw name_.damaged(fmt::format("{} at byte {} of {}", what, place, bytes_.size()));
        return *reinterpret_cast<const T*>(bytes_.data() + place);
    }

    /// Of as many nodes as the tree says it has: in the file, and as OpenVDB has them.
    void requireRoom() const {
        const std::uint32_t(&count)[3] = treeHead_.mNodeCount;
        if (count[0] * sizeof(NanoLeaf) + count[1] * sizeof(NanoLower) +
                count[2] * sizeof(NanoUpper) >
            bytes_.size())
            throw name_.damaged(fmt::format("{}, {} and {} nodes in {} bytes", count[2], count[1],
                                            count[0], bytes_.size()));
        using Value = typename Grid::ValueType;
        const std::size_t needed = bytes_.size() +
                                   count[0] * (sizeof(OpenLeaf) + OpenLeaf::SIZE * sizeof(Value)) +
                                   count[1] * sizeof(OpenLower) + count[2] * sizeof(OpenUpper);
        if (const std::uint64_t limit = memoryLimit(); needed > limit)
            throw failure("cannot read grid '{}' of '{}': it takes {}, and there are {} of memory",
                          name_.grid, name_.file.string(), formatGiB(static_cast<double>(needed)),
                          formatGiB(static_cast<double>(limit)));
    }

    /// One node that many refer to would become as many: there are no more than the tree says.
    template <class T>
    const T& node(std::size_t level, std::uint64_t place) {
        const T& found = at<T>(place, "a node");
        if (hashes_[level].size() >= treeHead_.mNodeCount[level])
            throw name_.damaged(
                fmt::format("more nodes of level {} than the {} that it should have", level,
                            treeHead_.mNodeCount[level]));
        hashes_[level].emplace_back(place, hash(bytes_.subspan(place, sizeof(T))));
        return found;
    }

    auto readUpper(std::uint64_t place, const openvdb::Coord& origin) {
        return readInternal<OpenUpper>(
            node<NanoUpper>(2, place), place, origin,
            [this](std::uint64_t p, const openvdb::Coord& o) { return readLower(p, o); });
    }
    auto readLower(std::uint64_t place, const openvdb::Coord& origin) {
        return readInternal<OpenLower>(
            node<NanoLower>(1, place), place, origin,
            [this](std::uint64_t p, const openvdb::Coord& o) { return readLeaf(p, o); });
    }

    /// Where a node lies follows from its parent: those without active voxels say nothing right.
    template <class Node, class Source, class ReadChild>
    std::unique_ptr<Node> readInternal(const Source& source, std::uint64_t place,
                                       const openvdb::Coord& origin, const ReadChild& readChild) {
        auto target = std::make_unique<Node>(origin, typename Node::ValueType(0.0f), false);
        for (openvdb::Index n = 0; n < Node::NUM_VALUES; ++n)
            if (source.mChildMask.isOn(n))
                target->addChild(
                    readChild(place + static_cast<std::uint64_t>(source.mTable[n].child),
                              target->offsetToGlobalCoord(n))
                        .release());
            else
                target->addTile(n, toFloat(source.mTable[n].value), source.mValueMask.isOn(n));
        return target;
    }

    std::unique_ptr<OpenLeaf> readLeaf(std::uint64_t place, const openvdb::Coord& origin) {
        const auto& source = node<NanoLeaf>(0, place);
        if constexpr (std::is_same_v<BuildT, nanovdb::FpN>) {
            constexpr unsigned mostBits = 16;
            const unsigned bits = source.bitWidth();
            if (bits > mostBits)
                throw name_.damaged(fmt::format("a leaf of {} bits a voxel", bits));
            if (bits * OpenLeaf::SIZE / 8 > bytes_.size() - place - sizeof(NanoLeaf))
                throw name_.damaged("a leaf that reaches beyond the end");
        }
        auto target = std::make_unique<OpenLeaf>(origin, typename OpenLeaf::ValueType(0.0f), false);
        for (openvdb::Index n = 0; n < OpenLeaf::SIZE; ++n)
            target->setValueOnly(n, toFloat(source.getValue(n)));
        typename OpenLeaf::NodeMaskType mask;
        for (openvdb::Index n = 0; n < OpenLeaf::SIZE; ++n)
            if (source.mValueMask.isOn(n)) mask.setOn(n);
        target->setValueMask(mask);
        return target;
    }

    bool hasKnownHashes() const { return head_.mVersion.getMinor() <= lastKnownMinorVersion; }

    /// The lower half of the checksum: of all that comes before the nodes.
    void requireHeadHash(std::uint64_t end) const {
        constexpr std::size_t begin = 16;  // after the magic number and the checksum itself
        const auto expected = static_cast<std::uint32_t>(head_.mChecksum);
        if (hasKnownHashes() && expected != noChecksum &&
            expected != hash(bytes_.subspan(begin, end - begin)))
            throw name_.damaged("the checksum of its head is wrong");
    }

    /// The upper half: of the hashes of all nodes, from the top.
    void requireNodeHash(bool isEmpty) {
        const auto expected = static_cast<std::uint32_t>(head_.mChecksum >> 32);
        if (!hasKnownHashes() || expected == noChecksum || isEmpty) return;
        std::vector<std::uint32_t> hashes;
        const auto inOrder = static_cast<std::uint32_t>(nanovdb::GridFlags::IsBreadthFirst);
        for (std::size_t level = 3; level-- > 0;) {
            if (head_.mFlags & inOrder) std::sort(hashes_[level].begin(), hashes_[level].end());
            for (const auto& [place, nodeHash] : hashes_[level]) hashes.push_back(nodeHash);
        }
        if (expected != hashOfHashes<std::uint64_t>(hashes) &&
            expected != hashOfHashes<std::uint32_t>(hashes))
            throw name_.damaged("the checksum of its nodes is wrong");
    }

    GridName name_;
    std::span<const std::uint8_t> bytes_;
    const nanovdb::GridData& head_;
    const nanovdb::TreeData<3>& treeHead_;
    /// Of leaves, lower and upper nodes: place and hash.
    std::array<std::vector<std::pair<std::uint64_t, std::uint32_t>>, 3> hashes_;
};

openvdb::math::Transform::Ptr readTransform(const GridName& name, const nanovdb::Map& map) {
    openvdb::math::Mat4d matrix = openvdb::math::Mat4d::identity();
    for (int row = 0; row < 3; ++row) {
        matrix(3, row) = map.mVecD[row];
        for (int column = 0; column < 3; ++column)  // OpenVDB's multiply from the left
            matrix(column, row) = map.mMatD[3 * row + column];
    }
    for (int i = 0; i < 16; ++i)
        if (!std::isfinite(matrix.asPointer()[i]))
            throw name.damaged("a transform that is not finite");
    try {
        return openvdb::math::Transform::createLinearTransform(matrix);
    } catch (const openvdb::Exception& e) {
        throw name.damaged(fmt::format("a transform that is none ({})", e.what()));
    }
}

openvdb::GridClass readClass(nanovdb::GridClass gridClass) {
    switch (gridClass) {
        case nanovdb::GridClass::LevelSet:
            return openvdb::GRID_LEVEL_SET;
        case nanovdb::GridClass::FogVolume:
            return openvdb::GRID_FOG_VOLUME;
        case nanovdb::GridClass::Staggered:
            return openvdb::GRID_STAGGERED;
        default:
            return openvdb::GRID_UNKNOWN;
    }
}

openvdb::GridBase::Ptr readTree(const GridName& name, std::span<const std::uint8_t> bytes,
                                nanovdb::GridType type) {
    switch (type) {
        case nanovdb::GridType::Float:
            return TreeReader<float>(name, bytes).read();
        case nanovdb::GridType::Double:
            return TreeReader<double>(name, bytes).read();
        case nanovdb::GridType::Int32:
            return TreeReader<std::int32_t>(name, bytes).read();
        case nanovdb::GridType::Int64:
            return TreeReader<std::int64_t>(name, bytes).read();
        case nanovdb::GridType::Vec3f:
            return TreeReader<nanovdb::Vec3f>(name, bytes).read();
        case nanovdb::GridType::Vec3d:
            return TreeReader<nanovdb::Vec3d>(name, bytes).read();
        case nanovdb::GridType::Fp4:
            return TreeReader<nanovdb::Fp4>(name, bytes).read();
        case nanovdb::GridType::Fp8:
            return TreeReader<nanovdb::Fp8>(name, bytes).read();
        case nanovdb::GridType::Fp16:
            return TreeReader<nanovdb::Fp16>(name, bytes).read();
        case nanovdb::GridType::FpN:
            return TreeReader<nanovdb::FpN>(name, bytes).read();
        default:
            break;
    }
    throw inputError(
        "{}: grid '{}' holds {}, where float, double, int32, int64, Vec3f, Vec3d or quantised "
        "float "
        "are expected",
        name.file.string(), name.grid,
        type < nanovdb::GridType::End
            ? nanovdb::toStr(type)
            : fmt::format("an unknown type {}", static_cast<std::uint32_t>(type)));
}

openvdb::GridBase::Ptr readGrid(FileBytes& file, const NanoListing& listing) {
    const GridName name{file.path(), listing.name};
    const NanoBuffer buffer = unpackNanoGrid(file, listing);
    if (buffer.size() < headBytes)
        throw name.damaged(fmt::format("it has {} bytes", buffer.size()));
    const auto& head = *reinterpret_cast<const nanovdb::GridData*>(buffer.data());
    constexpr std::uint64_t newerMagic = 0x314244566f6e614e;  // "NanoVDB1"
    if (head.mMagic != NANOVDB_MAGIC_NUMBER && head.mMagic != newerMagic)
        throw name.damaged("it does not begin with 'NanoVDB0'");
    if (const unsigned major = head.mVersion.getMajor(); major != NANOVDB_MAJOR_VERSION_NUMBER)
        throw name.damaged(fmt::format("it is of format {}, where {} is expected", major,
                                       NANOVDB_MAJOR_VERSION_NUMBER));
    if (head.mGridSize > buffer.size() || head.mGridSize < headBytes)
        throw name.damaged(
            fmt::format("it has {} bytes and says {}", buffer.size(), head.mGridSize));
    const openvdb::GridBase::Ptr grid =
        readTree(name, {buffer.data(), static_cast<std::size_t>(head.mGridSize)}, head.mGridType);
    grid->setTransform(readTransform(name, head.mMap));
    grid->setName(listing.name);
    grid->setGridClass(readClass(head.mGridClass));
    return grid;
}

}  // namespace

VdbGrids readNanoVdb(const fs::path& path) {
    openvdb::initialize();
    FileBytes file(path);
    const std::vector<NanoListing> listings = listNanoGrids(file);
    VdbGrids grids;
    for (const NanoListing& listing : listings) grids.grids.push_back(readGrid(file, listing));
    return grids;
}

}  // namespace woodcock

#else

namespace woodcock {

VdbGrids readNanoVdb(const std::filesystem::path& file) {
    throw failure(
        "cannot read '{}': this build has no NanoVDB; install libnanovdb-dev and configure again",
        file.string());
}

}  // namespace woodcock

#endif
