// SPDX-License-Identifier: Apache-2.0
#include "woodcock/grid/nanovdb/file.h"

#include <algorithm>
#include <string_view>

#include "woodcock/base/error.h"
#include "woodcock/grid/vdb/openvdb_grids.h"

namespace woodcock::grid {

bool isNanoVdb(FileBytes& file) {
    constexpr std::string_view name = "NanoVDB";
    file.enter(0, file.size(), "its header");
    if (file.left() < 8) return false;
    const std::span<const char> bytes = file.bytes(8);
    const std::string_view beginning(bytes.data(), 8);
    const bool turned = std::equal(name.rbegin(), name.rend(), beginning.begin() + 1);
    file.seek(0);
    return beginning.starts_with(name) || turned;
}

}  // namespace woodcock::grid

#ifdef WOODCOCK_WITH_NANOVDB
#include <nanovdb/NanoVDB.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <set>
#include <type_traits>

#include "woodcock/base/memory.h"
#include "woodcock/base/printable.h"
#include "woodcock/grid/nanovdb/segments.h"
#include "woodcock/grid/vdb/openvdb_transform.h"
#include "woodcock/grid/vdb/openvdb_trees.h"

namespace woodcock::grid {

namespace fs = std::filesystem;

namespace {

/// Later versions keep the layout, but compute checksums in other ways.
constexpr unsigned lastKnownMinorVersion = 4;
constexpr std::uint32_t noChecksum = 0xffffffff;

/// The beginning of a grid. Its root follows.
constexpr std::uint64_t headBytes = sizeof(nanovdb::GridData) + sizeof(nanovdb::TreeData<3>);

struct GridName {
    fs::path file;
    std::string grid;

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

template <class T>
T toOpen(T v) {
    return v;
}
template <class T>
openvdb::math::Vec3<T> toOpen(const nanovdb::Vec3<T>& v) {
    return {v[0], v[1], v[2]};
}

/// Walks the nodes of a grid in memory. Every offset is checked before it is followed.
template <class BuildT>
class TreeReader {
    using NanoRoot = typename nanovdb::NanoRoot<BuildT>::DataType;
    using NanoUpper = typename nanovdb::NanoUpper<BuildT>::DataType;
    using NanoLower = typename nanovdb::NanoLower<BuildT>::DataType;
    using NanoLeaf = typename nanovdb::NanoLeaf<BuildT>::DataType;

public:
    using Value = decltype(toOpen(std::declval<typename NanoRoot::ValueT>()));
    using Grid = openvdb::Grid<typename openvdb::tree::Tree4<Value, 5, 4, 3>::Type>;

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
        const auto grid = Grid::create(toOpen(root.mBackground));
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
                grid->tree().root().addTile(origin, toOpen(tile.value), tile.state != 0);
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

    /// Checks that memory holds as many nodes as the tree claims: those of the file, and those of
    /// OpenVDB.
    void requireRoom() const {
        const std::uint32_t(&count)[3] = treeHead_.mNodeCount;
        if (count[0] * sizeof(NanoLeaf) + count[1] * sizeof(NanoLower) +
                count[2] * sizeof(NanoUpper) >
            bytes_.size())
            throw name_.damaged(fmt::format("{}, {} and {} nodes in {} bytes", count[2], count[1],
                                            count[0], bytes_.size()));
        const std::size_t needed = bytes_.size() +
                                   count[0] * (sizeof(OpenLeaf) + OpenLeaf::SIZE * sizeof(Value)) +
                                   count[1] * sizeof(OpenLower) + count[2] * sizeof(OpenUpper);
        if (const std::uint64_t limit = memoryLimit(); needed > limit)
            throw failure("cannot read grid '{}' of '{}': it takes {}, and there are {} of memory",
                          name_.grid, name_.file.string(), formatGiB(static_cast<double>(needed)),
                          formatGiB(static_cast<double>(limit)));
    }

    /// A node that many refer to would be copied as often: so the nodes are counted, and there must
    /// not be more than the tree claims.
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

    /// A node's position follows from its parent: nodes without active voxels do not store a right
    /// one.
    template <class Node, class Source, class ReadChild>
    std::unique_ptr<Node> readInternal(const Source& source, std::uint64_t place,
                                       const openvdb::Coord& origin, const ReadChild& readChild) {
        auto target = std::make_unique<Node>(origin, openvdb::zeroVal<Value>(), false);
        for (openvdb::Index n = 0; n < Node::NUM_VALUES; ++n)
            if (source.mChildMask.isOn(n))
                target->addChild(
                    readChild(place + static_cast<std::uint64_t>(source.mTable[n].child),
                              target->offsetToGlobalCoord(n))
                        .release());
            else
                target->addTile(n, toOpen(source.mTable[n].value), source.mValueMask.isOn(n));
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
        auto target = std::make_unique<OpenLeaf>(origin, openvdb::zeroVal<Value>(), false);
        for (openvdb::Index n = 0; n < OpenLeaf::SIZE; ++n)
            target->setValueOnly(n, toOpen(source.getValue(n)));
        typename OpenLeaf::NodeMaskType mask;
        for (openvdb::Index n = 0; n < OpenLeaf::SIZE; ++n)
            if (source.mValueMask.isOn(n)) mask.setOn(n);
        target->setValueMask(mask);
        return target;
    }

    bool hasKnownHashes() const { return head_.mVersion.getMinor() <= lastKnownMinorVersion; }

    /// Checks the lower half of the checksum: of everything before the nodes.
    void requireHeadHash(std::uint64_t end) const {
        constexpr std::size_t begin = 16;  // after the magic number and the checksum itself
        const auto expected = static_cast<std::uint32_t>(head_.mChecksum);
        if (hasKnownHashes() && expected != noChecksum &&
            expected != hash(bytes_.subspan(begin, end - begin)))
            throw name_.damaged("the checksum of its head is wrong");
    }

    /// Checks the upper half of the checksum: of the hashes of all nodes, from the top.
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

Affine3d affineOf(const nanovdb::Map& map) {
    Affine3d affine;
    for (int row = 0; row < 3; ++row) {
        affine.translation[row] = map.mVecD[row];
        for (int column = 0; column < 3; ++column)
            affine.column[static_cast<std::size_t>(column)][row] = map.mMatD[3 * row + column];
    }
    return affine;
}

openvdb::math::Transform::Ptr readTransform(const GridName& name, const Affine3d& map) {
    if (const std::string flaw = flawOf(map); !flaw.empty())
        throw name.damaged("its transform " + flaw);
    try {
        return openVdbTransform(map);
    } catch (const Error& e) {
        throw inputError("{}: grid '{}': {}", name.file.string(), name.grid, e.what());
    }
}

GridClass classOf(nanovdb::GridClass gridClass) {
    switch (gridClass) {
        case nanovdb::GridClass::LevelSet:
            return GridClass::LevelSet;
        case nanovdb::GridClass::FogVolume:
            return GridClass::FogVolume;
        case nanovdb::GridClass::Staggered:
            return GridClass::Staggered;
        default:
            return GridClass::Unknown;
    }
}

openvdb::GridClass openClassOf(GridClass gridClass) {
    switch (gridClass) {
        case GridClass::LevelSet:
            return openvdb::GRID_LEVEL_SET;
        case GridClass::FogVolume:
            return openvdb::GRID_FOG_VOLUME;
        case GridClass::Staggered:
            return openvdb::GRID_STAGGERED;
        case GridClass::Unknown:
            break;
    }
    return openvdb::GRID_UNKNOWN;
}

using ReadTree = openvdb::GridBase::Ptr (*)(const GridName&, std::span<const std::uint8_t>);

template <class BuildT>
openvdb::GridBase::Ptr readTree(const GridName& name, std::span<const std::uint8_t> bytes) {
    return TreeReader<BuildT>(name, bytes).read();
}

struct ValueType {
    const char* name;  ///< OpenVDB's where it has one
    int channels = 0;
    ReadTree read = nullptr;
};

/// By NanoVDB's numbers for them; later versions know more than the headers of this build may.
constexpr std::array<ValueType, 27> valueTypes{{{"nothing that is known"},
                                                {"float", 1, readTree<float>},
                                                {"double", 1, readTree<double>},
                                                {"int16"},
                                                {"int32", 1, readTree<std::int32_t>},
                                                {"int64", 1, readTree<std::int64_t>},
                                                {"vec3s", 3, readTree<nanovdb::Vec3f>},
                                                {"vec3d", 3, readTree<nanovdb::Vec3d>},
                                                {"mask"},
                                                {"half"},
                                                {"uint32"},
                                                {"bool"},
                                                {"RGBA8"},
                                                {"Fp4", 1, readTree<nanovdb::Fp4>},
                                                {"Fp8", 1, readTree<nanovdb::Fp8>},
                                                {"Fp16", 1, readTree<nanovdb::Fp16>},
                                                {"FpN", 1, readTree<nanovdb::FpN>},
                                                {"vec4f"},
                                                {"vec4d"},
                                                {"index"},
                                                {"index of active voxels"},
                                                {"index and mask"},
                                                {"index of active voxels and mask"},
                                                {"index of points"},
                                                {"vec3u8"},
                                                {"vec3u16"},
                                                {"uint8"}}};
constexpr std::uint32_t pointIndex = 4, pointData = 5;  // classes

std::string typeName(const nanovdb::GridData& head) {
    const auto type = static_cast<std::uint32_t>(head.mGridType);
    const auto gridClass = static_cast<std::uint32_t>(head.mGridClass);
    const std::string name = type < valueTypes.size() ? std::string(valueTypes[type].name)
                                                      : fmt::format("unknown type {}", type);
    return gridClass == pointIndex || gridClass == pointData ? "points (" + name + ")" : name;
}

ValueType valueTypeOf(const nanovdb::GridData& head) {
    const auto type = static_cast<std::uint32_t>(head.mGridType);
    const auto gridClass = static_cast<std::uint32_t>(head.mGridClass);
    if (type >= valueTypes.size() || gridClass == pointIndex || gridClass == pointData) return {};
    return valueTypes[type];
}

/// The first bytes of a grid as its head, which they are.
const nanovdb::GridData& requireHead(const GridName& name, const NanoBuffer& buffer,
                                     std::uint64_t gridBytes) {
    if (gridBytes < headBytes || buffer.size() < sizeof(nanovdb::GridData))
        throw name.damaged(fmt::format("it has {} bytes", gridBytes));
    const auto& head = *reinterpret_cast<const nanovdb::GridData*>(buffer.data());
    constexpr std::uint64_t newerMagic = 0x314244566f6e614e;  // "NanoVDB1"
    if (head.mMagic != NANOVDB_MAGIC_NUMBER && head.mMagic != newerMagic)
        throw name.damaged("it does not begin with 'NanoVDB0'");
    if (const unsigned major = head.mVersion.getMajor(); major != NANOVDB_MAJOR_VERSION_NUMBER)
        throw name.damaged(fmt::format("it is of format {}, where {} is expected", major,
                                       NANOVDB_MAJOR_VERSION_NUMBER));
    if (head.mGridSize > gridBytes || head.mGridSize < headBytes)
        throw name.damaged(
            fmt::format("it has {} bytes, and its head says {}", gridBytes, head.mGridSize));
    return head;
}

NanoVdbHead readHead(FileBytes& file, const NanoListing& listing) {
    NanoVdbHead head;
    head.name = printable(listing.name);
    head.fileBytes = listing.stored;
    const GridName name{file.path(), head.name};
    try {
        const NanoBuffer buffer = unpackNanoHead(file, listing, headBytes);
        const nanovdb::GridData& data = requireHead(name, buffer, listing.size);
        head.valueType = typeName(data);
        head.channels = valueTypeOf(data).channels;
        head.gridClass = classOf(data.mGridClass);
        head.worldFromIndex = affineOf(data.mMap);
    } catch (const Error& e) {
        if (e.kind() != ErrorKind::Input) throw;
        head.valueType = "unknown";
        head.fault = e.what();
    }
    return head;
}

}  // namespace

bool hasNanoVdb() { return true; }

NanoVdbHeads readNanoVdbHeads(FileBytes& file) {
    const std::vector<NanoListing> listings = listNanoGrids(file);
    const unsigned version = listings.front().version;
    NanoVdbHeads heads{fmt::format("NanoVDB {}.{}", version >> 21, version >> 10 & 0x7ff), {}};
    for (const NanoListing& listing : listings) heads.grids.push_back(readHead(file, listing));
    return heads;
}

VdbGrids readNanoVdbGrid(const fs::path& path, std::size_t index) {
    openvdb::initialize();
    FileBytes file(path);
    const NanoListing listing = listNanoGrids(file).at(index);
    const GridName name{file.path(), printable(listing.name)};
    const NanoBuffer buffer = unpackNanoGrid(file, listing);
    const nanovdb::GridData& head = requireHead(name, buffer, buffer.size());
    const ValueType type = valueTypeOf(head);
    if (!type.read)
        throw inputError("{}: grid '{}' holds {}, which are not numbers that can be read",
                         path.string(), name.grid, typeName(head));
    const openvdb::GridBase::Ptr grid =
        type.read(name, {buffer.data(), static_cast<std::size_t>(head.mGridSize)});
    grid->setTransform(readTransform(name, affineOf(head.mMap)));
    grid->setName(listing.name);
    grid->setGridClass(openClassOf(classOf(head.mGridClass)));
    return {{grid}};
}

}  // namespace woodcock::grid

#else

namespace woodcock::grid {

bool hasNanoVdb() { return false; }

namespace {
Error noNanoVdb(const std::filesystem::path& file) {
    return failure(
        "cannot read '{}': this build has no NanoVDB; install libnanovdb-dev and configure again",
        file.string());
}
}  // namespace

NanoVdbHeads readNanoVdbHeads(FileBytes& file) { throw noNanoVdb(file.path()); }

VdbGrids readNanoVdbGrid(const std::filesystem::path& file, std::size_t) { throw noNanoVdb(file); }

}  // namespace woodcock::grid

#endif
