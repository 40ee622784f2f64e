// SPDX-License-Identifier: Apache-2.0
#include "woodcock/bake/ax_expression.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <openvdb/tools/Prune.h>
#include <tbb/global_control.h>

#include <cmath>
#include <cstring>
#include <random>
#include <string>
#include <vector>

#include "tests/support/expect_error.h"
#include "woodcock/grid/vdb/openvdb_grids.h"
#include "woodcock/grid/vdb/openvdb_trees.h"

namespace woodcock::test {

using namespace bake;
using namespace grid;

namespace {

using openvdb::Coord;
using openvdb::CoordBBox;
using openvdb::FloatGrid;
using openvdb::Vec3s;
using openvdb::Vec3SGrid;

const std::string place = "cumulus.toml:12:8";

template <class Grid>
typename Grid::Ptr makeGrid(const std::string& name, typename Grid::ValueType background = {}) {
    openvdb::initialize();
    auto grid = Grid::create(background);
    grid->setName(name);
    return grid;
}

void run(const std::string& code, const openvdb::GridPtrVec& grids) {
    VdbGrids all{grids};
    AxExpression(code, place).run(all);
    EXPECT_EQ(all.grids, grids) << "no grid is added";
}

class AxExpressionTest : public ::testing::Test {
protected:
    void SetUp() override {
        if (!axAvailable()) GTEST_SKIP() << "this build has no OpenVDB AX";
        density_ = makeGrid<FloatGrid>("density");
        for (int i = -20; i < 30; ++i)
            density_->tree().setValueOn({i, 3 * i, 7 - i}, 0.25F * static_cast<float>(i));
        colour_ = makeGrid<Vec3SGrid>("Cd");
        colour_->tree().setValueOn({1, 2, 3}, {4, 5, 6});
    }
    void expectRefused(const std::string& code, const std::string& message) {
        expectError(ErrorKind::Input, place + ": AX " + message, [&] { run(code, {density_}); });
    }

    FloatGrid::Ptr density_;
    Vec3SGrid::Ptr colour_;
};

TEST_F(AxExpressionTest, ValuesAreExact) {
    const auto before = density_->deepCopy();
    run("@density = 2 * @density + getcoordx();", {density_});
    EXPECT_EQ(density_->activeVoxelCount(), 50U);
    for (auto voxel = before->cbeginValueOn(); voxel; ++voxel)
        EXPECT_EQ(density_->tree().getValue(voxel.getCoord()),
                  2 * *voxel + static_cast<float>(voxel.getCoord().x()));
}

TEST_F(AxExpressionTest, InactiveVoxelsAndTheBackgroundStay) {
    density_->tree().setValueOff({5, 15, 3}, 8);  // in a leaf that has an active voxel, 5, 15, 2
    run("@density = 1;", {density_});
    EXPECT_EQ(density_->tree().getValue({5, 15, 2}), 1);
    EXPECT_EQ(density_->activeVoxelCount(), 50U);
    EXPECT_EQ(density_->tree().getValue({5, 15, 3}), 8);
    EXPECT_FALSE(density_->tree().isValueOn({5, 15, 3}));
    EXPECT_EQ(density_->background(), 0);
}

TEST_F(AxExpressionTest, VectorsAndSeveralGrids) {
    const auto heat = makeGrid<openvdb::DoubleGrid>("heat");
    heat->tree().setValueOn({1, 2, 3}, 0.5);
    const auto count = makeGrid<openvdb::Int32Grid>("count");
    count->tree().setValueOn({1, 2, 3}, 7);
    run("v@Cd.y = v@Cd.x + 10;\n v@Cd *= {1, 1, 0.5};\n double@heat = 3 * i@count; i@count = "
        "i@count % "
        "4;",
        {colour_, heat, count});
    EXPECT_EQ(colour_->tree().getValue({1, 2, 3}), Vec3s(4, 14, 3));
    EXPECT_EQ(heat->tree().getValue({1, 2, 3}), 21) << "what is read is from before the run";
    EXPECT_EQ(count->tree().getValue({1, 2, 3}), 3);
}

TEST_F(AxExpressionTest, PositionsGoThroughTheTransform) {
    colour_->setTransform(openvdb::math::Transform::createLinearTransform(0.25));
    run("v@Cd = getvoxelpws();", {colour_});
    EXPECT_EQ(colour_->tree().getValue({1, 2, 3}), Vec3s(0.25F, 0.5F, 0.75F));
}

class AxTileTest : public AxExpressionTest {
protected:
    void SetUp() override {
        AxExpressionTest::SetUp();
        tiles_ = makeGrid<FloatGrid>("density");
        tiles_->fill(CoordBBox({0, 0, 0}, {127, 127, 127}), 2);  // one tile of the second level
        tiles_->fill(CoordBBox({128, 0, 0}, {135, 7, 7}), 3);    // one of the first
    }
    FloatGrid::Ptr tiles_;
};

TEST_F(AxTileTest, BecomeVoxelsWhereTheyComeToDiffer) {
    const auto count = tiles_->activeVoxelCount();
    ASSERT_EQ(tiles_->tree().leafCount(), 0U);
    run("@density = @density * getcoordx() + getcoordy();", {tiles_});
    EXPECT_EQ(tiles_->activeVoxelCount(), count);
    std::size_t wrong = 0;
    for (auto voxel = tiles_->cbeginValueOn(); voxel; ++voxel) {
        ASSERT_TRUE(voxel.isVoxelValue());
        const Coord at = voxel.getCoord();
        wrong += *voxel != static_cast<float>((at.x() < 128 ? 2 : 3) * at.x() + at.y());
    }
    EXPECT_EQ(wrong, 0U);
}

TEST_F(AxTileTest, StayWhereNothingDiffers) {
    run("@density = 3 * @density;", {tiles_});
    run("@density = getcoordx() < 1000 ? @density : 0;", {tiles_});
    openvdb::tools::prune(tiles_->tree());
    EXPECT_EQ(tiles_->tree().leafCount(), 0U);
    EXPECT_EQ(tiles_->tree().activeTileCount(), 2U);
    EXPECT_EQ(tiles_->tree().getValue({127, 0, 0}), 6);
    EXPECT_EQ(tiles_->tree().getValue({128, 0, 0}), 9);
}

TEST_F(AxTileTest, FollowTheVoxelsOfOtherGrids) {
    const auto mask = makeGrid<FloatGrid>("mask");
    mask->fill(CoordBBox({3, 4, 5}, {40, 50, 60}), 1);
    for (const char* code : {"if (@mask > 0) @density = 7; else @density = 1;",
                             "float value = 1; if (@mask > 0) value = 7; @density = value;",
                             "@density = 1; for (int i = 0; i < 6 * @mask; ++i) @density += 1;"}) {
        const auto grid = tiles_->deepCopy();
        run(code, {grid, mask});
        std::size_t wrong = 0;
        for (int x = 0; x < 64; ++x)
            for (int y = 0; y < 64; ++y)
                for (int z = 0; z < 64; ++z)
                    wrong += grid->tree().getValue({x, y, z}) !=
                             (mask->tree().isValueOn({x, y, z}) ? 7.0F : 1.0F);
        EXPECT_EQ(wrong, 0U) << code;
        EXPECT_EQ(grid->activeVoxelCount(), tiles_->activeVoxelCount()) << code;
    }
}

TEST_F(AxExpressionTest, ThreadsLeaveNoTrace) {
    const auto made = [&](std::size_t threads) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
        const auto grid = makeGrid<FloatGrid>("density");
        grid->fill(CoordBBox({0, 0, 0}, {71, 71, 71}), 1);
        for (int i = 0; i < 3000; ++i) grid->tree().setValueOn({-i, i % 50, i % 31}, 2);
        const auto other = makeGrid<FloatGrid>("other");
        other->fill(CoordBBox({0, 0, 0}, {30, 71, 71}), 3);
        run("@density += simplexnoise(getvoxelpws() * 0.1) + rand(getcoordx() + 100 * getcoordy());"
            "@other = sin(@density);",
            {grid, other});
        return std::pair{grid, other};
    };
    const auto [one, oneOther] = made(1);
    const auto [many, manyOther] = made(4);
    for (const auto& [a, b] : {std::pair{one, many}, std::pair{oneOther, manyOther}}) {
        EXPECT_TRUE(a->tree().hasSameTopology(b->tree()));
        std::size_t different = 0, compared = 0;
        for (auto voxel = a->cbeginValueOn(); voxel; ++voxel, ++compared) {
            const float x = *voxel, y = b->tree().getValue(voxel.getCoord());
            different += std::memcmp(&x, &y, sizeof x) != 0;
        }
        EXPECT_EQ(different, 0U);
        EXPECT_GT(compared, 1000U);
    }
}

TEST_F(AxExpressionTest, OneProgramRunsOnManyGrids) {
    const AxExpression twice("@density *= 2;", place);
    for (const float value : {1.0F, 3.0F}) {
        VdbGrids grids{{makeGrid<FloatGrid>("density")}};
        auto& tree = static_cast<FloatGrid&>(*grids.grids.front()).tree();
        tree.setValueOn({0, 0, 0}, value);
        twice.run(grids);
        EXPECT_EQ(tree.getValue({0, 0, 0}), 2 * value);
    }
}

TEST_F(AxExpressionTest, WhatIsNoNumberIsStored) {
    for (const char* code : {"@density = sqrt(-1 - abs(@density));", "@density = log(-1.0);",
                             "@density = (@density - @density) / (@density - @density);"}) {
        run(code, {density_});
        EXPECT_EQ(density_->activeVoxelCount(), 50U);
        for (auto voxel = density_->cbeginValueOn(); voxel; ++voxel)
            EXPECT_TRUE(std::isnan(*voxel)) << code;
        density_->tree().clearAllAccessors();
        for (auto voxel = density_->beginValueOn(); voxel; ++voxel) voxel.setValue(1);
    }
}

TEST_F(AxExpressionTest, GridsThatDoNotExistAreNamed) {
    expectError(ErrorKind::Input,
                place + ": AX 2:6: there is no grid float@temp; there is float@density, vec3f@Cd",
                [&] {
                    run("@density *=\n 3 * @temp;", {density_, colour_});
                });
    expectError(ErrorKind::Input, place + ": AX 1:1: there is no grid float@heat; there is none",
                [&] { run("@heat = 1;", {}); });
    expectError(ErrorKind::Input,
                place + ": AX 1:9: there is no grid float@Cd; there is float@density, vec3f@Cd",
                [&] {
                    run("float x=@Cd; @density = x;", {density_, colour_});
                });
}

TEST_F(AxExpressionTest, ErrorsHaveLineAndColumn) {
    expectRefused("@density = \n", "1:12: unexpected end of file");
    expectRefused("@density = 1\n@density = 2;", "2:1: unexpected AT, expecting SEMICOLON");
    expectRefused("@density = foo(1);", "1:12: unable to locate function \"foo\"");
    expectRefused("int x = 1;\n\n   @density = x + y;",
                  "3:19: variable \"y\" hasn't been declared");
    expectRefused("@density = a; @density = b;",
                  "1:12: variable \"a\" hasn't been declared; AX 1:26: variable \"b\" hasn't been "
                  "declared");
    expectRefused("int a = 99999999999999999999;",
                  "1:9: integer constant is too large to be represented");
    expectRefused("@density = " + std::string(12000, '('), "1:10008: nested too deeply");
    expectError(ErrorKind::Input, "cannot be called",
                [] { AxExpression("deletepoint();", place); });
}

TEST_F(AxExpressionTest, WhatWouldEndTheProgramIsRefused) {
    const std::string divided = "integers may be divided by positive constants only";
    for (const char* code : {"i@n = 1 / i@n;",
                             "i@n = 1 / 0;",
                             "i@n = 1 % (2 - 2);",
                             "i@n /= i@n;",
                             "i@n %= -1;",
                             "int a = 0; i@n = 5 / a;",
                             "int a; int b; i@n = 5 / (a = 0, b = 0);",
                             "i@n = i@n / int(0.5);",
                             "vec3i@p = getcoord() / {1, 0, 1};",
                             "@density = 1 / (getcoordx() * 2);",
                             "@density = 1 / abs(getcoordx());",
                             "@density = floormod(3, getcoordz());",
                             "@density = 1 / (true ? getcoordx() : 0);",
                             "@density = 1 / (getcoordx() ?: 0);",
                             "@density = 1 / (getcoordx() > 0);",
                             "@density = 1 / -getcoordx();",
                             "@density = 1 / !getcoordx();",
                             "int i = 3; @density = 1 / i--;",
                             "if (true) { float a = 1; } else { int a = 0; @density = 1 / a; }",
                             "@density = 1 / sign(@density);",
                             "i@n = i@n / 4294967296;",
                             "vec3i v = getcoord(); @density = 1 / v.x;"})
        EXPECT_NE(messageOf(ErrorKind::Input, [&] { AxExpression(code, place); }).find(divided),
                  std::string::npos)
            << code;
    expectRefused("@density = 1;\n @density = 1 / getcoordx();", "2:13: " + divided);

    expectRefused("vec3f@Cd[7] = 1;", "1:1: a component's index must be a number from 0 to 2");
    expectRefused("int k = 7000; @density = v@Cd[k];", "1:26: a component's index");
    expectRefused("@density = v@Cd[-1];", "1:12: a component's index");
    expectRefused("mat3f m = 1; @density = m[1, 3];",
                  "1:25: a component's index must be a number from 0 to 2");
    expectRefused("mat3f m = 1; @density = m[9];",
                  "1:25: a component's index must be a number from 0 to 8");
    expectRefused("vec2f a = {1, 2}; @density = a.z;", "1:30: a component's index");
    expectRefused("@density = rand();", "1:12: rand() needs a seed");
    expectRefused("@density = rand32();", "1:12: rand32() needs a seed");
    expectRefused("@density = external(\"a\");", "1:12: external() has no data");
    expectRefused("@density = $frame;", "1:12: a $variable");
    expectRefused("print(@density);", "1:1: print() is not possible");
    expectRefused(std::string("@density = 1;\0 @density = 2;", 28), "code with a null character");
    expectRefused("@density = 1" + std::string(200000, ' ') + ";", "code of 200013 characters");
}

TEST_F(AxExpressionTest, WhatIsSafeIsNotRefused) {
    for (const char* code :
         {"@density = getcoordx() % 8 + getcoordy() / 3;", "@density = 1 / @density;",
          "@density = 1 / float(getcoordx());", "@density = 2.5 / getcoordx();",
          "@density = 1 / sqrt(2);", "@density = 1 / max(getcoordx(), 0.5);",
          "float a = 0; @density = 1 / a;", "v@Cd = getcoord() / {2, 2, 2};",
          "v@Cd = getcoord() / v@Cd;", "@density /= getcoordx();", "@density = v@Cd.z + v@Cd[2];",
          "mat4f m = identity4(); @density = m[15] + m[3, 3];", "@density = rand(getcoordx());",
          "@density = 1 / (getcoordx() > 0 ? 0.5 : 2);", "@density = floormod(@density, 0);"})
        EXPECT_NO_THROW(run(code, {density_, colour_})) << code;
}

TEST_F(AxExpressionTest, CastsToAnyTypeGiveTheValue) {
    // Among them casts to the type that a value has already, in every place that code has.
    const std::pair<const char*, double> cases[]{
        {"@density = 0.5f * float(@density);", 1.25},
        {"@density = float(0.5f) + float(0.25);", 0.75},
        {"@density = float(float(float(@density)));", 2.5},
        {"@density = double(double(@density)) + double(0.5);", 3},
        {"@density = int(int(@density)) + int(3) + int64(4l) + long(5);", 14},
        {"@density = bool(bool(@density)) + bool(true) + bool(0.25) + bool(0);", 3},
        {"@density = sin(float(0.0f)) + max(float(@density), float(1.0f));", 2.5},
        {"@density *= float(@density);", 6.25},
        {"@density = float(-@density);", -2.5},
        {"@density = float(@density--) + float(@density);", 4},
        {"@density = (1, 2, float(3.0f));", 3},
        {"@density = @density > 5 ? float(@density) : int(7);", 7},
        {"@density = float(@density) ?: int(1);", 2.5},
        {"@density = float(@density) && bool(true);", 1},
        {"float(@density), int(1); @density += 1;", 3.5},
        {"float x = float(@density), y = float(x); @density = y;", 2.5},
        {"vec3f v = {float(@density), 1, 2}; @density = float(v.x) + float(v[2]);", 4.5},
        {"vec3f v = 0; v.y = float(v.x) + float(3.0f); @density = v.y;", 3},
        {"mat3f m = 1; m[0, 1] = float(2.0f); @density = float(m[0, 1]);", 2},
        {"@density = 0; for (int i = int(0); bool(i < 3); i = int(i + 1)) @density += "
         "float(1.0f);",
         3},
        {"int i = 0; do { i++; } while (bool(i < 5)); @density = i;", 5},
        {"if (bool(true)) { @density = int(4); } else { @density = int(5); }", 4},
        {"@density = int(-7.9);", -7}};
    for (const auto& [code, value] : cases) {
        const auto grid = makeGrid<FloatGrid>("density");
        grid->tree().setValueOn({1, 2, 3}, 2.5F);
        run(code, {grid});
        EXPECT_EQ(grid->tree().getValue({1, 2, 3}), static_cast<float>(value)) << code;
    }
    expectRefused("@density = 1;\n @density = float(v@Cd);", "2:13: cannot assign a scalar value");
    expectRefused("@density = float({1, 2, 3});", "1:12: cannot assign a scalar value");
    expectRefused("@density = float(nothing);", "1:18: variable \"nothing\" hasn't been declared");
}

TEST_F(AxExpressionTest, LoopsGoRoundAMillionTimes) {
    const auto one = makeGrid<FloatGrid>("density");
    one->tree().setValueOn({1, 2, 3}, 0);
    run("for (int i = 0; i < 999999; ++i) { @density += 1; }", {one});
    EXPECT_EQ(one->tree().getValue({1, 2, 3}), 999999);
    for (const char* code :
         {"while (true) {}", "for (;;) {}", "do {} while (1);", "for (;;) { continue; }",
          "while (@density >= 0) @density += 1;", "for (int i = 0; i < 2000000000; ++i) {}",
          "for (int i = 0; i < 3; ++i) i = 0;",
          "for (int i = 0; i < 2000; ++i) for (int j = 0; j < 2000; ++j) @density += 1;",
          "while (true) { while (true) { break; } }",
          "int i = 0; while (true) { if (++i > 1500000) return; }"}) {
        const auto grid = makeGrid<FloatGrid>("density");
        grid->tree().setValueOn({1, 2, 3}, 1);
        expectError(ErrorKind::Input,
                    place + ": AX: its loops run more than 1000000 rounds at one voxel",
                    [&] { run("@density += 1; " + std::string(code), {grid}); });
    }
    // Each voxel has its own million.
    const auto many = makeGrid<FloatGrid>("density");
    many->fill(CoordBBox({0, 0, 0}, {15, 15, 15}), 0);
    run("for (int i = 0; i < 1000; ++i) { @density += 1; }", {many});
    EXPECT_EQ(many->tree().getValue({15, 15, 15}), 1000);
    expectRefused("while (int i = 0) {}", "1:8: a loop's condition must not declare a variable");
}

TEST_F(AxExpressionTest, EndsWhereItIsToldTo) {
    const auto grid = makeGrid<FloatGrid>("density");
    grid->fill(CoordBBox({0, 0, 0}, {255, 255, 255}), 0);
    VdbGrids grids{{grid}};
    // A sixteenth of a million million rounds, which would take a day.
    const AxExpression code(
        "for (int i = 0; i < 900000; ++i) @density = sin(@density) + getcoordx();", place);
    int asked = 0;
    EXPECT_FALSE(code.run(grids, [&] { return ++asked < 3; }));
    EXPECT_EQ(asked, 3);
    expectError(ErrorKind::Failure, "no more",
                [&] { code.run(grids, []() -> bool { throw failure("no more"); }); });
    const AxExpression quick("@density = 1;", place);
    EXPECT_TRUE(quick.run(grids, [] { return true; }));
}

TEST_F(AxExpressionTest, TextAndWhatHasNoDefinedValueIsRefused) {
    expectRefused("string s = \"aaaaaaaaaa\";", "1:1: a text variable has no use here");
    expectRefused("for (int i = 0; i < 40; ++i) { string s; s += s; }", "1:32: a text variable");
    expectRefused("@density = atof(\"1\");", "1:17: text has no use here");
    expectRefused("if (@density > 0.5) return; @density = hash(\"abc\");", "1:45: text has no use");
    expectRefused("s@name = 1;", "1:1: text has no use here");
    expectRefused("@density = 1 << 32;", "1:12: bits may be shifted by a constant from 0 to 31");
    expectRefused("int a = 1; a >>= getcoordx();", "1:12: bits may be shifted");
    std::string nested;
    for (int i = 0; i < 40; ++i) nested += "for (;;) ";
    expectRefused(nested + "break;", "1:289: more than 32 nested blocks");
    const auto grid = makeGrid<FloatGrid>("density");
    grid->tree().setValueOn({0, 0, 0}, 0);
    run("@density = (3 << 31 >> 31) + (1 << 0);", {grid});
    EXPECT_EQ(grid->tree().getValue({0, 0, 0}), 0);
}

TEST_F(AxExpressionTest, MalformedCodeIsAnErrorAndNothingElse) {
    const std::string deep(4000, '{');
    for (const std::string& code :
         std::vector<std::string>{";;;;=",
                                  "@",
                                  "@@",
                                  "@density",
                                  "@density =;",
                                  "= 1;",
                                  "@density = = 1;",
                                  "@density + ;",
                                  "\"",
                                  "\"unclosed",
                                  "'",
                                  "/*",
                                  "/* /* */",
                                  "{",
                                  "}",
                                  "(",
                                  ")",
                                  "[",
                                  "]",
                                  "@density[",
                                  "@density = {1,2",
                                  "@density = {1,2};",
                                  "@density = {};",
                                  "if",
                                  "if (",
                                  "if () ;",
                                  "for (;;",
                                  "while",
                                  "do {} while",
                                  "return 1;",
                                  "break;",
                                  "continue;",
                                  "int;",
                                  "int int = 1;",
                                  "float 3a = 1;",
                                  "vec3f a = {1,2};",
                                  "mat3f m = {1,2,3};",
                                  "string s = 1;",
                                  "s@name = \"x\";",
                                  "@density = \"text\";",
                                  "@density = sin();",
                                  "@density = sin(1,2,3);",
                                  "@density = sin(\"a\");",
                                  "@density.x = 1;",
                                  "1 = @density;",
                                  "@density = 1.2.3;",
                                  "@density = 1e;",
                                  "@density = 0x;",
                                  "#include <x>",
                                  "\\",
                                  "\x01\x7f\xff\xfe",
                                  "é = 1;",
                                  "int a; int a;",
                                  "@density = @density ? : ;",
                                  "v@density = m@density * 2;",
                                  deep,
                                  deep + "@density = " + std::string(4000, '}'),
                                  "@density = " + std::string(9000, '-') + "1;",
                                  "@density = " + std::string(4000, '!') + ";",
                                  "@" + std::string(16000, 'a') + " = 1;",
                                  "@density = " + std::string(16000, 'a') + ";"})
        EXPECT_NE(messageOf(ErrorKind::Input,
                            [&] {
                                run(code, {density_, colour_});
                            }),
                  "no error")
            << code.substr(0, 80);
}

TEST_F(AxExpressionTest, DamagedCodeRunsOrIsAnError) {
    const std::string good =
        "vec3f p = getvoxelpws(); float n = simplexnoise(p * 2); if (n > 0.5 && @density < 1) { "
        "@density += fit(n, 0.5, 1, 0, v@Cd.y); } else @density = 1 - i@id % 3;";
    std::mt19937 random(7);
    int errors = 0;
    for (int i = 0; i < 60; ++i) {
        std::string code = good;
        for (int change = 0; change < 2; ++change) {
            const std::size_t at = random() % code.size();
            if (random() % 2)
                code.erase(at, 1 + random() % 4);
            else
                code[at] = good[random() % good.size()];
        }
        try {
            AxExpression(code, place);
        } catch (const Error& error) {
            EXPECT_EQ(error.kind(), ErrorKind::Input);
            EXPECT_EQ(std::string(error.what()).find(place + ": AX"), 0U) << error.what();
            ++errors;
        }
    }
    EXPECT_GT(errors, 30) << "most changes are damage";
}

TEST(AxMissing, IsSaid) {
    if (axAvailable()) GTEST_SKIP() << "this build has OpenVDB AX";
    expectError(ErrorKind::Input,
                place + ": this build has no OpenVDB AX; install libopenvdb-ax-dev and configure",
                [] { AxExpression("@density = 1;", place); });
}

}  // namespace
}  // namespace woodcock::test
