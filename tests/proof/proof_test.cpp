// SPDX-License-Identifier: Apache-2.0
// The proof, quickly: what `woodcock verify` runs.
#include "woodcock/proof/proof.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/paths.h"

namespace woodcock::proof {

using namespace proof;

namespace {

Options quickly() {
    Options options;
    for (const char* name : {"teapot_cloud.vdb", "fire_0045.vdb"})
        for (const auto& file : {test::sharedDir() / "assets" / name})
            if (exists(file)) options.volumes.push_back(file);
    return options;
}

class Proof : public testing::TestWithParam<std::size_t> {};

TEST_P(Proof, Holds) {
    const Check& check = checks()[GetParam()];
    const std::vector<Case> cases = run(check, quickly());
    EXPECT_FALSE(cases.empty());
    for (const Case& c : cases)
        EXPECT_EQ(c.verdict(), Verdict::Pass)
            << c.name << ": expected " << c.expected << " (to " << c.allowance << "), measured "
            << c.measured << " +- " << c.standardError << " (at most " << c.largestError << "), z "
            << c.z() << "; " << c.note;
}

std::string nameOfCheck(const testing::TestParamInfo<std::size_t>& info) {
    std::string name;
    bool capital = true;
    for (const char c : std::string(checks()[info.param].name)) {
        if (std::isalnum(static_cast<unsigned char>(c)))
            name += capital ? static_cast<char>(std::toupper(c)) : c;
        capital = !std::isalnum(static_cast<unsigned char>(c));
    }
    return name;
}

INSTANTIATE_TEST_SUITE_P(All, Proof, testing::Range(std::size_t{0}, checks().size()), nameOfCheck);

TEST(Check, KeepsWhatItHasWhenItIsStoppedOrThrows) {
    const Check endless{Kind::Property, "endless", [](Lab& lab) {
                            while (true) lab.add({.name = "one more"});
                        }};
    Options options;
    int asked = 0;
    options.stop = [&] { return ++asked == 3; };
    const std::vector<Case> cases = run(endless, options);
    ASSERT_EQ(cases.size(), 3u);
    EXPECT_EQ(cases[2].kind, Kind::Property);

    const Check faulty{Kind::Extreme, "faulty", [](Lab& lab) {
                           lab.add({.name = "before"});
                           throw std::runtime_error("no such grid");
                       }};
    const std::vector<Case> both = run(faulty, {});
    ASSERT_EQ(both.size(), 2u);
    EXPECT_EQ(both[0].verdict(), Verdict::Pass);
    EXPECT_EQ(both[1].verdict(), Verdict::Fail);
    EXPECT_EQ(both[1].note, "no such grid");
    EXPECT_EQ(both[1].kind, Kind::Extreme);
}

TEST(Case, FailsWhenItIsOffAndIsImpreciseWhenItCannotTell) {
    Case c{
        .name = "c", .expected = 1, .measured = 1.05, .standardError = 0.01, .largestError = 0.02};
    EXPECT_EQ(c.verdict(), Verdict::Fail);
    EXPECT_NEAR(c.z(), 5, 1e-12);
    c.allowance = 0.02;
    EXPECT_EQ(c.verdict(), Verdict::Pass);
    EXPECT_NEAR(c.z(), 3, 1e-12);
    c.standardError = 0.03;
    EXPECT_EQ(c.verdict(), Verdict::Imprecise);
    c.measured = std::nan("");
    EXPECT_EQ(c.verdict(), Verdict::Fail);
    c.measured = 1.03, c.standardError = 0;
    EXPECT_EQ(c.verdict(), Verdict::Fail);  // nothing is random: off is off
    c.measured = 0.99;
    EXPECT_EQ(c.verdict(), Verdict::Pass);
}

}  // namespace
}  // namespace woodcock::proof
