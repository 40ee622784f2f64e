// SPDX-License-Identifier: Apache-2.0
// What all commands have in common: options, help, versions.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cctype>
#include <nlohmann/json.hpp>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include "tests/support/paths.h"
#include "tests/support/run_program.h"
#include "woodcock/proof/support/write_vdb.h"

namespace woodcock::test {

using namespace proof;

namespace {

const std::vector<std::string> commands{"render",  "bake",  "convert", "info",
                                        "compare", "trade", "verify",  "cycles"};

std::string helpOf(const std::string& command) {
    const ProgramResult result = runProgram({command, "--help"});
    EXPECT_EQ(result.exitCode, 0) << command;
    return result.out;
}

std::vector<std::string> linesOf(const std::string& text) {
    std::vector<std::string> lines;
    std::istringstream stream(text);
    for (std::string line; std::getline(stream, line);) lines.push_back(line);
    return lines;
}

TEST(Options, EveryCommandReportsAlike) {
    for (const std::string& command : commands) {
        const std::string help = helpOf(command);
        for (const char* option : {"-q,--quiet", "--json", "--log-level LEVEL", "--progress STYLE"})
            EXPECT_NE(help.find(option), std::string::npos) << command << " " << option;
        std::vector<std::string> contradiction{command, "x.toml", "--quiet", "--log-level", "info"};
        if (command == "convert") contradiction.push_back("y.vdb");
        const ProgramResult both = runProgram(contradiction);
        EXPECT_EQ(both.exitCode, 2) << command;
        EXPECT_NE((both.out + both.err).find("contradict each other"), std::string::npos)
            << command << ": " << both.err;
        const ProgramResult wrong = runProgram({command, "x", "y", "--log-level", "loud"});
        EXPECT_EQ(wrong.exitCode, 2) << command;
        EXPECT_NE(wrong.err.find("trace, debug, info, warning, error, off"), std::string::npos)
            << command << ": " << wrong.err;
    }
}

TEST(Options, EveryHelpHasTwoExamplesThatParse) {
    for (const std::string& command : commands) {
        std::vector<std::vector<std::string>> examples;
        bool inside = false;
        for (const std::string& line : linesOf(helpOf(command))) {
            if (line == "Examples:") inside = true;
            if (!inside || !line.starts_with("  woodcock ")) continue;
            std::istringstream words(line);
            std::vector<std::string> example;
            for (std::string word; words >> word;) example.push_back(word);
            example.erase(example.begin());
            examples.push_back(example);
        }
        EXPECT_GE(examples.size(), 2U) << command;
        for (std::vector<std::string>& example : examples) {
            EXPECT_EQ(example.front(), command);
            // Options are parsed, with their values, before one that is unknown is reported.
            example.push_back("--no-such-option");
            const ProgramResult result = runProgram(example);
            EXPECT_EQ(result.exitCode, 2);
            EXPECT_EQ(result.err,
                      fmt::format("error: woodcock {0}: unknown option --no-such-option; woodcock "
                                  "{0} --help lists those that there are\n",
                                  command))
                << fmt::format("{}", fmt::join(example, " "));
        }
    }
}

TEST(Options, DescriptionsBeginWithACapital) {
    const std::regex line(R"(^  (-\S|[A-Z]{3,}).*?\s{2,}(\S.*)$)");
    std::size_t found = 0;
    for (const std::string& command : commands)
        for (const std::string& text : linesOf(helpOf(command))) {
            std::smatch match;
            if (!std::regex_match(text, match, line)) continue;
            ++found;
            EXPECT_FALSE(std::islower(static_cast<unsigned char>(match[2].str().front())))
                << command << ": " << text;
        }
    EXPECT_GT(found, 80U);
}

TEST(Options, VersionsAndHelpHaveManyWays) {
    const std::string about = runProgram({"--version"}).out;
    for (const char* part :
         {"woodcock ", "\ncommit: ", "\nbuild: ", "\nthis machine: ", "OpenVDB ", "OpenVDB AX ",
          "NanoVDB ", "Embree ", "oneTBB ", "Assimp ", "OpenImageIO ", "OpenColorIO ", "OpenEXR "})
        EXPECT_NE(about.find(part), std::string::npos) << part << "\n" << about;
    for (const std::vector<std::string>& way : std::vector<std::vector<std::string>>{
             {"-V"}, {"version"}, {"render", "--version"}, {"bake", "-V"}}) {
        const ProgramResult result = runProgram(way);
        EXPECT_EQ(result.exitCode, 0) << way.front();
        EXPECT_EQ(result.out, about) << way.front();
    }
    EXPECT_EQ(runProgram({"help"}).out, runProgram({"--help"}).out);
    for (const std::string& command : commands)
        EXPECT_EQ(runProgram({"help", command}).out, helpOf(command)) << command;
    EXPECT_EQ(runProgram({"help", "rendr"}).exitCode, 2);
}

TEST(Options, UnknownOnesNameTheNearestOnly) {
    const auto said = [](const std::string& option) {
        const ProgramResult result = runProgram({"render", "x.vdb", "-o", "x.exr", option});
        EXPECT_EQ(result.exitCode, 2);
        return result.err;
    };
    EXPECT_EQ(said("--nosie"),
              "error: woodcock render: unknown option --nosie; did you mean '--noise'?\n");
    EXPECT_EQ(said("--width=300"),
              "error: woodcock render: unknown option --width=300; the image's size is --res "
              "WIDTHxHEIGHT\n");
    EXPECT_EQ(said("--frobnicate"),
              "error: woodcock render: unknown option --frobnicate; woodcock render --help lists "
              "those that there are\n");
}

class Reports : public testing::Test {
protected:
    void SetUp() override {
        GridSpec grid;
        grid.name = "density";
        grid.box = {{0, 0, 0}, {7, 7, 7}};
        grid.value = [](Vec3i) { return 0.5; };
        writeVdb(dir / "smoke.vdb", {grid});
        writeText(dir / "ball.toml",
                  "[bounds]\nmin = [-1, -1, -1]\nmax = [1, 1, 1]\n[[output]]\nname = \"density\"\n"
                  "node = { type = \"falloff\", edge = 0.3, input = { type = \"sphere\", radius = "
                  "0.8 } }\n");
    }
    std::string file(const std::string& name) const { return (dir / name).string(); }
    std::vector<std::string> render(std::vector<std::string> more) const {
        std::vector<std::string> all{"render", file("smoke.vdb"), "-o", file("o.exr"), "--res",
                                     "8x8",    "--spp",           "1"};
        all.insert(all.end(), more.begin(), more.end());
        return all;
    }
    const TempDir dir;
};

TEST_F(Reports, LevelsDiffer) {
    std::size_t before = std::string::npos;
    for (const char* level : {"trace", "debug", "info", "warning", "off"}) {
        const ProgramResult result = runProgram(render({"--log-level", level}));
        EXPECT_EQ(result.exitCode, 0) << result.err;
        const std::size_t lines = linesOf(result.err).size();
        EXPECT_LE(lines, before) << level;
        if (std::string(level) != "off") {
            EXPECT_NE(lines, before) << level;
        }
        before = lines;
    }
    EXPECT_EQ(before, 0U);
    EXPECT_NE(runProgram(render({"--log-level", "debug"})).err.find("debug: "), std::string::npos);
    EXPECT_NE(runProgram(render({"--log-level", "trace"})).err.find("trace: "), std::string::npos);
    EXPECT_EQ(runProgram(render({"--log-level", "error"})).err, "");
    EXPECT_EQ(runProgram(render({"--log-level", "warn"})).exitCode, 0);
}

TEST_F(Reports, JsonIsOneDocumentOnStdout) {
    const auto json = [](std::vector<std::string> arguments) {
        arguments.insert(arguments.end(), {"--json", "--quiet"});
        const ProgramResult result = runProgram(arguments);
        EXPECT_EQ(result.exitCode, 0) << arguments.front() << ": " << result.err;
        EXPECT_EQ(result.err, "") << arguments.front();
        return nlohmann::json::parse(result.out, nullptr, false);
    };
    EXPECT_EQ(json(render({})).at("files").at(0), file("o.exr"));
    EXPECT_EQ(json(render({})).at("end_sample"), 1);
    const auto converted = json({"convert", file("smoke.vdb"), file("c.vdb"), "--scale", "2"});
    EXPECT_EQ(converted.at("output"), file("c.vdb"));
    EXPECT_EQ(converted.at("bytes"), std::filesystem::file_size(file("c.vdb")));
    EXPECT_EQ(converted.at("grids").at(0).at("name"), "density");
    EXPECT_EQ(json({"info", file("smoke.vdb")}).at("files").at(0).at("file"), file("smoke.vdb"));
    const auto baked = json({"bake", file("ball.toml"), "-o", file("b.vdb"), "--resolution", "16"});
    EXPECT_EQ(baked.at("files").at(0).at("file"), file("b.vdb"));
    EXPECT_EQ(baked.at("grids").at(0).at("name"), "density");
    // It warns that the two have one seed.
    const ProgramResult compared = runProgram({"compare", file("o.exr"), file("o.exr"), "--json"});
    EXPECT_TRUE(nlohmann::json::parse(compared.out, nullptr, false).is_object()) << compared.out;
}

TEST_F(Reports, QuietPrintsNothingWhereAllIsWell) {
    for (const std::vector<std::string>& command : std::vector<std::vector<std::string>>{
             render({}),
             {"info", file("smoke.vdb")},
             {"convert", file("smoke.vdb"), file("c.vdb")},
             {"bake", file("ball.toml"), "-o", file("b.vdb"), "--resolution", "16"}}) {
        std::vector<std::string> quiet = command;
        quiet.push_back("-q");
        const ProgramResult result = runProgram(quiet);
        EXPECT_EQ(result.exitCode, 0) << command.front() << ": " << result.err;
        EXPECT_EQ(result.out + result.err, "") << command.front();
    }
    EXPECT_EQ(runProgram({"info", file("missing.vdb"), "-q"}).exitCode, 3);
}

}  // namespace
}  // namespace woodcock::test
