// SPDX-License-Identifier: Apache-2.0
// `woodcock farm` with programs that stand for Slurm's. tests/farm/slurm.sh has the real ones.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include <csignal>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "tests/support/paths.h"
#include "tests/support/run_program.h"
#include "tests/tools/fog_scene.h"
#include "woodcock/base/whole_file.h"
#include "woodcock/proof/support/read_back.h"
#include "woodcock/proof/support/write_vdb.h"

namespace woodcock::test {

using namespace proof;

namespace {

namespace fs = std::filesystem;
using Words = std::vector<std::string>;

/// Runs in a directory of its own that holds fog.toml. `bin` in it is the head of PATH: sbatch
/// notes what it is called with and answers 101, 102, ..; a file `refused` names the call from
/// which on it refuses. The others tell what the files `queue` and `config` hold.
class Farm : public testing::Test {
protected:
    void SetUp() override {
        writeText(dir / "fog.toml", fogScene() + "max_scatterings = 4\n");
        fs::create_directory(dir / "bin");
        const std::string folder = dir.path().string();
        writeScript("bin/sbatch",
                    "[ \"$1\" = --version ] && exit\n"
                    "cd '" +
                        folder +
                        "'\n"
                        "calls=$(($(cat calls 2>/dev/null || echo 0) + 1))\n"
                        "echo $calls >calls\n"
                        "echo \"$@\" >>sbatch.log\n"
                        "if [ -e refused ] && [ $calls -ge $(cat refused) ]; then\n"
                        "    echo 'sbatch: error: the queue is full' >&2\n"
                        "    exit 1\n"
                        "fi\n"
                        "echo $((100 + calls))\n");
        writeScript("bin/squeue", "cat '" + folder + "/queue' 2>/dev/null");
        writeScript("bin/scontrol", "echo \"$@\" >>'" + folder + "/scontrol.log'\ncat '" + folder +
                                        "/config' 2>/dev/null");
        writeScript("bin/scancel", "echo \"$@\" >>'" + folder + "/scancel.log'");
        path_ = std::getenv("PATH");
        setenv("PATH", (file("bin") + ":" + path_).c_str(), 1);
    }
    void TearDown() override { setenv("PATH", path_.c_str(), 1); }

    std::string file(const std::string& name) const { return (dir / name).string(); }
    void writeScript(const std::string& name, const std::string& text) const {
        writeText(dir / name, "#!/bin/sh\n" + text);
        fs::permissions(dir / name, fs::perms::owner_all);
    }

    ProgramResult farm(Words words) const {
        words.insert(words.begin(), "farm");
        return runProgram(words);
    }
    /// Of fog.toml, small, into x.####.exr.
    Words submission(const Words& more) const {
        Words words{"submit", file("fog.toml"), "--job", file("j"), "-o", file("x.####.exr")};
        words.insert(words.end(), small.begin(), small.end());
        words.insert(words.end(), more.begin(), more.end());
        return words;
    }
    void submit(const Words& more) const {
        const ProgramResult result = farm(submission(more));
        ASSERT_EQ(result.exitCode, 0) << result.err;
    }
    ProgramResult run(const std::string& tasks) const {
        return farm({"run", file("j"), "--tasks", tasks});
    }
    nlohmann::json status() const {
        return nlohmann::json::parse(farm({"status", file("j"), "--json"}).out);
    }
    std::vector<float> pixels(const std::string& name) const { return readBack(dir / name).values; }
    /// What one machine draws.
    std::vector<float> single(const Words& more) const {
        Words words{"render", file("fog.toml"), "-o", file("single.exr"), "--quiet"};
        words.insert(words.end(), small.begin(), small.end());
        words.insert(words.end(), more.begin(), more.end());
        EXPECT_EQ(runProgram(words).exitCode, 0);
        return pixels("single.exr");
    }

    static void expectSaid(const ProgramResult& result, int exitCode, const Words& said) {
        EXPECT_EQ(result.exitCode, exitCode) << result.err;
        for (const std::string& words : said)
            EXPECT_NE((result.err + result.out).find(words), std::string::npos)
                << "says:     " << result.err << result.out << "expected: " << words;
    }

    const TempDir dir;
    const Words small{"--set", "render.resolution=[12, 8]", "--set", "render.spp=4", "--threads",
                      "2"};

private:
    std::string path_;
};

TEST_F(Farm, SubmitsAnArrayAndAJobThatMergesAfterIt) {
    const ProgramResult result = farm(submission(
        {"--frames", "1-2", "--parts", "2", "--partition", "night", "--cpus", "8", "--time",
         "1:00:00", "--memory", "4G", "--at-once", "3", "--sbatch=--qos=low", "--json"}));
    ASSERT_EQ(result.exitCode, 0) << result.err;
    const auto json = nlohmann::json::parse(result.out);
    EXPECT_EQ(json.at("tasks"), 4);
    EXPECT_EQ(json.at("array"), "101");
    EXPECT_EQ(json.at("finish"), "102");
    EXPECT_EQ(readText(dir / "sbatch.log"),
              fmt::format("--parsable {0}/slurm/render.1.sbatch\n"
                          "--parsable --dependency=afterany:101 {0}/slurm/finish.1.sbatch\n",
                          file("j")));
    const std::string script = readText(dir / "j/slurm/render.1.sbatch");
    for (const char* line :
         {"--array=0-3%3", "--requeue", "--open-mode=append", "--signal=B:TERM@60",
          "--partition=night", "--cpus-per-task=8", "--time=1:00:00", "--mem=4G", "--qos=low"})
        EXPECT_NE(script.find(fmt::format("\n#SBATCH {}\n", line)), script.npos) << line;

    // Each element of the array, as Slurm runs it, and one of them again.
    for (const int element : {0, 1, 2, 3, 0}) {
        const ProgramResult ran =
            runProgram({"-C", file("j"), fmt::format("SLURM_ARRAY_TASK_ID={}", element),
                        "SLURM_JOB_ID=7", "/bin/sh", file("j/slurm/render.1.sbatch")},
                       {}, "/usr/bin/env");
        EXPECT_EQ(ran.exitCode, 0) << ran.err;
    }
    for (int frame = 1; frame <= 2; ++frame) {
        EXPECT_EQ(pixels(fmt::format("x.000{}.exr", frame)), single({}));
        const std::string log = readText(dir / fmt::format("j/logs/000{}.log", frame));
        EXPECT_EQ(log.find("attempt"), log.rfind("attempt")) << log;
    }
    EXPECT_TRUE(fs::is_empty(dir / "j/parts"));
    EXPECT_TRUE(status().at("all_done"));
    expectSaid(farm({"finish", file("j"), "--resubmit"}), 0, {"4 done", "2 frames merged"});
    expectSaid(farm({"resubmit", file("j")}), 0, {"nothing to submit"});
}

TEST_F(Farm, PacksTasksWhereAnArrayHoldsFewElements) {
    writeText(dir / "config", "MaxArraySize            = 3\n");
    submit({"--frames", "1-4", "--parts", "2"});
    EXPECT_EQ(readText(dir / "j/slurm/elements.1"), "1-3\n4-6\n7-8\n");
    EXPECT_NE(readText(dir / "j/slurm/render.1.sbatch").find("--array=0-2\n"), std::string::npos);
}

TEST_F(Farm, TheJobFileRunsWithoutSlurm) {
    submit({"--frames", "1,3", "--parts", "2", "--dry-run"});
    EXPECT_FALSE(fs::exists(dir / "sbatch.log"));
    const ProgramResult ran = runProgram(
        {"-c", fmt::format("xargs -P 2 -I LINE sh -c LINE <'{}'", file("j/tasks"))}, {}, "/bin/sh");
    EXPECT_EQ(ran.exitCode, 0) << ran.err;
    EXPECT_EQ(pixels("x.0001.exr"), single({}));
    EXPECT_EQ(pixels("x.0003.exr"), pixels("x.0001.exr"));
    EXPECT_TRUE(status().at("all_done"));
}

TEST_F(Farm, OnePictureMayBeSharedOut) {
    const ProgramResult result =
        farm({"submit", file("fog.toml"), "--job", file("j"), "--res", "12x8", "--spp", "4",
              "--parts", "3", "--crop", "2,2,9,7", "-o", file("y.png"), "-o", file("y.exr")});
    ASSERT_EQ(result.exitCode, 0) << result.err;
    EXPECT_EQ(run("1-3").exitCode, 0);
    EXPECT_EQ(pixels("y.exr"), single({"--crop", "2,2,9,7"}));
    EXPECT_TRUE(fs::exists(dir / "y.png"));
}

TEST_F(Farm, ABadFrameDoesNotStopGoodOnes) {
    GridSpec grid;
    grid.name = "density";
    grid.box = {{0, 0, 0}, {7, 7, 7}};
    grid.value = [](Vec3i) { return 1.; };
    writeVdb(dir / "s.0001.vdb", {grid});
    writeText(dir / "s.0002.vdb", "no VDB");
    writeText(dir / "fog.toml",
              "[[volume]]\nfile = \"s.####.vdb\"\ndensity = \"density\"\nscale = 0.1\n"
              "[[light]]\ntype = \"environment\"\nradiance = 1\n"
              "[camera]\neye = [4, 4, 30]\nlook_at = [4, 4, 4]\n");
    submit({"--frames", "1-2"});
    expectSaid(run("1-2"), 3, {"frame 1, merging: done", "s.0002.vdb"});
    EXPECT_TRUE(fs::exists(dir / "x.0001.exr"));
    const auto failed = status();
    EXPECT_EQ(failed.at("frames_merged"), 1);
    EXPECT_EQ(failed.at("parts").at("failed"), 1);
    const auto& trouble = failed.at("troubles")[0];
    EXPECT_EQ(trouble.at("what"), "frame 2");
    EXPECT_EQ(trouble.at("attempts"), 1);
    EXPECT_EQ(trouble.at("exit_code"), 3);
    EXPECT_NE(trouble.at("error").get<std::string>().find("s.0002.vdb"), std::string::npos);
    // It is not submitted again by itself.
    expectSaid(farm({"finish", file("j"), "--resubmit"}), 1, {"failed  frame 2: "});
    EXPECT_EQ(readText(dir / "calls"), "2\n");

    writeVdb(dir / "s.0002.vdb", {grid});
    expectSaid(farm({"resubmit", file("j")}), 0, {"submitted 1 task: "});
    EXPECT_EQ(readText(dir / "j/slurm/elements.2"), "2\n");
    EXPECT_EQ(run("2").exitCode, 0);
    EXPECT_TRUE(status().at("all_done"));
}

TEST_F(Farm, WhatIsKilledIsRepeated) {
    writeScript("killed", "[ -e '" + file("once") + "' ] || { touch '" + file("once") +
                              "'; kill -9 $$; }\nexec '" + program().string() + "' \"$@\"\n");
    submit({"--frames", "1", "--program", file("killed")});
    expectSaid(run("1"), 0, {"attempt 1 of 4: ended by signal 9", "frame 1, merging: done"});
    EXPECT_EQ(pixels("x.0001.exr"), single({}));

    fs::remove_all(dir / "j");
    writeScript("killed", "kill -9 $$");
    submit({"--frames", "1", "--program", file("killed"), "--retries", "1"});
    expectSaid(run("1"), 137, {"attempt 2 of 2", "gives up after 2 attempts"});
    EXPECT_EQ(status().at("troubles")[0].at("exit_code"), 137);
}

TEST_F(Farm, WhatIsRemovedIsDrawnAgain) {
    submit({"--frames", "1", "--parts", "2", "--dry-run"});
    EXPECT_EQ(run("1").exitCode, 0);
    fs::remove(dir / "j/parts/0001.0.exr");
    EXPECT_EQ(status().at("parts").at("waiting"), 2);
    EXPECT_EQ(run("1-2").exitCode, 0);
    EXPECT_TRUE(status().at("all_done"));
}

TEST_F(Farm, ACommandThatLeavesNothingHasFailed) {
    writeScript("nothing", "exit 0");
    submit({"--frames", "1", "--program", file("nothing"), "--retries", "0"});
    expectSaid(run("1"), 1, {"nothing is done", "gives up after 1 attempt: "});
}

TEST_F(Farm, WhatIsLostIsSubmittedAgain) {
    writeScript("killed", "kill -9 $PPID");  // with whoever would repeat it
    submit({"--frames", "1-2", "--program", file("killed"), "--retries", "2"});
    for (int attempt = 1; attempt <= 2; ++attempt) {
        EXPECT_EQ(run("2").exitCode, 137);
        EXPECT_EQ(status().at("parts").at("lost"), 1);
        EXPECT_EQ(status().at("troubles")[0].at("attempts"), attempt);
        expectSaid(farm({"finish", file("j"), "--resubmit"}), 1, {"submitted 2 tasks"});
    }
    expectSaid(farm({"finish", file("j"), "--resubmit"}), 1, {"gives up", "2 times"});
    EXPECT_EQ(run("2").exitCode, 137);
    EXPECT_EQ(status().at("parts").at("failed"), 1);
    expectSaid(run("2"), 1, {"killed each time"});
    // Whom somebody cancelled in Slurm stays cancelled.
    fs::remove_all(dir / "j");
    submit({"--frames", "1"});
    writeText(dir / "queue", "CANCELLED\n");
    expectSaid(farm({"finish", file("j"), "--resubmit"}), 1, {"was cancelled"});
}

TEST_F(Farm, NothingIsDoneTwiceBesideAnother) {
    writeScript("waits", "while [ ! -e '" + file("go") + "' ]; do sleep 0.02; done\nexec '" +
                             program().string() + "' \"$@\"\n");
    submit({"--frames", "1", "--program", file("waits")});
    RunningProgram first({"farm", "run", file("j"), "--tasks", "1", "--log-level", "debug"});
    while (status().at("parts").at("running") == 0) {
    }
    first.signal(SIGKILL);  // its render lives on
    EXPECT_EQ(first.wait().exitCode, 137);
    EXPECT_EQ(status().at("parts").at("running"), 1);
    RunningProgram second({"farm", "run", file("j"), "--tasks", "1"});
    EXPECT_NE(second.awaitLine("another process is at it"), "");
    writeText(dir / "go", "");
    EXPECT_EQ(second.wait().exitCode, 0);
    const std::string log = readText(dir / "j/logs/0001.0.log");
    EXPECT_EQ(log.find("attempt"), log.rfind("attempt")) << log;
    EXPECT_EQ(pixels("x.0001.exr"), single({}));
}

TEST_F(Farm, AnInterruptedTaskGoesOn) {
    submit({"--frames", "1", "--spp", "4000", "--res", "24x24", "--checkpoint", "0.05s"});
    RunningProgram running({"farm", "run", file("j"), "--tasks", "1"});
    EXPECT_NE(running.awaitLine("0001.0.checkpoint.exr: "), "");
    running.signal(SIGTERM);
    running.signal(SIGTERM);  // as farms do
    EXPECT_EQ(running.wait().exitCode, 130);
    EXPECT_EQ(status().at("parts").at("interrupted"), 1);
    expectSaid(run("1"), 0, {"goes on from"});
    EXPECT_EQ(pixels("x.0001.exr"), single({"--spp", "4000", "--res", "24x24"}));
}

TEST_F(Farm, AnInterruptedElementGoesBackIntoTheQueueUnlessItIsCancelled) {
    writeScript("interrupted", "exit 130");
    submit({"--frames", "1", "--program", file("interrupted")});
    const auto requeues = [&](const std::string& state) {
        writeText(dir / "queue", state + "\n");
        writeText(dir / "scontrol.log", "");
        const ProgramResult ran =
            runProgram({"-C", file("j"), "SLURM_ARRAY_JOB_ID=7", "SLURM_ARRAY_TASK_ID=0",
                        "SLURM_JOB_ID=7", "/bin/sh", file("j/slurm/render.1.sbatch")},
                       {}, "/usr/bin/env");
        EXPECT_EQ(ran.exitCode, 130) << ran.err;
        return readText(dir / "scontrol.log") == "requeue 7_0\n";
    };
    EXPECT_TRUE(requeues("RUNNING"));
    EXPECT_FALSE(requeues("COMPLETING"));  // Slurm ends it
    writeText(dir / "j/cancelled", "");
    EXPECT_FALSE(requeues("RUNNING"));
}

TEST_F(Farm, ACancelledJobEndsAndMayGoOn) {
    submit({"--frames", "1", "--spp", "1000000"});
    RunningProgram running({"farm", "run", file("j"), "--tasks", "1"});
    EXPECT_NE(running.awaitLine("begins anew"), "");
    expectSaid(farm({"resubmit", file("j")}), 2, {"is still being worked on"});
    expectSaid(farm({"cancel", file("j")}), 0, {"cancelled"});
    EXPECT_EQ(running.wait().exitCode, 130);
    EXPECT_EQ(readText(dir / "scancel.log"), "--quiet 102 101\n");
    EXPECT_TRUE(status().at("cancelled"));
    EXPECT_EQ(run("1").exitCode, 130);
    expectSaid(farm({"finish", file("j"), "--resubmit"}), 1, {"1 interrupted"});
    EXPECT_EQ(readText(dir / "calls"), "2\n");
    expectSaid(farm({"resubmit", file("j")}), 0, {"submitted 1 task: "});
    EXPECT_FALSE(status().at("cancelled"));
}

TEST_F(Farm, AFullQueueKeepsTheJob) {
    writeText(dir / "refused", "1");
    expectSaid(farm(submission({"--frames", "1-2"})), 1,
               {"the queue is full", "woodcock farm resubmit"});
    EXPECT_EQ(status().at("parts").at("waiting"), 2);
    writeText(dir / "refused", "3");  // the array is taken, and what merges is not
    EXPECT_EQ(farm({"resubmit", file("j")}).exitCode, 1);
    EXPECT_EQ(readText(dir / "scancel.log").substr(0, 11), "--quiet 102");
    fs::remove(dir / "refused");
    expectSaid(farm({"resubmit", file("j")}), 0, {"submitted 2 tasks: array 104"});
}

TEST_F(Farm, StatusTellsOfTheQueue) {
    submit({"--frames", "1"});
    writeText(dir / "queue", "PENDING Resources\nPENDING Resources\nRUNNING None\n");
    expectSaid(farm({"status", file("j")}), 0,
               {"1 waiting", "Slurm 101: 2 PENDING (Resources)", "Slurm 101: 1 RUNNING\n"});
    expectSaid(farm({"resubmit", file("j")}), 2, {"is still being worked on"});
}

TEST_F(Farm, AdaptivePartsHaveSeedsOfTheirOwn) {
    submit(
        {"--frames", "1", "--parts", "2", "--adaptive", "--seed", "5", "--spp", "33", "--dry-run"});
    EXPECT_EQ(farm({"run", file("j"), "--frames", "1"}).exitCode, 0);
    const std::string last = readText(dir / "j/logs/0001.1.log");
    EXPECT_NE(last.find("--spp 17 --seed 6 --mergeable"), std::string::npos) << last;
    EXPECT_EQ(pixels("x.0001.exr").size(), 12U * 8 * 4);
}

TEST_F(Farm, MattesAndDeepPixelsAreMerged) {
    submit({"--frames", "1", "--parts", "2", "--mattes", "object", "--mattes-file",
            file("m.####.exr"), "--deep", file("d.####.exr")});
    EXPECT_EQ(run("1").exitCode, 0);
    EXPECT_FALSE(fs::exists(dir / "m.0001.exr") || fs::exists(dir / "d.0001.exr"));
    EXPECT_EQ(run("2").exitCode, 0);
    EXPECT_TRUE(fs::exists(dir / "d.0001.exr"));
    EXPECT_TRUE(fs::is_empty(dir / "j/parts"));
    single({"--mattes", "object", "--mattes-file", file("m.exr")});
    EXPECT_EQ(pixels("m.0001.exr"), pixels("m.exr"));
}

TEST_F(Farm, FramesMayHaveSceneFilesOfTheirOwn) {
    for (int n = 1; n <= 2; ++n) fs::copy(dir / "fog.toml", dir / fmt::format("f.000{}.toml", n));
    Words words = submission({"--frames", "1-2", "--dry-run"});
    words[1] = file("f.####.toml");
    EXPECT_EQ(farm(words).exitCode, 0);
    EXPECT_TRUE(fs::exists(dir / "j/scene.0002.toml"));
    EXPECT_EQ(run("2").exitCode, 0);
    EXPECT_EQ(pixels("x.0002.exr"), single({}));
}

TEST_F(Farm, WrongSubmissionsLeaveNothing) {
    const auto wrong = [&](const Words& more, int code, const Words& said) {
        expectSaid(farm(submission(more)), code, said);
        EXPECT_FALSE(fs::exists(dir / "j")) << fmt::format("{}", fmt::join(more, " "));
        EXPECT_FALSE(fs::exists(dir / "sbatch.log"));
    };
    wrong({}, 2, {"stands for a frame's number, and no frames are asked for"});
    wrong({"--frames", "1-2", "-o", file("y.exr")}, 2, {"2 frames and one file"});
    wrong({"--frames", "1", "--parts", "5"}, 2, {"5 parts cannot share out 4 samples"});
    wrong({"--frames", "1", "--parts", "0"}, 2, {"--parts"});
    wrong({"--frames", "1", "--parts", "2", "--noise", "1%"}, 2, {"a limit of noise"});
    wrong({"--frames", "1", "--parts", "2", "--time-limit", "9s"}, 2, {"a limit of time_limit"});
    wrong({"--frames", "1", "--quality", "auto", "--noise", "1%"}, 2, {"name a quality"});
    wrong({"--frames", "1", "--deep", file("deep.exr")}, 2, {"deep.exr", "one file"});
    wrong({"--frames", "1", "--denoise"}, 2, {"give --layers albedo,normal"});
    wrong({"--frames", "1", "--samples", "0:2"}, 2, {"unknown option --samples"});
    wrong({"--frames", "1", "--set", "volume[0].scale=x"}, 3, {"scale"});
    wrong({"--frames", "1", "--crop", "0,0,13,8"}, 2, {"reaches beyond"});
    wrong({"--frames", "1", "--sbatch", "qos=x"}, 2, {"is no option"});
    wrong({"--frames", "1", "--set", "light[0].image=none.exr"}, 3, {"none.exr"});
    wrong({"--frames", "1", "-o", file("no/y.####.exr")}, 2, {"--mkdir"});
    writeText(dir / "fog.toml", fogScene() + "[[volume]]\nfile = \"s.####.vdb\"\n");
    wrong({"--frames", "1"}, 3, {"s.####.vdb"});

    fs::create_directory(dir / "j");
    expectSaid(farm(submission({"--frames", "1"})), 2, {"is not written over"});
    EXPECT_TRUE(fs::is_empty(dir / "j"));
    expectSaid(farm({"status", file("j")}), 2, {"is no job's folder"});
    writeText(dir / "j/job.json", "{");
    expectSaid(farm({"status", file("j")}), 3, {"damaged"});
    expectSaid(farm({}), 2, {"no command is given; there are: submit"});
    expectSaid(farm({"stauts"}), 2, {"did you mean 'status'?"});
    setenv("PATH", "/nowhere", 1);
    fs::remove_all(dir / "j");
    expectSaid(farm(submission({"--frames", "1"})), 2, {"there is no sbatch", "--dry-run"});
}

TEST_F(Farm, WrongTasksAreNamed) {
    submit({"--frames", "3-4", "--dry-run"});
    expectSaid(run("3"), 2, {"there is no task 3; the job has 1 to 2"});
    expectSaid(farm({"run", file("j")}), 2, {"give --tasks or --frames"});
    expectSaid(farm({"run", file("j"), "--frames", "5"}), 2, {"no frame 5; it has 3-4"});
}

}  // namespace
}  // namespace woodcock::test
