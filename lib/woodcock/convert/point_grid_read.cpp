// SPDX-License-Identifier: Apache-2.0
#include "woodcock/convert/point_grid_read.h"

#include <openvdb/points/StreamCompression.h>

#include <algorithm>
#include <bit>
#include <map>
#include <optional>

#include "woodcock/grid/half.h"
#include "woodcock/grid/vdb/check_grid_head.h"
#include "woodcock/grid/vdb/check_header.h"

namespace woodcock::convert {

namespace {

// The format is that of openvdb/points/PointDataGrid.h. After the topology come passes over all
// leaves: sizes, attributes, for each the heads of its pages, counts, and for each its pages.

/// Bits of a node's mask, as words of 64.
using Mask = std::vector<std::uint64_t>;

struct Attribute {
    std::string name, type, codec;
};

/// Of one attribute in one leaf.
struct ArrayHead {
    std::uint64_t bytes = 0;
    std::uint32_t size = 0;
    bool uniform = false, paged = false;
};

struct PointLeaf {
    std::array<int, 3> origin{};
    std::vector<ArrayHead> arrays;
    std::vector<std::uint32_t> ends;  ///< of each voxel: the number of its last point + 1
};

constexpr std::uint64_t mostPointsBeyond = 1'000'000, pointsPerByte = 4;

class PointReader {
public:
    PointReader(grid::FileBytes& file, const Affine3d& worldFromIndex, std::uint32_t compression)
        : file_(file),
          worldFromIndex_(worldFromIndex),
          compression_(compression),
          mostPoints_(mostPointsBeyond + pointsPerByte * file.size()) {}

    PointCloud read() {
        readRoot();
        const auto passes = file_.value<std::uint16_t>();
        if (leaves_.empty()) return finish();
        file_.skip(2 * leaves_.size());  // the sizes of counts, which stand there again
        for (PointLeaf& leaf : leaves_) readArrays(leaf);
        if (passes != 2 * attributes_.size() + 4)
            throw file_.damaged(
                fmt::format("{} passes for {} attributes", passes, attributes_.size()));
        std::vector<std::vector<Page>> pages;
        for (std::size_t a = 0; a < attributes_.size(); ++a) pages.push_back(readPageHeads(a));
        for (PointLeaf& leaf : leaves_) readCounts(leaf);
        for (std::size_t a = 0; a < attributes_.size(); ++a) readAttribute(a, pages[a]);
        return finish();
    }

private:
    struct Page {
        std::uint64_t stored, bytes;
        bool compressed;
    };

    Mask readMask(int log2) {
        Mask mask((std::size_t(1) << (3 * log2)) / 64);
        std::memcpy(mask.data(), file_.bytes(8 * mask.size()).data(), 8 * mask.size());
        return mask;
    }

    template <class Use>
    static void forBits(const Mask& mask, Use use) {
        for (std::size_t w = 0; w < mask.size(); ++w)
            for (std::uint64_t bits = mask[w]; bits != 0; bits &= bits - 1)
                use(static_cast<int>(64 * w) + std::countr_zero(bits));
    }

    void readRoot() {
        file_.value<std::int32_t>();  // buffers, which the passes say again
        file_.skip(4);                // the background
        const auto tiles = file_.value<std::uint32_t>(), children = file_.value<std::uint32_t>();
        file_.skip(std::uint64_t{tiles} * (12 + 4 + 1));
        for (std::uint32_t i = 0; i < children; ++i) {
            const auto origin = file_.value<std::array<int, 3>>();
            for (const int x : origin)
                if (x % 4096 != 0 || std::abs(std::int64_t{x}) > (std::int64_t{1} << 31) - 8192)
                    throw file_.damaged(fmt::format("a node at index {}", x));
            readNode(5, 4096 / 32, origin);
        }
    }

    void readNode(int log2, int childSize, std::array<int, 3> origin) {
        const Mask children = readMask(log2), values = readMask(log2);
        skipValues(values);
        const int mask = (1 << log2) - 1;
        std::vector<std::array<int, 3>> places;
        forBits(children, [&](int n) {
            places.push_back({origin[0] + childSize * (n >> (2 * log2)),
                              origin[1] + childSize * ((n >> log2) & mask),
                              origin[2] + childSize * (n & mask)});
        });
        for (const std::array<int, 3>& place : places) {
            if (log2 == 5) {
                readNode(4, 8, place);
            } else {
                file_.skip(64);  // the leaf's mask stands with its counts again
                leaves_.push_back({place, {}, {}});
            }
        }
    }

    /// Of an inner node: tiles, which hold no points.
    void skipValues(const Mask& active) {
        constexpr std::uint8_t oneInactive = 2, maskOnly = 3, maskAndTwo = 5, all = 6;
        constexpr std::uint32_t zip = 1, activeMask = 2, blosc = 4;
        const auto kind = file_.value<std::uint8_t>();
        if (kind > all) throw file_.damaged(fmt::format("values of unknown kind {}", kind));
        if (kind == oneInactive || kind == 4) file_.skip(4);
        if (kind == maskAndTwo) file_.skip(8);
        if (kind >= maskOnly && kind <= maskAndTwo) file_.skip(8 * active.size());
        std::uint64_t count = 64 * active.size();
        if ((compression_ & activeMask) && kind != all) {
            count = 0;
            for (const std::uint64_t word : active) count += std::uint64_t(std::popcount(word));
        }
        if (!(compression_ & (zip | blosc))) return file_.skip(4 * count);
        const auto stored = file_.value<std::int64_t>();
        file_.skip(stored > 0 ? static_cast<std::uint64_t>(stored)
                              : std::uint64_t(0) - static_cast<std::uint64_t>(stored));
    }

    void readArrays(PointLeaf& leaf) {
        if (!known_) {
            const auto header = file_.value<std::uint8_t>();
            if (header > 3) throw file_.damaged("attributes of an unknown kind");
            std::vector<Attribute> found = readDescriptor();
            if (header & 2) file_.skip(file_.value<std::uint64_t>());
            known_ = header & 1;
            if (attributes_.empty())
                attributes_ = std::move(found);
            else if (found.size() != attributes_.size() ||
                     !std::equal(found.begin(), found.end(), attributes_.begin(),
                                 [](const Attribute& a, const Attribute& b) {
                                     return a.name == b.name && a.type == b.type &&
                                            a.codec == b.codec;
                                 }))
                throw inputError("{}: its leaves have different attributes", file_.path().string());
        }
        for (std::size_t a = 0; a < attributes_.size(); ++a) {
            ArrayHead head;
            constexpr std::uint64_t own = 2 + 4;  // flags and size are counted with the bytes
            head.bytes = file_.value<std::uint64_t>() - own;
            file_.value<std::uint8_t>();
            const auto flags = file_.value<std::uint8_t>();
            head.size = file_.value<std::uint32_t>();
            if (flags >= 16) throw file_.damaged("an attribute of an unknown kind");
            if (flags & 1) file_.skip(4);  // a stride
            head.uniform = flags & 2;
            head.paged = flags & 8;
            leaf.arrays.push_back(head);
        }
    }

    std::vector<Attribute> readDescriptor() {
        const auto count = file_.value<std::uint64_t>();
        if (count > file_.left() / 16 || count > 1000)
            throw file_.damaged(fmt::format("{} attributes", count));
        std::vector<Attribute> found(count);
        for (Attribute& attribute : found) {
            attribute.type = file_.text();
            attribute.codec = file_.text();
        }
        for (std::uint64_t i = 0; i < count; ++i) {
            std::string name = file_.text();
            const auto place = file_.value<std::uint64_t>();
            if (place >= count)
                throw file_.damaged(fmt::format("attribute {} of {}", place, count));
            found[place].name = std::move(name);
        }
        for (auto groups = file_.value<std::uint64_t>(); groups > 0; --groups) {
            file_.text();
            file_.skip(8);
        }
        for (auto n = file_.value<std::uint32_t>(); n > 0; --n) {  // metadata: name, type, value
            file_.text();
            file_.text();
            file_.skip(file_.value<std::uint32_t>());
        }
        return found;
    }

    std::vector<Page> readPageHeads(std::size_t a) {
        std::vector<Page> pages;
        std::uint64_t at = 0, end = 0;
        for (const PointLeaf& leaf : leaves_) {
            const ArrayHead& head = leaf.arrays[a];
            if (!head.paged) continue;
            if (at >= end) {
                const auto stored = file_.value<std::int32_t>();
                Page page{static_cast<std::uint64_t>(std::abs(std::int64_t{stored})), 0,
                          stored > 0};
                const auto bytes = page.compressed ? file_.value<std::int32_t>() : 0;
                page.bytes =
                    page.compressed ? static_cast<std::uint64_t>(std::max(bytes, 0)) : page.stored;
                // Nothing is compressed to less than a 255th, but for blocks of a megabyte's size.
                if (page.stored > file_.left() || page.bytes > 300 * page.stored + (1u << 16))
                    throw file_.damaged("the size of a page");
                pages.push_back(page);
                at = 0, end = page.bytes;
            }
            if (head.bytes > end - at)
                throw file_.damaged("an attribute that ends beyond its page");
            at += head.bytes;
        }
        return pages;
    }

    void readCounts(PointLeaf& leaf) {
        file_.skip(64);
        constexpr std::size_t bytes = 512 * sizeof(std::uint32_t);
        const auto stored = file_.value<std::uint16_t>();
        leaf.ends.resize(512);
        if (stored == 0xffff)
            std::memcpy(leaf.ends.data(), file_.bytes(bytes).data(), bytes);
        else
            std::memcpy(leaf.ends.data(), unpacked(file_.bytes(stored), bytes).get(), bytes);
        for (std::size_t n = 1; n < 512; ++n)
            if (leaf.ends[n] < leaf.ends[n - 1])
                throw file_.damaged("counts of points that shrink");
        for (const ArrayHead& head : leaf.arrays)
            if (head.size < leaf.ends.back())
                throw file_.damaged(fmt::format("an attribute of {} points in a leaf of {}",
                                                head.size, leaf.ends.back()));
        count_ += leaf.ends.back();
        if (count_ > mostPoints_)
            throw inputError("{} claims more than {} points, and its {} bytes cannot hold so much",
                             file_.path().string(), mostPoints_, file_.size());
    }

    /// Blosc trusts the sizes in its own header, so they are checked here.
    std::unique_ptr<char[]> unpacked(std::span<const char> stored, std::uint64_t bytes) {
        std::uint32_t inside[4] = {};
        if (stored.size() < sizeof inside) throw file_.damaged("compressed points");
        std::memcpy(inside, stored.data(), sizeof inside);
        if (inside[1] != bytes || inside[3] != stored.size())
            throw file_.damaged("the sizes of compressed points");
        auto result = openvdb::compression::bloscDecompress(stored.data(), bytes, false);
        if (!result) throw file_.damaged("compressed points");
        return result;
    }

    void readAttribute(std::size_t a, const std::vector<Page>& pages) {
        const Attribute& attribute = attributes_[a];
        const bool isPlace = attribute.name == "P";
        const bool isRadius = (attribute.name == "pscale" || attribute.name == "radius") &&
                              attribute.type == "float" && radius_ == ~std::size_t{0};
        const bool used = isPlace || isRadius;
        if (isPlace) hasPlaces_ = true;
        if (isRadius) radius_ = a;
        const std::size_t width = used ? bytesOf(attribute) : 0;
        std::size_t page = 0;
        std::uint64_t at = 0, end = 0;
        std::vector<char> bytes;
        for (const PointLeaf& leaf : leaves_) {
            const ArrayHead& head = leaf.arrays[a];
            if (head.paged && at >= end) {
                const Page& next = pages[page++];
                const std::span<const char> stored = file_.bytes(next.stored);
                at = 0, end = next.bytes;
                if (used) {
                    bytes.assign(stored.begin(), stored.end());
                    if (next.compressed) {
                        const auto plain = unpacked(stored, next.bytes);
                        bytes.assign(plain.get(), plain.get() + next.bytes);
                    }
                }
            }
            std::span<const char> values;
            std::unique_ptr<char[]> plain;
            const std::uint64_t needed = width * (head.uniform ? 1 : std::uint64_t{head.size});
            if (head.paged) {
                if (used) values = std::span<const char>(bytes).subspan(at, head.bytes);
                at += head.bytes;
            } else {
                const bool compressed = !head.uniform && file_.value<std::uint8_t>() == 1;
                values = file_.bytes(head.bytes);
                if (compressed && used) {
                    plain = unpacked(values, needed);
                    values = {plain.get(), needed};
                }
            }
            if (!used) continue;
            if (values.size() < needed)
                throw file_.damaged(fmt::format("{} bytes of '{}', where {} are needed",
                                                values.size(), attribute.name, needed));
            for (std::uint32_t i = 0; i < leaf.ends.back(); ++i) {
                const char* const value = values.data() + (head.uniform ? 0 : i * width);
                if (isPlace)
                    offsets_.push_back({number(attribute, value, 0), number(attribute, value, 1),
                                        number(attribute, value, 2)});
                else
                    cloud_.radii.push_back(static_cast<float>(number(attribute, value, 0)));
            }
        }
    }

    Error unknown(const Attribute& attribute) const {
        return inputError("{}: attribute '{}' holds {} with codec '{}', which is not known",
                          file_.path().string(), attribute.name, attribute.type, attribute.codec);
    }

    static std::size_t numberBytes(const std::string& codec) {
        if (codec == "null") return 4;
        if (codec == "trnc" || codec == "fxpt16" || codec == "ufxpt16") return 2;
        return codec == "fxpt8" || codec == "ufxpt8" ? 1 : 0;
    }
    std::size_t bytesOf(const Attribute& attribute) const {
        const std::size_t numbers = attribute.name == "P" ? (attribute.type == "vec3s" ? 3 : 0)
                                                          : (attribute.type == "float" ? 1 : 0);
        const std::size_t bytes = numbers * numberBytes(attribute.codec);
        if (bytes == 0) throw unknown(attribute);
        return bytes;
    }
    static double number(const Attribute& attribute, const char* value, std::size_t i) {
        const std::string& codec = attribute.codec;
        const std::size_t bytes = numberBytes(codec);
        value += i * bytes;
        if (codec == "null") {
            float v;
            std::memcpy(&v, value, sizeof v);
            return static_cast<double>(v);
        }
        std::uint16_t bits = static_cast<unsigned char>(*value);
        if (bytes == 2) std::memcpy(&bits, value, sizeof bits);
        if (codec == "trnc") return static_cast<double>(grid::decodeHalf(bits));
        return bits / (bytes == 2 ? 65535.0 : 255.0) - (codec.starts_with("fxpt") ? 0.5 : 0);
    }

    PointCloud finish() {
        if (count_ > 0 && !hasPlaces_)
            throw inputError("{}: its points have no attribute 'P'", file_.path().string());
        std::size_t next = 0;
        for (const PointLeaf& leaf : leaves_) {
            std::uint32_t i = 0;
            for (int n = 0; n < 512; ++n)
                for (; i < leaf.ends[static_cast<std::size_t>(n)]; ++i) {
                    const Vec3d voxel{double(leaf.origin[0] + (n >> 6)),
                                      double(leaf.origin[1] + ((n >> 3) & 7)),
                                      double(leaf.origin[2] + (n & 7))};
                    cloud_.points.push_back(worldFromIndex_.point(voxel + offsets_[next++]));
                }
        }
        for (std::size_t a = 0; a < attributes_.size(); ++a)
            cloud_.columns += fmt::format("{}'{}' {}", a == 0 ? "" : ", ", attributes_[a].name,
                                          attributes_[a].name == "P" ? "is the position"
                                          : a == radius_             ? "is the radius"
                                                                     : "is not used");
        return std::move(cloud_);
    }

    grid::FileBytes& file_;
    Affine3d worldFromIndex_;
    std::uint32_t compression_;
    std::uint64_t mostPoints_, count_ = 0;
    std::vector<PointLeaf> leaves_;
    std::vector<Attribute> attributes_;
    bool known_ = false, hasPlaces_ = false;
    std::size_t radius_ = ~std::size_t{0};
    std::vector<Vec3d> offsets_;
    PointCloud cloud_;
};

}  // namespace

bool isPointGrid(const grid::GridListing& grid) { return grid.valueType == "points"; }

PointCloud readPointGrid(const grid::VdbFile& listed, const grid::GridListing& grid) {
    if (!grid.worldFromIndex || !flawOf(*grid.worldFromIndex).empty())
        throw inputError("grid '{}' of {} holds points, and {}", grid.uniqueName,
                         listed.path.string(), grid.unusable);
    grid::FileBytes file(listed.path);
    const grid::VdbHeader header = grid::readVdbHeader(file);
    const auto entry = std::find_if(header.entries.begin(), header.entries.end(),
                                    [&](const auto& e) { return e.uniqueName == grid.uniqueName; });
    if (entry == header.entries.end() || !entry->treeOf.empty() ||
        entry->treeType.find("ptdataidx32") == entry->treeType.npos)
        throw inputError("grid '{}' of {} holds no points of its own", grid.uniqueName,
                         listed.path.string());
    file.enter(entry->begin, entry->end, fmt::format("grid '{}'", entry->uniqueName));
    file.loadAll();
    const grid::VdbGridHead head = grid::readGridHead(file);
    try {
        return PointReader(file, *grid.worldFromIndex, head.compression).read();
    } catch (const Error&) {
        throw;
    } catch (const std::exception& e) {  // of OpenVDB's decompression
        throw inputError("{} is damaged: grid '{}': {}", listed.path.string(), grid.uniqueName,
                         e.what());
    }
}

}  // namespace woodcock::convert
