// SPDX-License-Identifier: Apache-2.0
#include "tests/support/damage_vdb.h"

#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>

#include "tests/support/paths.h"
#include "woodcock/grid/vdb/check_grid_head.h"
#include "woodcock/grid/vdb/check_header.h"
#include "woodcock/grid/vdb/check_tree.h"
#include "woodcock/grid/vdb/openvdb_trees.h"
#include "woodcock/proof/support/write_vdb.h"

namespace woodcock::test {

using namespace grid;
using namespace proof;

namespace {

GridSpec cloud(VdbType type = VdbType::Float) {
    GridSpec spec{.type = type};
    spec.box = {{-6, 0, 0}, {10, 11, 9}};
    spec.value = [](Vec3i v) { return v.x % 3 == 0 ? 0.0 : 1 + (v.x * 7 + v.y * v.z) % 5; };
    spec.worldFromIndex = Affine3d::scale({0.1, 0.1, 0.1});
    return spec;
}

GridSpec colours(VdbType type) {
    GridSpec spec = cloud(type);
    spec.value = nullptr;
    spec.colour = [](Vec3i v) { return Vec3d{v.x * 0.1, 1.0, v.z % 2 * 1.0}; };
    return spec;
}

GridSpec half(GridSpec spec) {
    spec.saveAsHalf = true;
    return spec;
}

GridSpec bits(VdbType type) {
    GridSpec spec{.type = type};
    for (int i = 0; i < 40; ++i) spec.voxels.push_back({{i, i * i % 17, 3 * i % 11}, {1}});
    return spec;
}

GridSpec tiles() {
    GridSpec spec = cloud();
    spec.background = {0.25};
    spec.tiles = {{{64, 0, 0}, 8, {2}},
                  {{-128, 128, 0}, 128, {3}, false},
                  {{4096, -4096, 0}, 4096, {0.5}},
                  {{8192, 0, 4096}, 4096, {1}, false}};
    spec.voxels = {{{100, 100, 100}, {7}, false}, {{101, 100, 100}, {-7}, false}};
    return spec;
}

/// Two grids that share one tree.
void writeShared(const std::filesystem::path& file) {
    openvdb::initialize();
    const auto first = openvdb::FloatGrid::create();
    for (int i = 0; i < 20; ++i)
        first->tree().setValue({i, 2 * i, i}, 1.0f + static_cast<float>(i));
    first->setName("density");
    const auto second = openvdb::gridPtrCast<openvdb::FloatGrid>(first->copyGrid());
    second->setName("again");
    openvdb::io::File(file.string()).write(openvdb::GridCPtrVec{first, second});
}

VdbSample::Grid partsOf(FileBytes& file, const VdbHeader::Entry& entry) {
    VdbSample::Grid grid{entry.begin, entry.end, entry.end, entry.end, {}};
    file.enter(entry.begin, entry.end, entry.uniqueName);
    const VdbGridHead head = readGridHead(file);
    grid.topology = file.position();
    const VdbValueType type = valueTypeOf(entry.treeType);
    if (!entry.treeOf.empty() || type.channels == 0) return grid;
    grid.leaves = findLayout(file, type, head.compression, head.savedAsHalf).leaves;
    if (!grid.leaves.empty()) grid.voxels = grid.leaves.front();
    return grid;
}

VdbSample sampleOf(const std::string& name, const std::filesystem::path& path) {
    VdbSample sample{name, readText(path), {}};
    FileBytes file(path);
    for (const VdbHeader::Entry& entry : readVdbHeader(file).entries)
        sample.grids.push_back(partsOf(file, entry));
    return sample;
}

class Damage {
public:
    Damage(const VdbSample& sample, std::uint64_t seed)
        : sample_(sample), bytes_(sample.bytes), random_(seed) {}

    std::string make() {
        switch (below(14)) {
            case 0:
            case 1:
                flipBits();
                break;
            case 2:
                bytes_.resize(somewhere());
                break;
            case 3:
                truncateAndSaySo();
                break;
            case 4:
            case 5:
                for (std::size_t n = 1 + below(3); n > 0; --n) putAbsurd(somewhere());
                break;
            case 6:
                changeType();
                break;
            case 7:
                spoilTransform();
                break;
            case 8:
                lieInMetadata();
                break;
            case 9:
                misleadOffsets();
                break;
            case 10:
                fillMasks();
                break;
            case 11:
                moveParts();
                break;
            case 12:
                spoilSizes();
                break;
            case 13:
                spoilRoot();
                break;
        }
        return bytes_;
    }

private:
    std::size_t below(std::size_t n) { return n == 0 ? 0 : random_() % n; }
    const VdbSample::Grid& someGrid() { return sample_.grids[below(sample_.grids.size())]; }

    /// Each part of the file as likely as the others, however small.
    std::size_t somewhere() {
        const VdbSample::Grid& grid = someGrid();
        const std::array<std::pair<std::size_t, std::size_t>, 4> parts{
            {{0, grid.begin},
             {grid.begin, grid.topology},
             {grid.topology, grid.voxels},
             {grid.voxels, grid.end}}};
        const auto [begin, end] = parts[below(parts.size())];
        return begin + below(end - begin);
    }

    template <class T>
    void put(std::size_t at, T value) {
        if (at + sizeof value <= bytes_.size())
            std::memcpy(bytes_.data() + at, &value, sizeof value);
    }
    void putAbsurd(std::size_t at) {
        constexpr std::int64_t absurd[]{0,
                                        -1,
                                        1,
                                        255,
                                        1 << 20,
                                        std::numeric_limits<std::int32_t>::max(),
                                        std::numeric_limits<std::int32_t>::min(),
                                        std::int64_t(1) << 40,
                                        std::numeric_limits<std::int64_t>::max(),
                                        std::numeric_limits<std::int64_t>::min()};
        const std::int64_t value = absurd[below(std::size(absurd))];
        if (below(2))
            put(at, value);
        else
            put(at, static_cast<std::int32_t>(value));
    }

    void flipBits() {
        for (std::size_t n = 1 + below(8); n > 0; --n)
            bytes_[somewhere()] ^= static_cast<char>(1 << below(8));
    }

    /// The file ends early, and its table of contents agrees.
    void truncateAndSaySo() {
        const VdbSample::Grid& last = sample_.grids.back();
        const std::size_t end = last.begin + below(last.end - last.begin);
        replaceNumbers(static_cast<std::int64_t>(last.end), static_cast<std::int64_t>(end));
        bytes_.resize(end);
    }

    void replaceNumbers(std::int64_t from, std::int64_t to) {
        for (std::size_t at = 0; at + 8 <= sample_.grids.back().begin; ++at)
            if (std::memcmp(bytes_.data() + at, &from, 8) == 0) put(at, to);
    }

    /// `from` and `to` of any lengths; what follows moves.
    void replaceText(const std::string& from, const std::string& to) {
        const std::size_t at = bytes_.find(from);
        if (at == std::string::npos || at < 4) return flipBits();
        put(at - 4, static_cast<std::uint32_t>(to.size()));
        bytes_.replace(at, from.size(), to);
    }
    template <std::size_t N>
    void replaceOne(const std::array<const char*, N>& texts) {
        for (std::size_t n = 0, first = below(N); n < N; ++n) {
            const std::string from = texts[(first + n) % N];
            if (bytes_.find(from) == std::string::npos) continue;
            return replaceText(from, texts[below(N)]);
        }
    }

    void changeType() {
        if (below(3) == 0)
            replaceOne(std::array{"UniformScaleMap", "ScaleMap", "AffineMap", "UnitaryMap",
                                  "TranslationMap", "NonlinearFrustumMap", "NoSuchMap", ""});
        else  // of equal lengths first, so that the rest stays in its place
            replaceOne(std::array{"float", "int32", "int64", "vec3s", "vec3d", "vec3i", "bool",
                                  "mask", "double", "string", "_HalfFloat"});
    }

    void spoilTransform() {
        constexpr double limit = std::numeric_limits<double>::infinity();
        constexpr double bad[]{std::nan(""), limit,  -limit, 0.0,   -0.0,
                               1e308,        -1e308, 5e-324, 1e-30, 1e30};
        const VdbSample::Grid& grid = someGrid();
        const std::size_t at = bytes_.rfind("Map", grid.topology);
        if (at == std::string::npos) return flipBits();
        const std::size_t numbers = (grid.topology - at - 3) / 8;
        const double value = bad[below(std::size(bad))];
        if (below(2)) {
            for (std::size_t i = 0; i < numbers; ++i) put(at + 3 + 8 * i, value);
        } else {
            put(at + 3 + 8 * below(numbers), value);
        }
    }

    void lieInMetadata() {
        if (below(3) == 0)
            return replaceOne(
                std::array{"fog volume", "level set", "staggered", "unknown", "nonsense"});
        for (const char* key : {"file_bbox_max", "file_bbox_min", "file_voxel_count", "name",
                                "file_mem_bytes", "is_saved_as_half_float", "class"}) {
            const std::size_t at = bytes_.find(key);
            if (at == std::string::npos || below(3)) continue;
            // The lengths of key and type, the type, the size of the value, the value.
            if (below(2)) return putAbsurd(at - 4 + below(60));
            for (std::size_t i = 0; i < 4; ++i)
                bytes_[at + below(60)] = static_cast<char>(random_());
            return;
        }
    }

    void misleadOffsets() {
        const VdbSample::Grid& grid = someGrid();
        const std::size_t from = below(2) ? grid.begin : grid.end;
        const std::int64_t to[]{0,
                                -1,
                                static_cast<std::int64_t>(grid.begin) - 40,
                                static_cast<std::int64_t>(grid.begin),
                                static_cast<std::int64_t>(grid.begin + 1),
                                static_cast<std::int64_t>(grid.topology),
                                static_cast<std::int64_t>(grid.voxels),
                                static_cast<std::int64_t>(bytes_.size()),
                                static_cast<std::int64_t>(bytes_.size() + 1),
                                std::numeric_limits<std::int64_t>::max(),
                                std::numeric_limits<std::int64_t>::min()};
        replaceNumbers(static_cast<std::int64_t>(from), to[below(std::size(to))]);
    }

    void fillMasks() {
        const VdbSample::Grid& grid = someGrid();
        const std::size_t at = grid.topology + below(grid.voxels - grid.topology);
        const std::size_t n = std::size_t(8) << below(11);
        for (std::size_t i = at; i < std::min(at + n, grid.end); ++i)
            bytes_[i] = below(2) ? '\xff' : bytes_[i];
    }

    void moveParts() {
        const std::size_t from = somewhere(), to = somewhere();
        const std::string part = bytes_.substr(from, 1 + below(200));
        switch (below(3)) {
            case 0:
                bytes_.replace(to, std::min(part.size(), bytes_.size() - to), part);
                break;
            case 1:
                bytes_.insert(to, part);
                break;
            case 2:
                bytes_.erase(from, part.size());
                break;
        }
    }

    /// The bytes after a leaf's mask: the kind of its values and their compressed size.
    void spoilSizes() {
        const VdbSample::Grid& grid = someGrid();
        if (grid.leaves.empty()) return flipBits();
        const std::size_t at = grid.leaves[below(grid.leaves.size())] + 64;
        if (below(2)) put(at, static_cast<char>(below(9)));
        if (below(2)) putAbsurd(at + 1 + below(3) * 4);
        if (below(2)) put(at + 9 + below(16), static_cast<char>(random_()));
    }

    /// The number of buffers, the background, the numbers of tiles and children, their places.
    void spoilRoot() { putAbsurd(someGrid().topology + 4 * below(20)); }

    const VdbSample& sample_;
    std::string bytes_;
    std::mt19937_64 random_;
};

}  // namespace

std::vector<VdbSample> healthyVdbs() {
    using enum VdbCompression;
    const TempDir dir;
    const std::filesystem::path file = dir / "healthy.vdb";
    std::vector<VdbSample> samples;
    const auto add = [&](const char* name, const std::vector<GridSpec>& grids,
                         VdbCompression compression) {
        writeVdb(file, grids, compression);
        samples.push_back(sampleOf(name, file));
    };
    GridSpec plain = cloud();
    plain.gridClass = "unknown";  // OpenVDB never zips fog
    add("float", {cloud()}, None);
    add("float, blosc", {cloud()}, Blosc);
    add("float, zip", {plain}, Zip);
    add("half, blosc", {half(cloud())}, Blosc);
    add("half, zip", {half(plain)}, Zip);
    add("native half", {cloud(VdbType::Half)}, Blosc);
    add("double", {cloud(VdbType::Double)}, Blosc);
    add("int32", {cloud(VdbType::Int32)}, None);
    add("int64", {cloud(VdbType::Int64)}, Blosc);
    add("bool", {bits(VdbType::Bool)}, Blosc);
    add("mask", {bits(VdbType::Mask)}, None);
    add("vec3s", {cloud(), colours(VdbType::Vec3s)}, Blosc);
    add("vec3d", {half(colours(VdbType::Vec3d)), cloud()}, None);
    add("tiles", {tiles()}, None);
    add("tiles, blosc", {tiles()}, Blosc);
    GridSpec flame = half(cloud());
    flame.name = "flame";
    flame.metadata = {{"author", "somebody"}, {"comment", std::string(300, 'x')}};
    add("many", {cloud(), flame, {.name = "dust", .type = VdbType::Points}, bits(VdbType::Bool)},
        Blosc);
    writeShared(file);
    samples.push_back(sampleOf("shared tree", file));
    streamVdb(file, {cloud(), flame});
    samples.push_back(sampleOf("stream", file));
    return samples;
}

std::string damagedVdb(const VdbSample& sample, std::uint64_t seed) {
    return Damage(sample, seed).make();
}

}  // namespace woodcock::test
