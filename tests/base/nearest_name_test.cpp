// SPDX-License-Identifier: Apache-2.0
#include "woodcock/base/nearest_name.h"

#include <gtest/gtest.h>

#include <vector>

namespace woodcock::test {
namespace {

const std::vector<std::string> keys{"file", "density", "scale", "albedo", "albedo_grid", "g"};

TEST(NearestName, FindsDroppedAddedChangedAndSwappedLetters) {
    EXPECT_EQ(nearestName("albdo", keys), "albedo");
    EXPECT_EQ(nearestName("allbedo", keys), "albedo");
    EXPECT_EQ(nearestName("denzity", keys), "density");
    EXPECT_EQ(nearestName("fiel", keys), "file");
}

TEST(NearestName, IgnoresCase) {
    EXPECT_EQ(nearestName("Density", keys), "density");
    EXPECT_EQ(nearestName("G", keys), "g");
}

TEST(NearestName, TakesTheNearerOfTwo) {
    EXPECT_EQ(nearestName("albedogrid", keys), "albedo_grid");
    EXPECT_EQ(nearestName("albedo1", keys), "albedo");
}

TEST(NearestName, StaysSilentWhenNothingIsNear) {
    EXPECT_EQ(nearestName("temperature", keys), "");
    EXPECT_EQ(nearestName("fl", std::vector<std::string>{"file"}), "");
    EXPECT_EQ(nearestName("anything", std::vector<std::string>{}), "");
}

TEST(NearestName, ListsNamesForMessages) {
    EXPECT_EQ(joinNames(std::vector<std::string>{"a", "b"}), "a, b");
    EXPECT_EQ(joinNames(std::vector<std::string>{}), "none");
    EXPECT_EQ(suggestName("scal", "known keys", std::vector<std::string>{"scale", "g"}),
              "; did you mean 'scale'? known keys: scale, g");
    EXPECT_EQ(suggestName("xyz", "it has", std::vector<std::string>{"scale"}), "; it has: scale");
}

}  // namespace
}  // namespace woodcock::test
