// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "tests/support/paths.h"

namespace woodcock::test {

namespace {

namespace fs = std::filesystem;

/// What each room of lib/woodcock includes besides itself.
const std::map<std::string, std::set<std::string>> roomsBelow{
    {"base", {}},
    {"grid", {"base"}},
    {"medium", {"grid", "base"}},
    {"light", {"medium", "base"}},
    {"mesh", {"grid", "base"}},
    {"surface", {"mesh", "base"}},
    {"camera", {"base"}},
    {"image", {"base"}},
    {"denoise", {"image", "base"}},
    {"render", {"medium", "light", "surface", "camera", "image", "base"}},
    {"convert", {"mesh", "image", "grid", "base"}},
    {"bake", {"convert", "image", "grid", "base"}},
    {"compare", {"image", "base"}},
    {"scene",
     {"render", "denoise", "image", "light", "surface", "camera", "medium", "mesh", "grid",
      "base"}},
    {"proof", {"scene", "render", "light", "medium", "grid", "base"}},
    {"trade", {"scene", "compare", "bake", "render", "denoise", "medium", "grid", "base"}}};

/// Where the headers of heavy libraries may appear: in .cpp files of these rooms, and in headers
/// that bear the library's name, which only .cpp files and each other include.
const std::map<std::string, std::set<std::string>> roomsOfLibrary{
    {"openvdb", {"grid", "mesh", "convert", "bake", "proof"}},
    {"openvdb_ax", {"bake"}},
    {"nanovdb", {"grid", "convert"}},
    {"assimp", {"mesh"}},
    {"embree3", {"surface"}},
    {"embree4", {"surface"}},
    {"OpenImageIO", {"image", "proof"}},
    {"OpenColorIO", {"image"}},
    {"OpenEXR", {"image"}}};
/// What is installed, and what it is made of: it stands before the rooms, and may know them all.
bool isPublicDoor(const fs::path& file) {
    return file == "error.h" || file == "woodcock.h" || file == "woodcock.cpp";
}

bool bearsName(const fs::path& header) {
    const std::string name = header.filename().string();
    return name.starts_with("openvdb_") || name.starts_with("openimageio_") ||
           name.starts_with("opencolorio_");
}

struct Include {
    fs::path file, included;  ///< `file` in lib/woodcock
    std::string room() const { return file.begin()->string(); }
    /// The room of ours that is included; empty for a library.
    std::string otherRoom() const {
        return *included.begin() == "woodcock" ? std::next(included.begin())->string() : "";
    }
    std::string library() const { return included.begin()->string(); }
};

std::vector<Include> includesIn(const fs::path& lib) {
    static const std::regex include(R"(^\s*#\s*include\s*[<"]([^>"]+)[>"])");
    std::vector<Include> found;
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(lib)) {
        if (!entry.is_regular_file() || isPublicDoor(fs::relative(entry.path(), lib))) continue;
        std::istringstream text(readText(entry.path()));
        std::smatch match;
        for (std::string line; std::getline(text, line);)
            if (std::regex_search(line, match, include))
                found.push_back({fs::relative(entry.path(), lib), match[1].str()});
    }
    return found;
}

bool isAllowed(const Include& i) {
    const bool mayUseLibraries = i.file.extension() == ".cpp" || bearsName(i.file);
    if (const std::string other = i.otherRoom(); !other.empty())
        return (other == i.room() || other == "error.h" ||
                roomsBelow.at(i.room()).contains(other)) &&
               (!bearsName(i.included) || mayUseLibraries);
    const auto library = roomsOfLibrary.find(i.library());
    return library == roomsOfLibrary.end() ||
           (mayUseLibraries && library->second.contains(i.room()));
}

std::vector<std::string> unknownRooms(const fs::path& lib) {
    std::vector<std::string> found;
    for (const fs::directory_entry& entry : fs::directory_iterator(lib))
        if (entry.is_directory() && !roomsBelow.contains(entry.path().filename().string()))
            found.push_back(entry.path().filename().string());
    std::sort(found.begin(), found.end());
    return found;
}

std::vector<std::string> violations(const fs::path& lib) {
    std::vector<std::string> found;
    for (const Include& include : includesIn(lib))
        if (roomsBelow.contains(include.room()) && !isAllowed(include))
            found.push_back(
                fmt::format("{} includes {}", include.file.string(), include.included.string()));
    std::sort(found.begin(), found.end());
    return found;
}

/// What the tables above allow although nothing does it.
std::vector<std::string> unused(const fs::path& lib) {
    std::set<std::pair<std::string, std::string>> used;
    for (const Include& include : includesIn(lib)) {
        const std::string other = include.otherRoom();
        used.insert({include.room(), other.empty() ? include.library() : other});
    }
    std::vector<std::string> found;
    for (const auto& [room, below] : roomsBelow)
        for (const std::string& other : below)
            if (!used.contains({room, other})) found.push_back(room + " does not use " + other);
    for (const auto& [library, rooms] : roomsOfLibrary)
        for (const std::string& room : rooms)
            if (!used.contains({room, library})) found.push_back(room + " does not use " + library);
    return found;
}

TEST(Rooms, IncludeOnlyWhatIsBelowThem) {
    const fs::path lib = sourceDir() / "lib/woodcock";
    EXPECT_EQ(unknownRooms(lib), std::vector<std::string>());
    EXPECT_EQ(violations(lib), std::vector<std::string>());
}

TEST(Rooms, MayIncludeOnlyWhatTheyUse) {
    EXPECT_EQ(unused(sourceDir() / "lib/woodcock"), std::vector<std::string>());
}

TEST(Rooms, ViolationsAreFound) {
    const TempDir lib;
    for (const char* room : {"base", "grid", "image", "cellar"}) fs::create_directory(lib / room);
    writeText(lib / "base/a.h", "#include \"woodcock/grid/field.h\"\n#include <vector>\n");
    writeText(lib / "grid/b.h", "#include <openvdb/openvdb.h>\n");
    writeText(lib / "grid/b.cpp",
              "#include <openvdb/openvdb.h>\n#include \"woodcock/base/a.h\"\n"
              "#include \"woodcock/grid/b.h\"\n");
    writeText(lib / "grid/openvdb_d.h", "#include <openvdb/openvdb.h>\n");
    writeText(lib / "grid/e.h", "#include \"woodcock/grid/openvdb_d.h\"\n");
    writeText(lib / "image/c.cpp", "  #  include <OpenImageIO/imageio.h>\n#include <openvdb/io.h>");
    writeText(lib / "cellar/d.cpp", "");
    EXPECT_EQ(unknownRooms(lib.path()), std::vector<std::string>{"cellar"});
    EXPECT_EQ(
        violations(lib.path()),
        (std::vector<std::string>{
            "base/a.h includes woodcock/grid/field.h", "grid/b.h includes openvdb/openvdb.h",
            "grid/e.h includes woodcock/grid/openvdb_d.h", "image/c.cpp includes openvdb/io.h"}));
}

TEST(Rooms, WhatIsAllowedInVainIsFound) {
    const TempDir lib;
    fs::create_directory(lib / "light");
    writeText(lib / "light/a.h", "#include \"woodcock/base/vec.h\"\n");
    const std::vector<std::string> found = unused(lib.path());
    const auto says = [&](const char* text) {
        return std::find(found.begin(), found.end(), text) != found.end();
    };
    EXPECT_TRUE(says("light does not use medium"));
    EXPECT_TRUE(says("image does not use OpenImageIO"));
    EXPECT_FALSE(says("light does not use base"));
}

/// The kinds of light, as light.h lists them.
std::vector<std::string> kindsOfLight(const std::string& header) {
    std::smatch list;
    if (!std::regex_search(header, list, std::regex(R"(public std::variant<([^>]+)>)"))) return {};
    const std::string names = list[1];
    static const std::regex word(R"(\w+)");
    return {std::sregex_token_iterator(names.begin(), names.end(), word),
            std::sregex_token_iterator()};
}

/// Lines of other rooms and of tools that ask which kind a light is.
std::vector<std::string> questionsAboutKinds(const fs::path& folder,
                                             const std::vector<std::string>& kinds) {
    const std::regex question(
        fmt::format(R"(\b(get|get_if|holds_alternative)<(const )?(light::)?({})>)"
                    R"(|\bvisit\b.*(\blights\(\)|light::))",
                    fmt::join(kinds, "|")));
    std::vector<std::string> found;
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder)) {
        const fs::path file = fs::relative(entry.path(), folder);
        if (!entry.is_regular_file() || *file.begin() == "light") continue;
        if (file.extension() != ".h" && file.extension() != ".cpp") continue;
        std::istringstream text(readText(entry.path()));
        for (std::string line; std::getline(text, line);)
            if (std::regex_search(line, question)) found.push_back(file.string() + ": " + line);
    }
    return found;
}

TEST(Rooms, LightAloneKnowsTheKindsOfLight) {
    const auto kinds = kindsOfLight(readText(sourceDir() / "lib/woodcock/light/light.h"));
    EXPECT_GT(kinds.size(), 5u);
    for (const char* folder : {"lib/woodcock", "tools"})
        EXPECT_EQ(questionsAboutKinds(sourceDir() / folder, kinds), std::vector<std::string>());

    const TempDir lib;
    fs::create_directory(lib / "light");
    writeText(lib / "light/a.cpp", "std::get_if<Sun>(&light)\n");
    writeText(lib / "b.cpp", "f();\nif (std::holds_alternative<light::PointLight>(l)) g();\n");
    writeText(lib / "c.h", "std::visit(f, scene.lights()[0]);\nstd::get_if<SunDescription>(&l);\n");
    EXPECT_EQ(questionsAboutKinds(lib.path(), {"Sun", "PointLight"}).size(), 2u);
}

}  // namespace
}  // namespace woodcock::test
