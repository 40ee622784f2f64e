// SPDX-License-Identifier: Apache-2.0
#include "woodcock/grid/vdb/check_tree.h"

#include <algorithm>
#include <array>
#include <bit>
#include <limits>
#include <string_view>

namespace woodcock::grid {

namespace {

// Flags of a grid, and the byte that says how a node stores its inactive values: from OpenVDB's
// io/Compression.h.
constexpr std::uint32_t zip = 1, activeMask = 2, blosc = 4;
enum NodeValues : std::uint8_t {
    OneInactive = 2,
    MaskOnly = 3,
    MaskAndOneInactive = 4,
    MaskAndTwoInactive = 5,
    AllValues = 6
};

constexpr int upperLog2 = 5, lowerLog2 = 4, leafLog2 = 3;
constexpr std::uint64_t maskBytes(int log2) { return (1u << (3 * log2)) / 8; }

class LayoutReader {
public:
    LayoutReader(FileBytes& file, const VdbValueType& type, std::uint32_t compression, bool half)
        : file_(file),
          type_(type),
          compression_(compression),
          half_(half && type.halfBytes > 0),
          storedBytes_(half_ ? type.halfBytes : type.bytes) {
        if (compression > (zip | activeMask | blosc))
            throw file_.damaged(fmt::format("unknown compression {:#x}", compression));
    }

    VdbLayout read() {
        VdbLayout layout;
        layout.topology = file_.position();
        readRoot();
        // Each leaf stores its mask here and again with its voxels.
        if (leaves_ > file_.left() / maskBytes(leafLog2))
            throw file_.damaged(fmt::format("{} leaves", leaves_));
        layout.leaves.reserve(leaves_);
        for (std::uint64_t i = 0; i < leaves_; ++i) {
            layout.leaves.push_back(file_.position());
            readLeafVoxels();
        }
        layout.end = file_.position();
        return layout;
    }

private:
    using Origin = std::array<std::int32_t, 3>;

    void readRoot() {
        if (const auto buffers = file_.value<std::int32_t>(); buffers != 1)
            throw file_.damaged(fmt::format("a tree with {} buffers", buffers));
        readPlainValue();  // the background
        const auto tiles = file_.value<std::uint32_t>(), children = file_.value<std::uint32_t>();
        std::vector<Origin> origins;
        for (std::uint32_t i = 0; i < tiles; ++i) {
            origins.push_back(readOrigin());
            readPlainValue();
            if (file_.value<std::uint8_t>() > 1) throw file_.damaged("a tile's state");
        }
        for (std::uint32_t i = 0; i < children; ++i) {
            origins.push_back(readOrigin());
            readNode(upperLog2);
        }
        std::sort(origins.begin(), origins.end());
        if (std::adjacent_find(origins.begin(), origins.end()) != origins.end())
            throw file_.damaged("two nodes of one place");
    }

    /// The origin of a root's tile or child. It must not be at the very end of the range of int, so
    /// that the voxels next to it have numbers as well.
    Origin readOrigin() {
        constexpr std::int32_t size = 1 << (upperLog2 + lowerLog2 + leafLog2),
                               lowest = std::numeric_limits<std::int32_t>::min(),
                               highest = std::numeric_limits<std::int32_t>::max();
        const auto origin = file_.value<Origin>();
        for (std::int32_t x : origin)
            if (x % size != 0 || x < lowest + size || x > highest - 2 * size)
                throw file_.damaged(fmt::format("a node at index {}", x));
        return origin;
    }

    void readPlainValue() { readPlainValues(type_.bytes); }

    void readPlainValues(std::uint64_t bytes) {
        if (type_.leaf == VdbValueType::Leaf::Values) return file_.skip(bytes);
        for (const char c : file_.bytes(bytes))
            if (static_cast<unsigned char>(c) > 1)
                throw file_.damaged("a value that is neither true nor false");
    }

    void readNode(int log2) {
        const std::uint64_t children = countBits(file_.bytes(maskBytes(log2)));
        readValues(log2, countBits(file_.bytes(maskBytes(log2))));
        if (log2 == upperLog2) {
            for (std::uint64_t i = 0; i < children; ++i) readNode(lowerLog2);
        } else {
            file_.skip(children * maskBytes(leafLog2));
            leaves_ += children;
        }
    }

    void readLeafVoxels() {
        const std::uint64_t mask = maskBytes(leafLog2);
        constexpr std::uint64_t origin = 12;
        switch (type_.leaf) {
            case VdbValueType::Leaf::Values:
                return readValues(leafLog2, countBits(file_.bytes(mask)));
            case VdbValueType::Leaf::Bits:
                return file_.skip(mask + origin);
            case VdbValueType::Leaf::BitsAndMask:
                return file_.skip(mask + origin + mask);
        }
    }

    void readValues(int log2, std::uint64_t active) {
        const auto kind = file_.value<std::uint8_t>();
        if (kind > AllValues) throw file_.damaged(fmt::format("values of unknown kind {}", kind));
        if (kind == OneInactive || kind == MaskAndOneInactive) readPlainValue();
        if (kind == MaskAndTwoInactive) readPlainValues(2 * type_.bytes);
        if (kind == MaskOnly || kind == MaskAndOneInactive || kind == MaskAndTwoInactive)
            file_.skip(maskBytes(log2));
        const bool onlyActive = (compression_ & activeMask) && kind != AllValues;
        readStored(onlyActive ? active : std::uint64_t(1) << (3 * log2));
    }

    void readStored(std::uint64_t count) {
        if (half_ && count == 0) return;
        const std::uint64_t bytes = count * storedBytes_;
        if (!(compression_ & (zip | blosc))) return readPlainValues(bytes);
        const auto stored = file_.value<std::int64_t>();
        if (stored <= 0) {  // not compressed, as that would not have saved bytes
            if (std::uint64_t(0) - static_cast<std::uint64_t>(stored) != bytes)
                throw file_.damaged(fmt::format("{} bytes where {} are needed", stored, bytes));
            return readPlainValues(bytes);
        }
        if (compression_ & blosc)
            skipBlosc(static_cast<std::uint64_t>(stored), bytes);
        else
            file_.skip(static_cast<std::uint64_t>(stored));
    }

    /// Blosc trusts the sizes in its own header, so they are checked here.
    void skipBlosc(std::uint64_t stored, std::uint64_t bytes) {
        struct Header {
            std::uint8_t version, codecVersion, flags, typeSize;
            std::uint32_t bytes, blockBytes, storedBytes;
        };
        if (stored < sizeof(Header)) throw file_.damaged("compressed values");
        const auto header = file_.value<Header>();
        if (header.bytes != bytes || header.storedBytes != stored)
            throw file_.damaged("the sizes of compressed values");
        file_.skip(stored - sizeof(Header));
    }

    static std::uint64_t countBits(std::span<const char> mask) {
        std::uint64_t count = 0;
        for (std::size_t i = 0; i < mask.size(); i += 8) {
            std::uint64_t word;
            std::memcpy(&word, mask.data() + i, 8);
            count += static_cast<std::uint64_t>(std::popcount(word));
        }
        return count;
    }

    FileBytes& file_;
    const VdbValueType& type_;
    std::uint32_t compression_;
    bool half_;
    std::uint64_t storedBytes_;
    std::uint64_t leaves_ = 0;
};

}  // namespace

VdbValueType valueTypeOf(const std::string& treeType) {
    constexpr std::string_view start = "Tree_", nodes = "_5_4_3";
    std::string name = treeType;
    if (name.starts_with(start)) name.erase(0, start.size());
    const bool usualNodes = name.ends_with(nodes);
    if (usualNodes) name.resize(name.size() - nodes.size());
    if (name == "ptdataidx32" || name == "ptidx32") return {"points", 0};
    using enum VdbValueType::Leaf;
    static const VdbValueType known[]{{"float", 1, 4, 2, Values},  {"half", 1, 2, 0, Values},
                                      {"double", 1, 8, 2, Values}, {"int32", 1, 4, 0, Values},
                                      {"int64", 1, 8, 0, Values},  {"bool", 1, 1, 0, BitsAndMask},
                                      {"mask", 1, 1, 0, Bits},     {"vec3s", 3, 12, 6, Values},
                                      {"vec3d", 3, 24, 6, Values}, {"vec3i", 3, 12, 0, Values}};
    for (const VdbValueType& type : known)
        if (usualNodes && name == type.name) return type;
    return {name, 0};
}

VdbLayout findLayout(FileBytes& file, const VdbValueType& type, std::uint32_t compression,
                     bool savedAsHalf) {
    return LayoutReader(file, type, compression, savedAsHalf).read();
}

}  // namespace woodcock::grid
