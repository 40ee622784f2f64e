// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <openvdb/points/PointConversion.h>

#include <algorithm>
#include <cmath>

#include "tests/support/expect_error.h"
#include "woodcock/base/random.h"
#include "woodcock/base/temp_dir.h"
#include "woodcock/convert/point_grid_read.h"
#include "woodcock/grid/vdb/openvdb_trees.h"

namespace woodcock::test {

using namespace convert;
using namespace grid;
namespace {

namespace points = openvdb::points;

constexpr double voxel = 0.5;
const openvdb::Vec3d place(1000.25, -2000, 3);

/// Points in several leaves and nodes, some of them in one voxel.
std::vector<openvdb::Vec3f> scattered(std::size_t count) {
    RandomStream random(3);
    std::vector<openvdb::Vec3f> all;
    const auto number = [&](double low, double high) {
        return static_cast<float>(low + (high - low) * random.uniform());
    };
    for (std::size_t i = 0; i < count; ++i)
        all.emplace_back(number(900, 1100), number(-2010, -1990), number(-60, 60));
    return all;
}

template <class Codec>
void write(const std::filesystem::path& file, const std::vector<openvdb::Vec3f>& places,
           std::uint32_t compression, bool withRadii) {
    openvdb::initialize();
    const auto transform = openvdb::math::Transform::createLinearTransform(voxel);
    transform->postTranslate(place);
    const points::PointAttributeVector<openvdb::Vec3f> wrapper(places);
    const auto index =
        openvdb::tools::createPointIndexGrid<openvdb::tools::PointIndexGrid>(wrapper, *transform);
    const auto grid =
        points::createPointDataGrid<Codec, points::PointDataGrid>(*index, wrapper, *transform);
    grid->setName("dust");
    if (withRadii) {
        points::appendAttribute(grid->tree(), "id",
                                points::TypedAttributeArray<int>::attributeType());
        std::vector<float> radii;
        for (std::size_t i = 0; i < places.size(); ++i)
            radii.push_back(0.125f + 0.001f * static_cast<float>(i));
        points::appendAttribute<float>(grid->tree(), "pscale");
        const points::PointAttributeVector<float> values(radii);
        points::populateAttribute<points::PointDataTree, openvdb::tools::PointIndexTree,
                                  points::PointAttributeVector<float>>(grid->tree(), index->tree(),
                                                                       "pscale", values);
    }
    openvdb::io::File out(file.string());
    out.setCompression(compression);
    out.write({grid});
    out.close();
}

PointCloud readDust(const std::filesystem::path& file) {
    const VdbFile listed = listGrids(file);
    EXPECT_TRUE(isPointGrid(listed.grids.at(0)));
    return readPointGrid(listed, listed.grids.at(0));
}

/// Each point has one of the file within `error`, with the radius of its number.
void expectSame(const std::vector<openvdb::Vec3f>& places, const PointCloud& cloud, double error) {
    ASSERT_EQ(cloud.points.size(), places.size());
    for (std::size_t i = 0; i < places.size(); ++i) {
        const Vec3d p{double(places[i][0]), double(places[i][1]), double(places[i][2])};
        std::size_t nearest = 0;
        for (std::size_t k = 1; k < places.size(); ++k)
            if (length(cloud.points[k] - p) < length(cloud.points[nearest] - p)) nearest = k;
        EXPECT_LT(length(cloud.points[nearest] - p), error);
        if (!cloud.radii.empty()) {
            EXPECT_NEAR(cloud.radii[nearest], 0.125 + 0.001 * static_cast<double>(i), 1e-6);
        }
    }
}

TEST(PointGrid, PointsAndRadiiAreThoseOfTheFile) {
    using namespace openvdb::io;
    const TempDir dir;
    const auto places = scattered(700);
    for (const std::uint32_t compression :
         {std::uint32_t{COMPRESS_NONE}, std::uint32_t{COMPRESS_ZIP | COMPRESS_ACTIVE_MASK},
          std::uint32_t{COMPRESS_BLOSC | COMPRESS_ACTIVE_MASK}}) {
        write<points::NullCodec>(dir / "a.vdb", places, compression, true);
        const PointCloud cloud = readDust(dir / "a.vdb");
        EXPECT_EQ(cloud.radii.size(), places.size());
        EXPECT_EQ(cloud.columns, "'P' is the position, 'id' is not used, 'pscale' is the radius");
        expectSame(places, cloud, 1e-4);
        write<points::FixedPointCodec<false>>(dir / "b.vdb", places, compression, false);
        expectSame(places, readDust(dir / "b.vdb"), voxel / 65535 * 2 + 1e-4);
        write<points::FixedPointCodec<true>>(dir / "c.vdb", places, compression, false);
        expectSame(places, readDust(dir / "c.vdb"), voxel / 255 * 2);
    }
}

/// Bits flipped and ends cut off: points or an error.
TEST(PointGrid, DamagedFilesDoNoHarm) {
    const TempDir dir;
    write<points::FixedPointCodec<false>>(
        dir / "a.vdb", scattered(300),
        openvdb::io::COMPRESS_BLOSC | openvdb::io::COMPRESS_ACTIVE_MASK, true);
    const std::string healthy = readText(dir / "a.vdb");
    RandomStream random(5);
    int errors = 0;
    for (int variant = 0; variant < 600; ++variant) {
        std::string bytes = healthy;
        if (variant % 4 == 0) bytes.resize(random.bits() % bytes.size());
        for (int i = 0; i < variant % 4; ++i)
            bytes[random.bits() % bytes.size()] ^= static_cast<char>(1 << random.bits() % 8);
        writeText(dir / "a.vdb", bytes);
        try {
            const VdbFile listed = listGrids(dir / "a.vdb");
            for (const GridListing& grid : listed.grids)
                if (isPointGrid(grid)) readPointGrid(listed, grid);
        } catch (const Error& e) {
            EXPECT_NE(std::string(e.what()).find("a.vdb"), std::string::npos) << e.what();
            ++errors;
        }
    }
    EXPECT_GT(errors, 150);
}

}  // namespace
}  // namespace woodcock::test
