// SPDX-License-Identifier: Apache-2.0
#include "woodcock/base/moving_transform.h"

#include <gtest/gtest.h>

#include <cmath>

#include "woodcock/base/random.h"

namespace woodcock::test {

namespace {

const std::vector<double> wholeShutter{0, 1};

double difference(const Affine3d& a, const Affine3d& b) {
    double most = length(a.translation - b.translation);
    for (std::size_t c = 0; c < 3; ++c)
        most = std::max(most, length(a.column[c] - b.column[c]) / length(b.column[c]));
    return most;
}

std::shared_ptr<const MovingTransform> follow(const std::function<Affine3d(double)>& at,
                                              Vec3d centre = {}) {
    return MovingTransform::follow(at, at, wholeShutter, centre);
}

}  // namespace

TEST(MovingTransform, FollowsWhatMovesAndBoundsIt) {
    const Vec3d centre{7, 1, -2};
    const auto at = [&](double u) {
        return Affine3d::translate({3 * u, u * u, std::sin(4 * u)}) * Affine3d::rotate(1, 200 * u) *
               Affine3d::rotate(0, 90 * u * u) * Affine3d::scale({1 + u, 2, 1 - u / 2});
    };
    const auto moving = follow(at, centre);
    ASSERT_NE(moving, nullptr);
    EXPECT_FALSE(moving->jumps());
    const Box3d box{centre - Vec3d{1, 1, 1}, centre + Vec3d{1, 2, 1}};
    const Box3d all = moving->box(box);
    double way = 0;
    for (int i = 0; i < 1000; ++i)
        way += length(at((i + 1) / 1000.0).point(centre) - at(i / 1000.0).point(centre));
    RandomStream random(2);
    for (int i = 0; i < 1000; ++i) {
        const double u = random.uniform();
        const Affine3d found = moving->at(u), expected = at(u);
        EXPECT_LT(length(found.point(centre) - expected.point(centre)), 2e-4 * way);
        for (std::size_t c = 0; c < 3; ++c)
            EXPECT_LT(length(found.column[c] - expected.column[c]), 1e-4);
        for (int corner = 0; corner < 8; ++corner)
            EXPECT_TRUE(all.contains(found.point(box.corner(corner))));
    }
    // Not much more than what it sweeps over.
    Box3d swept;
    for (int i = 0; i <= 1000; ++i) swept.add(moving->at(i / 1000.0).box(box));
    EXPECT_LT(length(all.size()), 1.05 * length(swept.size()));
}

TEST(MovingTransform, IsExactForStraightWaysAndEvenTurns) {
    const Affine3d start{{Vec3d{2, 1, 0}, {0, 3, 0.1}, {1, 0, 1}}, {1, 2, 3}};
    const auto straight = follow([&](double u) {
        return Affine3d::translate({8 * u, -4 * u, 0}) * start;
    });
    ASSERT_NE(straight, nullptr);
    EXPECT_TRUE(straight->straight());
    EXPECT_EQ(straight->at(0.25).column, start.column);
    EXPECT_EQ(straight->at(0.25).translation, (Vec3d{3, 1, 3}));
    const Vec3d centre{100, 0, 0};
    const auto turn = [&](double u) {
        return Affine3d::translate(centre) * Affine3d::rotate(2, 300 * u) *
               Affine3d::translate(-centre);
    };
    const auto turning = follow(turn, centre);
    for (const double u : {0.0, 0.1, 0.33, 0.5, 0.97, 1.0})
        EXPECT_LT(difference(turning->at(u), turn(u)), 1e-11);
}

TEST(MovingTransform, IsNothingAtRestAndJumps) {
    const Affine3d still = Affine3d::rotate(1, 33);
    EXPECT_EQ(follow([&](double) { return still; }), nullptr);
    const Affine3d moved = Affine3d::translate({1, 0, 0}) * still;
    const std::vector<double> breaks{0, 0.5, 1};
    const auto jump =
        MovingTransform::follow([&](double u) { return u < 0.5 ? still : moved; },
                                [&](double u) { return u <= 0.5 ? still : moved; }, breaks);
    ASSERT_NE(jump, nullptr);
    EXPECT_TRUE(jump->jumps());
    EXPECT_EQ(jump->at(0.4999).translation, still.translation);
    EXPECT_EQ(jump->at(0.5).translation, moved.translation);
    const Box3d box{{0, 0, 0}, {1, 1, 1}};
    EXPECT_TRUE(jump->box(box).contains(still.point({1, 1, 1})));
    EXPECT_TRUE(jump->box(box).contains(moved.point({1, 1, 1})));
}

TEST(MovingTransform, DoesNotJumpWhereARoundedWayIsCut) {
    const auto at = [](double u) {
        return Affine3d::translate({1000 + 0.3 * u, 7 * u, 0}) * Affine3d::rotate(0, 50 * u);
    };
    const std::vector<double> breaks{0, 0.3, 0.7, 1};
    const auto cut = MovingTransform::follow(
        at, [&](double u) { return at(std::nextafter(u, 0.0)); }, breaks);
    ASSERT_NE(cut, nullptr);
    EXPECT_FALSE(cut->jumps());
}

}  // namespace woodcock::test
