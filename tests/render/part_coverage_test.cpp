// SPDX-License-Identifier: Apache-2.0
#include "woodcock/render/part_coverage.h"

#include <gtest/gtest.h>

namespace woodcock::test {

using namespace render;
using image::Film;
using Words = std::vector<std::string>;

namespace {

constexpr Film::Window picture{0, 0, 8, 4}, left{0, 0, 4, 4}, right{4, 0, 8, 4};

PartCoverage part(const char* name, std::uint32_t first, std::uint32_t end,
                  Film::Window window = picture, std::uint64_t seed = 0) {
    return {.name = name,
            .window = window,
            .seed = seed,
            .first = first,
            .end = end,
            .drawn = {},
            .asked = end};
}

void expectFaults(const std::vector<PartCoverage>& parts, const Words& doubled,
                  const Words& missing, std::uint32_t spp = 0) {
    const CoverageFaults faults = findFaults(parts, picture, spp);
    EXPECT_EQ(faults.doubled, doubled);
    EXPECT_EQ(faults.missing, missing);
}

TEST(PartCoverage, WholePicturesHaveNoFaults) {
    expectFaults({part("a", 0, 16)}, {}, {});
    expectFaults({part("b", 16, 20), part("a", 0, 16)}, {}, {});
    expectFaults({part("a", 0, 16, left), part("b", 0, 9, right), part("c", 9, 16, right)}, {}, {});
    expectFaults(
        {part("a", 0, 4, left, 1), part("b", 0, 4, right, 1), part("c", 0, 99, picture, 2)}, {},
        {});
}

TEST(PartCoverage, NamesWhatIsDoubled) {
    expectFaults({part("a", 0, 16), part("b", 8, 20)},
                 {"'a' and 'b' both hold samples 8:16 of all pixels (seed 0)"}, {});
    expectFaults({part("a", 0, 16), part("b", 0, 16, {2, 1, 4, 3})},
                 {"'a' and 'b' both hold samples 0:16 of 4 pixels in 2,1,4,3 (seed 0)"}, {});
    expectFaults({part("a", 0, 16, picture, 1), part("b", 0, 16, picture, 2)}, {}, {});
}

TEST(PartCoverage, NamesWhatIsMissing) {
    expectFaults({part("a", 0, 16), part("b", 32, 48)}, {},
                 {"samples 16:32 of all pixels are missing (seed 0)"});
    expectFaults({part("a", 4, 16, picture, 7)}, {},
                 {"samples 0:4 of all pixels are missing (seed 7)"});
    expectFaults({part("a", 0, 16, left), part("b", 0, 8, right)}, {},
                 {"samples 8:16 of 16 pixels in 4,0,8,4 are missing (seed 0)"});
    expectFaults({part("a", 0, 16, left)}, {},
                 {"samples 0:16 of 16 pixels in 4,0,8,4 are missing (seed 0)"});
    expectFaults({part("a", 0, 16)}, {}, {"samples 16:32 of all pixels are missing (seed 0)"}, 32);
}

/// Interrupted within a pass.
TEST(PartCoverage, LooksAtEveryPixelOfAnUnevenPart) {
    PartCoverage a = part("a", 0, 16);
    a.drawn.assign(32, 16);
    a.drawn[8 + 3] = 12, a.drawn[16 + 5] = 12;
    expectFaults({a}, {}, {"samples 12:16 of 2 pixels in 3,1,6,3 are missing (seed 0)"});
    expectFaults({a, part("b", 16, 20)}, {},
                 {"samples 12:16 of 2 pixels in 3,1,6,3 are missing (seed 0)"});
    expectFaults({a, part("b", 14, 20)},
                 {"'a' and 'b' both hold samples 14:16 of 30 pixels in 0,0,8,4 (seed 0)"},
                 {"samples 12:14 of 2 pixels in 3,1,6,3 are missing (seed 0)"});
}

/// A limit of time or noise may end a part anywhere, but nothing may follow it.
TEST(PartCoverage, LimitedPartsEndWhereTheyEnd) {
    PartCoverage a = part("a", 0, 16);
    a.asked = 0;
    a.drawn.assign(32, 16);
    a.drawn[3] = 12;
    expectFaults({a}, {}, {});
    expectFaults({a, part("b", 16, 20)}, {},
                 {"samples 12:16 of 1 pixels in 3,0,4,1 are missing (seed 0)"});
    expectFaults({a}, {}, {"samples 12:16 of 1 pixels in 3,0,4,1 are missing (seed 0)"}, 16);
    PartCoverage tile = a;
    tile.window = left, tile.drawn.resize(16);
    expectFaults({tile}, {}, {"all samples of 16 pixels in 4,0,8,4 are missing (seed 0)"});
}

}  // namespace
}  // namespace woodcock::test
