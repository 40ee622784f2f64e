// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
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

/// What each room of lib/woodcock may include besides itself; trade/ knows them all.
const std::map<std::string, std::set<std::string>> roomsBelow{
    {"base", {}},
    {"grid", {"base"}},
    {"medium", {"grid", "base"}},
    {"light", {"medium", "base"}},
    {"mesh", {"grid", "base"}},
    {"surface", {"mesh", "light", "medium", "base"}},
    {"camera", {"medium", "base"}},
    {"image", {"base"}},
    {"render", {"medium", "light", "surface", "mesh", "camera", "image", "grid", "base"}},
    {"convert", {"mesh", "image", "grid", "base"}},
    {"bake", {"convert", "mesh", "image", "grid", "base"}},
    {"compare", {"image", "base"}},
    {"scene",
     {"compare", "bake", "convert", "render", "image", "light", "surface", "camera", "medium",
      "mesh", "grid", "base"}},
    {"proof",
     {"scene", "compare", "bake", "convert", "render", "image", "light", "surface", "camera",
      "medium", "mesh", "grid", "base"}},
    {"trade",
     {"scene", "compare", "bake", "convert", "render", "image", "light", "surface", "camera",
      "medium", "mesh", "grid", "base"}}};

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
    {"OpenColorIO", {"image"}}};
bool bearsName(const fs::path& header) {
    const std::string name = header.filename().string();
    return name.starts_with("openvdb_") || name.starts_with("openimageio_") ||
           name.starts_with("opencolorio_");
}

std::vector<std::string> violations(const fs::path& lib) {
    static const std::regex include(R"(^\s*#\s*include\s*[<"]([^>"]+)[>"])");
    std::vector<std::string> found;
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(lib)) {
        if (!entry.is_regular_file()) continue;
        const fs::path file = fs::relative(entry.path(), lib);
        const std::string room = file.begin()->string();
        if (!roomsBelow.contains(room)) {
            found.push_back(fmt::format("{}: no such room", file.string()));
            continue;
        }
        std::istringstream text(readText(entry.path()));
        std::smatch match;
        for (std::string line; std::getline(text, line);) {
            if (!std::regex_search(line, match, include)) continue;
            const fs::path included = match[1].str();
            const std::string top = included.begin()->string();
            bool allowed = true;
            if (top == "woodcock") {
                const std::string other = std::next(included.begin())->string();
                allowed = (other == room || roomsBelow.at(room).contains(other)) &&
                          (!bearsName(included) || bearsName(file) || file.extension() == ".cpp");
            } else if (const auto library = roomsOfLibrary.find(top);
                       library != roomsOfLibrary.end()) {
                allowed = (file.extension() == ".cpp" || bearsName(file)) &&
                          library->second.contains(room);
            }
            if (!allowed)
                found.push_back(fmt::format("{} includes {}", file.string(), included.string()));
        }
    }
    std::sort(found.begin(), found.end());
    return found;
}

TEST(Rooms, IncludeOnlyWhatIsBelowThem) {
    const std::vector<std::string> found = violations(sourceDir() / "lib/woodcock");
    EXPECT_TRUE(found.empty()) << fmt::format("{}", fmt::join(found, "\n"));
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
    EXPECT_EQ(
        violations(lib.path()),
        (std::vector<std::string>{
            "base/a.h includes woodcock/grid/field.h", "cellar/d.cpp: no such room",
            "grid/b.h includes openvdb/openvdb.h", "grid/e.h includes woodcock/grid/openvdb_d.h",
            "image/c.cpp includes openvdb/io.h"}));
}

}  // namespace
}  // namespace woodcock::test
