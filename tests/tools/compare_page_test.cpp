// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <limits>

#include "tests/support/environment_variable.h"
#include "tests/support/paths.h"
#include "tests/support/run_program.h"
#include "tests/support/write_image.h"

namespace woodcock::test {

namespace {

double reference(int x, int y, std::size_t channel) {
    return channel == 0 ? 0.05 + 0.01 * x : channel == 1 ? 0.01 * (y + 1) : 0.3;
}

// In a real browser; what is done there, and what is expected, stands in the script.
TEST(ComparePage, WorksInABrowser) {
    const EnvironmentVariable none("OCIO", {});
    const TempDir dir;
    ImageFile a, b, c;
    a.width = b.width = c.width = 64;
    a.height = b.height = c.height = 48;
    a.value = reference;
    b.value = [](int x, int y, std::size_t channel) {
        if (x == 5 && y == 5 && channel == 0) return std::numeric_limits<double>::quiet_NaN();
        return reference(x, y, channel) + (x < 32 ? 0.04 : -0.04);
    };
    c.value = [](int x, int y, std::size_t channel) { return 1.01 * reference(x, y, channel); };
    b.attributes = {{"woodcock/samples", 16}, {"woodcock/renderSeconds", 2.0f}};
    c.attributes = {{"woodcock/samples", 64}, {"woodcock/renderSeconds", 8.0f}};
    std::filesystem::create_directory(dir / "a <");
    const ProgramResult made =
        runProgram({"compare", writeImage(dir / "a </script>.exr", a).string(),
                    writeImage(dir / "b.exr", b).string(), writeImage(dir / "c.exr", c).string(),
                    "--report", (dir / "report").string()});
    ASSERT_EQ(made.exitCode, 0) << made.err;
    const ProgramResult used =
        runProgram({"python3", (sourceDir() / "tests/programs/compare_page.py").string(),
                    (dir / "report/compare.html").string(), dir.path().string()},
                   {}, "/usr/bin/env");
    if (used.exitCode == 77) GTEST_SKIP() << used.out;
    if (used.exitCode == 127) GTEST_SKIP() << "no python3 here";
    EXPECT_EQ(used.exitCode, 0) << used.out << used.err;
}

}  // namespace
}  // namespace woodcock::test
