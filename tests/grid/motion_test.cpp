// SPDX-License-Identifier: Apache-2.0
#include "woodcock/grid/motion.h"

#include <gtest/gtest.h>

#include "tests/support/expect_error.h"
#include "woodcock/base/random.h"
#include "woodcock/proof/support/plain_grid.h"

namespace woodcock::test {

using namespace grid;
using namespace proof;

namespace {

using At = std::function<Vec3d(Vec3i)>;

/// Vectors in the blocks of 8^3 voxels from `lower` to `upper`, both included.
std::shared_ptr<const Field> vectors(const At& at, Vec3i lower, Vec3i upper,
                                     std::array<float, 3> background = {}) {
    PlainGrid grid(3, background);
    for (int x = lower.x; x <= upper.x; ++x)
        for (int y = lower.y; y <= upper.y; ++y)
            for (int z = lower.z; z <= upper.z; ++z)
                grid.setLeaf(Vec3i{x, y, z} * 8,
                             [&](Vec3i v, int c) { return static_cast<float>(at(v)[c]); });
    return std::make_shared<const Field>(grid.field());
}

std::shared_ptr<const Velocity> velocity(std::shared_ptr<const Field> field, bool staggered = false,
                                         const Affine3d& objectFromIndex = {}) {
    std::array<Velocity::Source, 3> sources;
    for (int c = 0; c < 3; ++c) {
        sources[static_cast<std::size_t>(c)] = {field, c, objectFromIndex};
        if (staggered) sources[static_cast<std::size_t>(c)].offset[c] = -0.5;
    }
    return std::make_shared<const Velocity>(std::move(sources));
}

void expectNear(Vec3d a, Vec3d b, double tolerance = 1e-6) {
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(a[i], b[i], tolerance);
}

/// One radian per unit of time about z.
std::shared_ptr<const Velocity> rotation() {
    return velocity(vectors(
        [](Vec3i v) {
            return cross(Vec3d{0, 0, 1}, v.as<double>());
        },
        {-3, -3, -1}, {2, 2, 0}));
}

TEST(Motion, LooksUpTwiceAsKimAndKoDo) {
    const Motion motion(rotation(), {}, 0, 0.5);
    expectNear(motion.source({1, 0, 0}, 1), {0.75, -0.5, 0});
    expectNear(motion.source({1, 0, 0}, 0), {1, 0, 0});
    expectNear(motion.source({1, 0, 0}, 0.5f), {1 - 0.0625, -0.25, 0});
    // Before the moment of the file, it turns the other way.
    expectNear(Motion(rotation(), {}, -0.5, 0).source({1, 0, 0}, 0), {0.75, 0.5, 0});
}

TEST(Motion, StaggeredComponentsLieOnFaces) {
    const auto one = vectors(
        [](Vec3i v) {
            return v == Vec3i{} ? Vec3d{1, 2, 3} : Vec3d{};
        },
        {-1, -1, -1}, {0, 0, 0});
    // So little time that the second look-up is where the first one is.
    const double dt = 1e-7;
    const auto seen = [&](bool staggered, Vec3d at) {
        const Motion motion(velocity(one, staggered), {}, 0, dt);
        return (at - motion.source(at, 1)) / dt;
    };
    expectNear(seen(false, {}), {1, 2, 3}, 1e-5);
    expectNear(seen(true, {}), {0.5, 1, 1.5}, 1e-5);
    expectNear(seen(true, {-0.5, 0, 0}), {1, 0.5, 0.75}, 1e-5);
}

TEST(Motion, VelocitiesAreOfObjectSpace) {
    // Voxels of the velocities are half as wide as those of what moves, and lie elsewhere.
    const Affine3d place{{Vec3d{0.25, 0, 0}, {0, 0.25, 0}, {0, 0, 0.25}}, {-2, -1, -3}};
    const auto at = [&](Vec3i v) {
        const Vec3d p = place.point(v.as<double>());
        return Vec3d{1 + p.y, 2 * p.x, -p.z};
    };
    const Affine3d objectFromIndex = Affine3d::translate({0.3, -0.2, 0.1}) *
                                     Affine3d::rotate(2, 30) * Affine3d::scale({0.5, 0.5, 0.5});
    const Motion motion(velocity(vectors(at, {0, 0, 0}, {2, 2, 2}), false, place), objectFromIndex,
                        0, 0.25);
    const auto v = [](Vec3d p) { return Vec3d{1 + p.y, 2 * p.x, -p.z}; };
    const Vec3d index{0.6, 0.8, -0.4}, x = objectFromIndex.point(index);
    const Vec3d from = x - v(x - v(x) * 0.25) * 0.25;
    expectNear(objectFromIndex.point(motion.source(index, 1)), from);
}

TEST(Motion, WhatHasNoVelocityStaysExactlyWhereItIs) {
    const auto some = vectors([](Vec3i) { return Vec3d{3, 1, 2}; }, {0, 0, 0}, {0, 0, 0});
    const Motion motion(velocity(some), Affine3d::scale({0.1, 0.1, 0.1}), -1, 1);
    const Vec3d far{100.3, 200.7, 0.1};
    EXPECT_EQ(motion.source(far, 0.25f), far);
    const Box3d box{far, far + Vec3d{1, 1, 1}};
    EXPECT_EQ(motion.sources(box), box);
}

/// Velocities without any order, one of them far larger than the others.
Vec3d wild(Vec3i v) {
    if (v == Vec3i{3, 5, -2}) return {400, -900, 50};
    RandomStream random(hashOf(7, v.x, v.y, v.z));
    return {3 * random.uniform() - 1, 4 * random.uniform() - 2, random.uniform() - 2};
}

TEST(Motion, SourcesAreWithinTheirBoxes) {
    RandomStream random(5);
    const auto u = [&](double low, double high) { return low + (high - low) * random.uniform(); };
    for (const bool staggered : {false, true})
        for (const Affine3d& place : {Affine3d{}, Affine3d::rotate(1, 20)})
            for (const auto& [open, close] : {std::pair{0.0, 1.0}, {-0.3, 0.7}, {-2.0, -1.0}}) {
                const Motion motion(
                    velocity(vectors(wild, {-2, -2, -2}, {1, 1, 1}, {1, -0.5f, 0}), staggered),
                    place, open, close);
                const Box3d start{{-1, -2, -3}, {4, 1, 2}};
                const Box3d reached = motion.reached(start);
                for (int i = 0; i < 60; ++i) {
                    const Vec3d lower{u(-24, 20), u(-24, 20), u(-24, 20)};
                    const double width = std::pow(10.0, u(-3, 1));
                    const Box3d box{lower, lower + Vec3d{1, 1, 1} * width};
                    const float at = static_cast<float>(random.uniform());
                    const Box3d always = motion.sources(box), then = motion.sources(box, at),
                                close_ = motion.closeSources(box, at);
                    for (int k = 0; k < 20; ++k) {
                        const Vec3d p = box.lower + box.size() * Vec3d{u(0, 1), u(0, 1), u(0, 1)};
                        const float time = static_cast<float>(random.uniform());
                        EXPECT_TRUE(always.contains(motion.source(p, time)));
                        EXPECT_TRUE(then.contains(motion.source(p, at)));
                        EXPECT_TRUE(close_.contains(motion.source(p, at)));
                        EXPECT_TRUE(reached.contains(p) || !start.contains(motion.source(p, time)));
                    }
                }
            }
}

TEST(Motion, CloseBoxesBecomeAsSmallAsTheWay) {
    const Motion motion(rotation(), {}, 0, 0.5);
    for (const double width : {0.1, 1e-3, 1e-6}) {
        const Box3d box{{3.3, 4.4, 0.5}, Vec3d{3.3, 4.4, 0.5} + Vec3d{1, 1, 1} * width};
        EXPECT_LT(length(motion.closeSources(box, 1).size()), 6 * width + 1e-4);
    }
}

TEST(Motion, TellsTheFastestVelocity) {
    const auto field = vectors(wild, {-2, -2, -2}, {1, 1, 1});
    const auto v = velocity(field);
    EXPECT_EQ(v->fastest().voxel, (Vec3i{3, 5, -2}));
    EXPECT_EQ(v->fastest().velocity, (Vec3d{400, -900, 50}));
    const Motion motion(v, Affine3d::scale({0.5, 0.5, 0.5}), -0.1, 0.05);
    EXPECT_NEAR(motion.mostVoxels(), 0.2 * length(Vec3d{400, -900, 50}), 1e-9);
    EXPECT_FALSE(v->still());
    EXPECT_TRUE(velocity(vectors([](Vec3i) { return Vec3d{}; }, {0, 0, 0}, {0, 0, 0}))->still());
}

TEST(Motion, RefusesWhatLeavesTheGrid) {
    const auto fast = velocity(vectors(
        [](Vec3i) {
            return Vec3d{1e12, 0, 0};
        },
        {0, 0, 0}, {0, 0, 0}));
    expectError(ErrorKind::Input, "velocities move a grid by up to 1e+12 voxels",
                [&] { Motion(fast, {}, 0, 1); });
    Motion(fast, {}, 0, 1e-4);
}

TEST(InterpolatedRange, HoldsAndShrinks) {
    const PlainGrid grid = mixedGrid(3);
    const Field field = grid.field();
    RandomStream random(8);
    const auto u = [&] { return random.uniform(); };
    const Box3d& all = field.support();
    for (int i = 0; i < 2000; ++i) {
        const Vec3d lower = all.lower + all.size() * Vec3d{u(), u(), u()};
        const double width = std::pow(10.0, -4 * u()) * 2;
        const Box3d box{lower, lower + Vec3d{u(), u(), u()} * width};
        const Range r = interpolatedRange(field, 0, box);
        for (int k = 0; k < 10; ++k) {
            const float f = field.trilinear(box.lower + box.size() * Vec3d{u(), u(), u()});
            EXPECT_LE(r.min, f * (1 + 1e-6f));
            EXPECT_GE(r.max * (1 + 1e-6f), f);
        }
        EXPECT_LE(r.max - r.min, 3 * length(box.size()) + 1e-6);
    }
}

}  // namespace
}  // namespace woodcock::test
