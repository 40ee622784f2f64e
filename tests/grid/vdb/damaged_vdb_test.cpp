// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <future>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/support/damage_vdb.h"
#include "tests/support/paths.h"
#include "tests/support/run_program.h"
#include "woodcock/grid/vdb/load_field.h"
#include "woodcock/proof/support/write_vdb.h"

namespace woodcock::test {

using namespace grid;
using namespace proof;

namespace {

constexpr std::size_t variants = 2400, batchSize = 40;

/// What the program may take by itself, and for each byte of the file; see lib/README.md.
std::size_t residentLimit(std::size_t fileBytes) { return (192u << 20) + 1000 * fileBytes; }
constexpr std::size_t largestSample = 64u << 10;

#if defined(__SANITIZE_ADDRESS__)
constexpr bool sanitized = true;  // reserves terabytes of addresses for itself
#else
constexpr bool sanitized = false;
#endif
constexpr unsigned secondsPerFile = sanitized ? 100 : 10;

ProgramLimits limits(unsigned seconds) {
    ProgramLimits l{.seconds = seconds};
    if (!sanitized) l.addressSpace = std::size_t(2) << 30;
    return l;
}

struct Variant {
    std::string name;  ///< sample and seed
    std::filesystem::path file;
};

std::vector<Variant> writeVariants(const std::vector<VdbSample>& samples,
                                   const std::filesystem::path& directory, std::size_t begin,
                                   std::size_t end) {
    std::vector<Variant> written;
    for (std::size_t seed = begin; seed < end; ++seed) {
        const VdbSample& sample = samples[seed % samples.size()];
        written.push_back({fmt::format("'{}' damaged by {}", sample.name, seed),
                           directory / fmt::format("{}.vdb", seed)});
        writeText(written.back().file, damagedVdb(sample, seed));
    }
    return written;
}

struct Counts {
    std::size_t files = 0, errors = 0, rendered = 0;
    std::size_t residentBytes = 0;
    void add(const Counts& other) {
        files += other.files;
        errors += other.errors;
        rendered += other.rendered;
        residentBytes = std::max(residentBytes, other.residentBytes);
    }
};

std::vector<std::string> paths(const std::vector<Variant>& files) {
    std::vector<std::string> texts;
    for (const Variant& v : files) texts.push_back(v.file.string());
    return texts;
}

/// The program looks at all files at once; where it fails, at each alone, to say at which.
Counts inspect(const std::vector<Variant>& files) {
    std::vector<std::string> words = paths(files);
    words.insert(words.begin(), {"info", "--json"});
    const ProgramResult run =
        runProgram(words, limits(files.size() == 1 ? secondsPerFile : 10 * secondsPerFile));
    Counts counts{files.size(), 0, 0, run.residentBytes};
    if (run.exitCode != 0 && run.exitCode != 3) {
        if (files.size() == 1) {
            ADD_FAILURE() << files[0].name << ": exit " << run.exitCode << "\n" << run.err;
            return counts;
        }
        for (const Variant& file : files) counts.add(inspect({file}));
        return counts;
    }
    const auto json = nlohmann::json::parse(run.out);
    for (std::size_t i = 0; i < files.size(); ++i) {
        const std::string text = json.at("files").at(i).dump();
        const bool error = text.find("\"error\":") != std::string::npos;
        counts.errors += error;
        EXPECT_TRUE(!error || text.find(files[i].file.string()) != std::string::npos) << text;
    }
    return counts;
}

Counts render(const std::vector<Variant>& files) {
    std::vector<std::string> words = paths(files);
    words.insert(words.begin(), std::to_string(secondsPerFile));
    const ProgramResult run = runProgram(words, limits(0), renderEachProgram());
    Counts counts{0, 0, 0, run.residentBytes};
    std::istringstream lines(run.out);
    for (std::string line; std::getline(lines, line); ++counts.files) {
        if (line == "rendered") {
            ++counts.rendered;
            continue;
        }
        ++counts.errors;
        EXPECT_NE(line.find(files[counts.files].file.string()), std::string::npos) << line;
    }
    if (run.exitCode == 0) return counts;
    ADD_FAILURE() << files[counts.files].name << ": exit " << run.exitCode << "\n" << run.err;
    const auto next = files.begin() + static_cast<std::ptrdiff_t>(++counts.files);
    if (next != files.end()) counts.add(render({next, files.end()}));
    return counts;
}

/// Runs `handle` over batches of variants, two at a time.
template <class Handle>
Counts overBatches(Handle&& handle) {
    const std::vector<VdbSample> samples = healthyVdbs();
    const auto every = [&](std::size_t first) {
        Counts counts;
        for (std::size_t begin = first; begin < variants; begin += 2 * batchSize) {
            const TempDir dir;
            counts.add(handle(
                writeVariants(samples, dir.path(), begin, std::min(begin + batchSize, variants))));
        }
        return counts;
    };
    auto other = std::async(std::launch::async, every, batchSize);
    Counts counts = every(0);
    counts.add(other.get());
    return counts;
}

void report(const char* what, const Counts& counts) {
    fmt::print("{}: {} damaged files, {} errors, {} taken as they are, at most {} MiB\n", what,
               counts.files, counts.errors, counts.files - counts.errors,
               counts.residentBytes >> 20);
    EXPECT_EQ(counts.files, variants);
    EXPECT_LT(counts.errors, counts.files);  // some damage is harmless
    EXPECT_GT(counts.errors, counts.files / 3);
    EXPECT_TRUE(sanitized || counts.residentBytes < residentLimit(largestSample));
}

TEST(DamagedVdb, InfoSaysWhatIsWrong) { report("info", overBatches(inspect)); }

TEST(DamagedVdb, RenderDrawsItOrSaysWhatIsWrong) { report("render", overBatches(render)); }

/// The file that takes the most memory for its size: tiles that differ from their neighbours, and
/// compress to nothing.
TEST(DamagedVdb, MemoryIsBoundedByTheSizeOfTheFile) {
    GridSpec spec{.gridClass = "unknown", .saveAsHalf = true};
    for (int x = 0; x < 512; ++x)
        for (int y = 0; y < 32; ++y)
            for (int z = 0; z < 32; ++z)
                spec.tiles.push_back({{128 * x, 128 * y, 128 * z}, 128, {(x + y + z) % 2 * 1.0}});
    const TempDir dir;
    writeVdb(dir / "tiles.vdb", {spec}, VdbCompression::Zip);
    const std::size_t bytes = std::filesystem::file_size(dir / "tiles.vdb");
    EXPECT_LT(bytes, 200'000u);
    const ProgramResult run = runProgram({"info", dir / "tiles.vdb"}, limits(secondsPerFile));
    EXPECT_EQ(run.exitCode, 0) << run.err;
    EXPECT_TRUE(sanitized || run.residentBytes < residentLimit(bytes)) << run.residentBytes;
}

/// A file at a time, as users do it.
TEST(DamagedVdb, TheProgramItselfRendersOrExitsWithThree) {
    constexpr std::size_t files = 48;
    const std::vector<VdbSample> samples = healthyVdbs();
    const auto renderSome = [&](std::size_t begin) {
        const TempDir dir;
        std::map<int, int> exits;
        for (const Variant& v : writeVariants(samples, dir.path(), begin, begin + files / 2)) {
            const ProgramResult run = runProgram({"render", v.file.string(), "-o", dir / "out.exr",
                                                  "--res", "8x8", "--spp", "1", "--repair"},
                                                 limits(secondsPerFile));
            ++exits[run.exitCode];
            EXPECT_TRUE(run.exitCode == 0 || run.exitCode == 3)
                << v.name << ": exit " << run.exitCode << "\n"
                << run.err;
            EXPECT_TRUE(run.exitCode == 0 || run.err.find(v.file.string()) != std::string::npos)
                << run.err;
        }
        return exits;
    };
    auto other = std::async(std::launch::async, renderSome, variants + files / 2);
    std::map<int, int> exits = renderSome(variants);
    for (const auto& [code, count] : other.get()) exits[code] += count;
    EXPECT_GT(exits[0], 0);
    EXPECT_GT(exits[3], 0);
}

TEST(DamagedVdb, UndamagedFilesAreFine) {
    const TempDir dir;
    std::vector<std::string> words{"info"};
    for (const VdbSample& sample : healthyVdbs()) {
        words.push_back(dir / (sample.name + ".vdb"));
        writeText(words.back(), sample.bytes);
    }
    const ProgramResult run = runProgram(words);
    EXPECT_EQ(run.exitCode, 0) << run.err;
}

TEST(DamagedVdb, GridsThatShareATreeAreBothRead) {
    const TempDir dir;
    const std::vector<VdbSample> samples = healthyVdbs();
    const auto shared = std::find_if(samples.begin(), samples.end(),
                                     [](const VdbSample& s) { return s.name == "shared tree"; });
    ASSERT_NE(shared, samples.end());
    writeText(dir / "a.vdb", shared->bytes);
    const Field first = loadGrid(dir / "a.vdb", "density").field;
    const Field second = loadGrid(dir / "a.vdb", "again").field;
    for (int i = 0; i < 20; ++i) {
        EXPECT_EQ(first.voxel({i, 2 * i, i}), static_cast<float>(1 + i));
        EXPECT_EQ(second.voxel({i, 2 * i, i}), static_cast<float>(1 + i));
    }
}

/// What lies where a VDB file should.
TEST(OddFiles, AreRefusedByNameAtOnce) {
    const TempDir dir;
    std::filesystem::create_directory(dir / "directory.vdb");
    ASSERT_EQ(mkfifo((dir / "pipe.vdb").c_str(), 0600), 0);
    writeText(dir / "empty.vdb", "");
    writeText(dir / "text.vdb", "These are words.\n");
    writeText(dir / "secret.vdb", healthyVdbs().front().bytes);
    std::filesystem::permissions(dir / "secret.vdb", std::filesystem::perms::none);
    std::vector<std::string> files{dir / "directory.vdb", dir / "pipe.vdb", dir / "empty.vdb",
                                   dir / "text.vdb",      "/dev/null",      "/dev/zero"};
    if (geteuid() != 0) files.push_back(dir / "secret.vdb");  // root may read anything
    for (const std::string& file : files) {
        for (const std::vector<std::string>& words :
             {std::vector<std::string>{"info", file},
              {"render", file, "-o", dir / "out.exr", "--res", "8x8", "--spp", "1"}}) {
            const ProgramResult run = runProgram(words, limits(secondsPerFile));
            EXPECT_EQ(run.exitCode, 3) << file << "\n" << run.err;
            EXPECT_NE(run.err.find(file), std::string::npos) << run.err;
        }
    }
}

}  // namespace
}  // namespace woodcock::test
