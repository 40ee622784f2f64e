// SPDX-License-Identifier: Apache-2.0
#include "woodcock/grid/cell_walk.h"

#include <gtest/gtest.h>

#include "woodcock/base/affine.h"
#include "woodcock/base/random.h"
#include "woodcock/proof/support/plain_grid.h"

namespace woodcock::test {

using namespace grid;
using namespace proof;

namespace {

class CellWalks : public ::testing::Test {
protected:
    struct Volume {
        explicit Volume(const PlainGrid& g, double depthPerVoxel)
            : grid(g), field(grid.field()), majorants(field, {depthPerVoxel, 1, 1}) {}
        PlainGrid grid;
        Field field;
        MajorantGrid majorants;
    };

    /// A cell of this range must lie within `slack` voxels of p.
    static bool hasCell(const Volume& v, Vec3d p, double slack, Range range) {
        for (int i = 0; i < 8; ++i) {
            const Vec3d shift{i & 1 ? slack : -slack, i & 2 ? slack : -slack,
                              i & 4 ? slack : -slack};
            if (v.majorants.find(floorToInt(p + shift)).range == range) return true;
        }
        return false;
    }

    /// Walks the ray through the support and checks every segment; returns how many there were, 0
    /// for a miss.
    static int walk(const Volume& v, const IndexRay& ray, double t0 = 0,
                    double t1 = std::numeric_limits<double>::infinity()) {
        const Box3d& support = v.field.support();
        if (!clip(ray, support, t0, t1)) return 0;
        // Where a ray comes from afar its points are known to the origin's last digit only.
        const double speed = length(ray.direction);
        const double slack = 1e-13 * (length(ray.origin) + length(ray.direction * t1) + 100);
        const Vec3d size = support.size();
        const int most = static_cast<int>((size.x + size.y + size.z) / 2 + 16);
        CellWalk cells(v.majorants, support, ray, t0, t1);
        Segment s;
        double t = t0;
        int count = 0;
        while (cells.next(s)) {
            EXPECT_EQ(s.t0, t);
            EXPECT_LE(s.t0, s.t1);
            t = s.t1;
            if (++count > most) {
                ADD_FAILURE() << "more segments than the ray can cross cells";
                return count;
            }
            for (double u : {0.0, 0.3, 0.5, 1.0}) {
                const Vec3d p = ray.at(s.t0 + u * (s.t1 - s.t0));
                for (int i = 0; i < 3; ++i) {
                    EXPECT_GE(p[i], support.lower[i] - slack);
                    EXPECT_LE(p[i], support.upper[i] + slack);
                }
                EXPECT_TRUE(hasCell(v, p, slack, s.range))
                    << p.x << " " << p.y << " " << p.z << " at " << u;
                for (int c = 0; c < v.grid.channels() && slack < 1e-6; ++c) {
                    EXPECT_LE(s.range.min, v.field.trilinear(p, c) + 1e-6);
                    EXPECT_GE(s.range.max, v.field.trilinear(p, c) - 1e-6);
                }
            }
        }
        EXPECT_NEAR(t * speed, t1 * speed, slack);
        EXPECT_GT(count, 0);
        return count;
    }

    static std::vector<Volume> volumes() {
        std::vector<Volume> v;
        for (double depth : {0.02, 2.0}) {
            v.emplace_back(mixedGrid(1), depth);
            v.emplace_back(scatteredGrid(5), depth);
        }
        return v;
    }

    static Vec3d any(RandomStream& random, double size) {
        return Vec3d{random.uniform() - 0.5, random.uniform() - 0.5, random.uniform() - 0.5} * size;
    }
};

TEST_F(CellWalks, RandomRaysInAnyDirection) {
    RandomStream random(1);
    for (const Volume& v : volumes()) {
        int hits = 0;
        for (int i = 0; i < 2000; ++i) {
            const Vec3d through = any(random, i % 2 ? 60 : 8000),
                        from = through + any(random, 20000);
            hits += walk(v, {from, normalize(through - from)}) > 0;
        }
        EXPECT_GT(hits, 300);
    }
}

TEST_F(CellWalks, OriginInsideAndEndInside) {
    RandomStream random(2);
    for (const Volume& v : volumes())
        for (int i = 0; i < 1000; ++i) {
            const double t0 = 5 * random.uniform();
            walk(v, {any(random, 30), any(random, 4)}, t0, t0 + 8 * random.uniform());
        }
}

TEST_F(CellWalks, AlongAxesThroughCornersEdgesAndInsideFaces) {
    for (const Volume& v : volumes())
        for (int axis = 0; axis < 3; ++axis)
            for (double sign : {1.0, -1.0})
                for (double a = -18; a <= 18; a += 0.5)
                    for (double b : {-16.0, -8.0, -7.5, -1.0, 0.0, 2.0, 7.0, 8.0, 15.0, 16.0}) {
                        IndexRay ray;
                        ray.direction[axis] = sign;
                        ray.origin[axis] = -100 * sign;
                        ray.origin[(axis + 1) % 3] = a, ray.origin[(axis + 2) % 3] = b;
                        walk(v, ray);
                    }
}

TEST_F(CellWalks, DiagonalsExactlyThroughVoxelCorners) {
    for (const Volume& v : volumes())
        for (int signs = 0; signs < 27; ++signs) {
            const Vec3d d{signs % 3 - 1.0, signs / 3 % 3 - 1.0, signs / 9 - 1.0};
            if (d == Vec3d{}) continue;
            for (int x = -16; x <= 16; x += 4)
                for (int y = -8; y <= 16; y += 4) {
                    const Vec3d through{double(x), double(y), -2};
                    walk(v, {through - d * 64.0, d});
                    walk(v, {through, d});
                    walk(v, {through - d * 64.0, d * Vec3d{1, 2, 0.5}});
                }
        }
}

/// A ray that enters through a corner of cells may stand an ulp outside the support when it crosses
/// its first face.
TEST_F(CellWalks, DiagonalsThatRoundingMovesOffTheCorners) {
    for (const Volume& v : volumes())
        for (int signs = 0; signs < 8; ++signs) {
            const Vec3d d = normalize(
                Vec3d{signs & 1 ? 1.0 : -1.0, signs & 2 ? 1.0 : -1.0, signs & 4 ? 1.0 : -1.0});
            for (int x = -16; x <= 16; ++x)
                for (int y = -16; y <= 16; ++y)
                    walk(v, {Vec3d{double(x), double(y), 3} - d * 65.0, d});
        }
}

TEST_F(CellWalks, SupportBoundaryIsGrazedWithoutHarm) {
    for (const Volume& v : volumes()) {
        const Box3d& s = v.field.support();
        for (int i = 0; i < 8; ++i)
            for (Vec3d d :
                 {Vec3d{1, 0, 0}, Vec3d{0, -1, 0}, Vec3d{1, 1, 0}, Vec3d{-1, 0.5, 0.25}}) {
                walk(v, {s.corner(i), d});
                walk(v, {s.corner(i) - d * 30000.0, d});
            }
    }
}

TEST_F(CellWalks, DenormalAndTinyComponents) {
    for (const Volume& v : volumes())
        for (double tiny : {0x1p-1074, -0x1p-1074, 1e-310, -1e-300, 1e-17, -1e-16, -0.0})
            for (double offset : {0.0, 0.5, 8.0, -8.0})
                for (int axis = 0; axis < 3; ++axis) {
                    Vec3d d{1, 1, 1};
                    d[axis] = tiny;
                    Vec3d o{-50, -50, -50};
                    o[axis] = offset;
                    walk(v, {o, d});
                    d = Vec3d{tiny, tiny, tiny};
                    d[axis] = -1;
                    o = Vec3d{offset, offset, offset};
                    walk(v, {o, d});
                }
}

TEST_F(CellWalks, EmptyIntervalsHaveNoSegments) {
    const Volume v(mixedGrid(1), 1);
    EXPECT_EQ(walk(v, {{0, 0, 0}, {1, 0, 0}}, 3, 3), 0);
    EXPECT_EQ(walk(v, {{0, 0, 0}, {1, 0, 0}}, 3, 2), 0);
    EXPECT_EQ(walk(v, {{0, 1e5, 0}, {1, 0, 0}}), 0);
    EXPECT_EQ(walk(v, {{0, 0, 0}, {0, 0, 0}}, 0, 0), 0);
}

TEST_F(CellWalks, FarOriginsLoseOnlyTheirLastDigits) {
    RandomStream random(3);
    for (const Volume& v : volumes())
        for (double distance : {1e7, 1e12})
            for (int i = 0; i < 500; ++i) {
                const Vec3d d = normalize(any(random, 1));
                EXPECT_GT(walk(v, {any(random, 10) - d * distance, d}), 0);
            }
}

TEST_F(CellWalks, ShearedAndMirroredRaysKeepTheWorldsParameter) {
    RandomStream random(4);
    for (const Volume& v : volumes())
        for (double scale : {1e-6, 1.0, 1e6})
            for (int i = 0; i < 300; ++i) {
                const Affine3d world{{Vec3d{scale, 0, 0.2 * scale}, Vec3d{0.5 * scale, -scale, 0},
                                      Vec3d{0, 0.3 * scale, 3 * scale}},
                                     {7 * scale, 8 * scale, 9 * scale}};
                const Affine3d index = world.inverse();
                const Vec3d through = world.point(any(random, 10)), d = normalize(any(random, 1));
                const Vec3d from = through - d * (100 * scale);
                EXPECT_GT(walk(v, {index.point(from), index.vector(d)}), 0);
            }
}

}  // namespace
}  // namespace woodcock::test
