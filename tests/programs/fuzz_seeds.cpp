// SPDX-License-Identifier: Apache-2.0
// Writes what the fuzz targets of tests/fuzz begin with: DIRECTORY/scene, display and vdb.
// usage: fuzz_seeds DIRECTORY
#include <cstdio>
#include <exception>

#include "tests/support/damage_vdb.h"
#include "tests/support/paths.h"

namespace {

namespace fs = std::filesystem;
using namespace woodcock;
using namespace woodcock::test;

void writeScenes(const fs::path& directory) {
    fs::create_directories(directory);
    const std::string overrides = std::string(1, '\0') +
                                  "volume[0].scale=2\nrender.spp=16\ncamera.eye=[1, 2, 3]\n"
                                  "light[0].type=\"point\"\noutput.files=[\"a.exr\"]\n";
    for (const fs::directory_entry& entry : fs::directory_iterator(sourceDir() / "data/scenes")) {
        if (entry.path().extension() != ".toml") continue;
        const std::string text = readText(entry.path());
        writeText(directory / entry.path().stem(), text);
        writeText(directory / entry.path().stem().concat("_overridden"), text + overrides);
    }
}

void writeConfigs(const fs::path& directory) {
    fs::create_directories(directory);
    const std::string config = readText(sourceDir() / "data/ocio/woodcock.ocio");
    writeText(directory / "default", "\n\n\n0\n" + config);
    writeText(directory / "named", "sRGB\nStandard\n\n1.5\n" + config);
    writeText(directory / "shipped", "sRGB\nACES\nnone\n-2\n");
}

void writeVdbs(const fs::path& directory) {
    fs::create_directories(directory);
    for (const VdbSample& sample : healthyVdbs()) writeText(directory / sample.name, sample.bytes);
}

}  // namespace

int main(int count, char** words) {
    if (count != 2) return 2;
    try {
        const fs::path directory = words[1];
        writeScenes(directory / "scene");
        writeConfigs(directory / "display");
        writeVdbs(directory / "vdb");
        return 0;
    } catch (const std::exception& e) {
        std::fprintf(stderr, "%s\n", e.what());
        return 1;
    }
}
