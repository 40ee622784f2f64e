// SPDX-License-Identifier: Apache-2.0
#include "tools/farm/slurm.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tools/common/child_process.h"
#include "tools/common/interrupt.h"
#include "tools/common/json_text.h"
#include "tools/common/render_command.h"
#include "woodcock/base/error.h"
#include "woodcock/base/frame_range.h"
#include "woodcock/base/whole_file.h"

namespace woodcock::tool::farm {

namespace {

namespace fs = std::filesystem;
using Words = std::vector<std::string>;

constexpr int usualLargestArray = 1001;  // MaxArraySize of slurm.conf(5)

fs::path submissionsFile(const Job& job) { return job.folder / "slurm" / "submissions.json"; }

struct Answer {
    int exitCode = 0;
    Words lines;  ///< the last ones
};

/// `onLine` gets each line at once.
Answer ask(const Words& command, const std::function<void(const std::string&)>& onLine = {}) {
    Answer answer;
    const ChildResult result = runChild(
        command,
        [&](const std::string& line) {
            answer.lines.push_back(line);
            if (onLine) onLine(line);
        },
        [] { return interrupted(); });
    if (result.stopped) endIfInterrupted();
    answer.exitCode = result.exitCode;
    return answer;
}

/// The answer of a program that may be missing or refuse: then nothing.
Words askIfThere(const Words& command) {
    try {
        const Answer answer = ask(command);
        return answer.exitCode == 0 ? answer.lines : Words{};
    } catch (const Error&) {
        return {};
    }
}

/// What both scripts begin with.
std::string scriptHead(const Job& job, const std::string& kind, const std::string& output) {
    std::string text = "#!/bin/sh\n";
    const auto option = [&text](const std::string& words) { text += "#SBATCH " + words + "\n"; };
    option(fmt::format("--job-name=\"{}-{}\"", job.folder.stem().string(), kind));
    option(fmt::format("--chdir=\"{}\"", job.folder.string()));
    option("--output=slurm/" + output);
    option("--open-mode=append");
    option("--requeue");
    return text;
}

/// The array's element is a line of the file `elements`, which names its tasks.
std::string renderScript(const Job& job, std::size_t number, std::size_t elements) {
    std::string text = scriptHead(job, "render", fmt::format("render.{}.%a.out", number));
    text += fmt::format("#SBATCH --array=0-{}{}\n", elements - 1,
                        job.atOnce > 0 ? fmt::format("%{}", job.atOnce) : "");
    text += "#SBATCH --signal=B:TERM@60\n";
    for (const std::string& option : job.sbatchOptions) text += "#SBATCH " + option + "\n";
    text += fmt::format(
        R"sh(
tasks=$(sed -n "$((SLURM_ARRAY_TASK_ID + 1))p" slurm/elements.{0})
trap 'kill -TERM "$run" 2>/dev/null' TERM INT
{1} farm run {2} --tasks "$tasks" &
run=$!
wait "$run"
code=$?
while kill -0 "$run" 2>/dev/null; do  # a signal ended the wait
    wait "$run"
    code=$?
done
# It was interrupted, and left a checkpoint. Who cancels it does not want it back. The last element
# has the array's own number as SLURM_JOB_ID, so that is no name for it.
element=${{SLURM_ARRAY_JOB_ID}}_${{SLURM_ARRAY_TASK_ID}}
if [ "$code" -eq 130 ] && [ "${{SLURM_RESTART_COUNT:-0}}" -lt 100 ] && [ ! -e cancelled ] &&
    [ "$(squeue -h -j "$element" -o %T)" = RUNNING ]; then
    scontrol requeue "$element"
fi
exit "$code"
)sh",
        number, shellWord(job.program), shellWord(job.folder.string()));
    return text;
}

std::string finishScript(const Job& job, std::size_t number) {
    std::string text = scriptHead(job, "finish", fmt::format("finish.{}.out", number));
    for (const std::string& option : job.sbatchOptions) text += "#SBATCH " + option + "\n";
    text += fmt::format("\nexec {} farm finish {} --resubmit\n", shellWord(job.program),
                        shellWord(job.folder.string()));
    return text;
}

/// Tasks of each array element, a line each.
Words elementsOf(const Job& job, const std::vector<int>& tasks) {
    const auto most = static_cast<std::size_t>(largestArray());
    const std::size_t each = std::max<std::size_t>(static_cast<std::size_t>(job.tasksPerElement),
                                                   (tasks.size() + most - 1) / most);
    Words lines;
    for (std::size_t i = 0; i < tasks.size(); i += each)
        lines.push_back(frameRangeText(
            {tasks.begin() + static_cast<std::ptrdiff_t>(i),
             tasks.begin() + static_cast<std::ptrdiff_t>(std::min(i + each, tasks.size()))}));
    return lines;
}

std::size_t nextNumber(const Job& job) { return submissionsOf(job).size() + 1; }

void keepSubmission(const Job& job, const Submission& added) {
    std::vector<Submission> all = submissionsOf(job);
    all.push_back(added);
    nlohmann::ordered_json json = nlohmann::ordered_json::array();
    for (const Submission& each : all)
        json.push_back({{"array", each.array},
                        {"finish", each.finish},
                        {"tasks", each.tasks},
                        {"automatic", each.automatic}});
    writeWholeFile(submissionsFile(job), jsonText(json, 4) + "\n");
}

/// The number of the job. Slurm's other words are passed on at once: it may wait for room.
std::string sbatch(Words options, const fs::path& script) {
    options.insert(options.begin(), {"sbatch", "--parsable"});
    options.push_back(script.string());
    std::string id, said;
    const Answer answer = ask(options, [&](const std::string& line) {
        const std::string first = line.substr(0, line.find(';'));  // of NUMBER;CLUSTER
        if (!first.empty() && first.find_first_not_of("0123456789") == first.npos)
            id = first;
        else
            spdlog::warn("{}", said = line);
    });
    if (answer.exitCode != 0 || id.empty())
        throw failure(
            "Slurm does not take the job: {}",
            said.empty() ? fmt::format("sbatch ends with exit code {}", answer.exitCode) : said);
    return id;
}

}  // namespace

std::vector<Submission> submissionsOf(const Job& job) {
    std::ifstream in(submissionsFile(job));
    if (!in) return {};
    std::stringstream text;
    text << in.rdbuf();
    std::vector<Submission> all;
    try {
        for (const auto& json : nlohmann::json::parse(text.str()))
            all.push_back(
                {json.at("array"), json.at("finish"), json.at("tasks"), json.at("automatic")});
    } catch (const nlohmann::json::exception& error) {
        throw inputError("'{}' is damaged: {}", submissionsFile(job).string(), error.what());
    }
    return all;
}

void demandSlurm() {
    try {
        ask({"sbatch", "--version"});
    } catch (const Error&) {
        throw usageError(
            "there is no sbatch on this machine; --dry-run writes the job's folder, for GNU "
            "parallel and other farms");
    }
}

int largestArray() {
    for (const std::string& line : askIfThere({"scontrol", "show", "config"})) {
        if (!line.starts_with("MaxArraySize")) continue;
        const auto digits = line.find_first_of("0123456789");
        if (digits != line.npos) return std::max(1, std::atoi(line.c_str() + digits));
    }
    return usualLargestArray;
}

Scripts writeScripts(const Job& job, const std::vector<int>& tasks) {
    const std::size_t number = nextNumber(job);
    const fs::path folder = job.folder / "slurm";
    const Words elements = elementsOf(job, tasks);
    writeWholeFile(folder / fmt::format("elements.{}", number),
                   fmt::format("{}\n", fmt::join(elements, "\n")));
    const Scripts scripts{folder / fmt::format("render.{}.sbatch", number),
                          folder / fmt::format("finish.{}.sbatch", number)};
    writeWholeFile(scripts.render, renderScript(job, number, elements.size()));
    writeWholeFile(scripts.finish, finishScript(job, number));
    return scripts;
}

Submission submitTasks(const Job& job, const std::vector<int>& tasks, bool automatic) {
    const Scripts scripts = writeScripts(job, tasks);
    Submission submission{.tasks = tasks.size(), .automatic = automatic};
    submission.array = sbatch({}, scripts.render);
    try {
        // afterany: what failed says so itself, and the rest is merged.
        submission.finish = sbatch({"--dependency=afterany:" + submission.array}, scripts.finish);
        keepSubmission(job, submission);
    } catch (...) {
        askIfThere({"scancel", "--quiet", submission.array, submission.finish});
        throw;
    }
    return submission;
}

std::vector<QueueEntry> queueOf(const Job& job) {
    std::vector<QueueEntry> entries;
    for (const Submission& submission : submissionsOf(job)) {
        for (const std::string& id : {submission.array, submission.finish}) {
            for (const std::string& line :
                 askIfThere({"squeue", "-h", "-r", "-j", id, "-o", "%T %r"})) {
                const auto space = line.find(' ');
                const std::string state = line.substr(0, space);
                const std::string reason = space == line.npos ? "" : line.substr(space + 1);
                auto known = std::find_if(entries.begin(), entries.end(), [&](const auto& each) {
                    return each.job == id && each.state == state && each.reason == reason;
                });
                if (known == entries.end()) known = entries.insert(known, {id, state, reason, 0});
                ++known->count;
            }
        }
    }
    return entries;
}

bool wasCancelled(const Submission& submission) {
    return !askIfThere(
                {"squeue", "-h", "-r", "-j", submission.array, "-t", "CANCELLED", "-o", "%T"})
                .empty();
}

void cancelInSlurm(const std::vector<Submission>& submissions) {
    if (submissions.empty()) return;
    Words command{"scancel", "--quiet"};
    for (const Submission& submission : submissions)
        command.insert(command.end(), {submission.finish, submission.array});
    const Answer answer = ask(command);
    if (answer.exitCode != 0)
        throw failure("Slurm does not cancel the job: {}",
                      answer.lines.empty() ? "scancel fails" : answer.lines.back());
}

}  // namespace woodcock::tool::farm
