// SPDX-License-Identifier: Apache-2.0
// What the comparisons with other renderers rest on: the computation of costs, and scenes that
// Woodcock and Cycles take.
#include <gtest/gtest.h>

#include "tests/support/paths.h"
#include "tests/support/run_program.h"
#include "woodcock/scene/scene_file.h"

namespace woodcock::test {

namespace {

namespace fs = std::filesystem;

fs::path benchDir() { return sourceDir() / "tests/bench"; }

TEST(PeersScript, CostsFollowFromTwoPictures) {
    if (!fs::exists("/usr/bin/python3")) GTEST_SKIP() << "no python3";
    const ProgramResult result = runProgram(
        {(sourceDir() / "tests/programs/peers_cost.py").string(), (benchDir() / "peers").string()},
        {}, "/usr/bin/python3");
    EXPECT_EQ(result.exitCode, 0) << result.err;
    EXPECT_NE(result.err.find("Ran 7 tests"), std::string::npos) << result.err;
}

TEST(PeersScript, ScriptsExplainThemselves) {
    for (const char* name : {"peers.sh", "production_sizes.sh"}) {
        const ProgramResult help = runProgram({"--help"}, {}, benchDir() / name);
        EXPECT_EQ(help.exitCode, 0) << help.err;
        EXPECT_NE(help.out.find("--woodcock"), std::string::npos) << help.out;
        const ProgramResult wrong = runProgram({"--no-such-option"}, {}, benchDir() / name);
        EXPECT_EQ(wrong.exitCode, 2);
        EXPECT_EQ(wrong.err, help.out);
        const ProgramResult nothing =
            runProgram({"--woodcock", "/no/such/program"}, {}, benchDir() / name);
        EXPECT_EQ(nothing.exitCode, 2);
        EXPECT_NE(nothing.err.find("there is no /no/such/program"), std::string::npos)
            << nothing.err;
    }
}

TEST(PeersScript, ScenesParse) {
    int count = 0;
    for (const auto& entry : fs::directory_iterator(benchDir() / "scenes")) {
        if (entry.path().extension() != ".toml") continue;
        EXPECT_NO_THROW(scene::parseScene(entry.path())) << entry.path();
        ++count;
    }
    EXPECT_EQ(count, 8);
}

}  // namespace

}  // namespace woodcock::test
