// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cstdlib>
#include <memory>
#include <nlohmann/json.hpp>
#include <numeric>

#include "tools/common/command.h"
#include "tools/common/frames.h"
#include "tools/common/interrupt.h"
#include "tools/common/json_text.h"
#include "tools/common/option_kinds.h"
#include "tools/common/print.h"
#include "tools/common/report_options.h"
#include "tools/farm/run.h"
#include "tools/farm/slurm.h"
#include "tools/farm/status.h"
#include "tools/farm/submit.h"
#include "woodcock/base/error.h"
#include "woodcock/base/frame_range.h"
#include "woodcock/base/whole_file.h"

namespace woodcock::tool {

namespace {

using namespace farm;
namespace fs = std::filesystem;

/// What all but `submit` take.
struct JobOptions {
    fs::path folder;
    std::vector<int> tasks, frames;
    bool resubmit = false;
    ReportOptions reports;
};

void tellSubmission(const Job& job, const Submission& submission) {
    spdlog::info("submitted {} task{}: array {}, and job {} after it that merges", submission.tasks,
                 submission.tasks == 1 ? "" : "s", submission.array, submission.finish);
    spdlog::info("woodcock farm status {} shows how it goes", job.folder.string());
}

void printSubmission(const Job& job, const Submission& submission) {
    const auto idOrNull = [](const std::string& id) {
        return id.empty() ? nlohmann::ordered_json() : nlohmann::ordered_json(id);
    };
    printJson(nlohmann::ordered_json{{"folder", job.folder.string()},
                                     {"frames", job.frames.size()},
                                     {"parts_per_frame", job.parts},
                                     {"tasks", submission.tasks},
                                     {"array", idOrNull(submission.array)},
                                     {"finish", idOrNull(submission.finish)}});
}

/// Submits; where Slurm refuses, the job's folder waits for another try.
Submission submitOrTell(const Job& job, const std::vector<int>& tasks) {
    try {
        const Submission submission = submitTasks(job, tasks, false);
        tellSubmission(job, submission);
        return submission;
    } catch (const Error& error) {
        throw failure(
            "{}. The job is written, and not in the queue; try again by woodcock farm "
            "resubmit {}",
            error.what(), job.folder.string());
    }
}

std::vector<int> allTasks(const Job& job) {
    std::vector<int> tasks(static_cast<std::size_t>(job.tasks()));
    std::iota(tasks.begin(), tasks.end(), 1);
    return tasks;
}

void runSubmit(const SubmitOptions& options, const CLI::App& command) {
    options.render.reports.start();
    catchInterrupts();
    const Job job = makeJob(options, command);
    const std::vector<int> tasks = allTasks(job);
    spdlog::info("wrote {}: {} tasks", job.folder.string(), tasks.size());
    Submission submission{.tasks = tasks.size()};
    if (options.dryRun) {
        const Scripts scripts = writeScripts(job, tasks);
        spdlog::info("nothing is submitted. {} is for Slurm; without it: parallel -a {}",
                     scripts.render.string(), (job.folder / "tasks").string());
    } else {
        submission = submitOrTell(job, tasks);
    }
    if (options.render.reports.json) printSubmission(job, submission);
}

/// The tasks that are asked for, by their numbers or their frames.
std::vector<int> tasksAskedFor(const Job& job, const JobOptions& options) {
    if (options.tasks.empty() == options.frames.empty())
        throw usageError("woodcock farm run: give --tasks or --frames, such as --tasks 1-4");
    std::vector<int> tasks = options.tasks;
    for (const int frame : options.frames) {
        const auto found = std::find(job.frames.begin(), job.frames.end(), frame);
        if (!job.sequence || found == job.frames.end())
            throw usageError("--frames: the job has no frame {}; it has {}", frame,
                             job.sequence ? frameRangeText(job.frames) : "one picture alone");
        const auto those = tasksOf(job, static_cast<std::size_t>(found - job.frames.begin()));
        tasks.insert(tasks.end(), those.begin(), those.end());
    }
    for (const int task : tasks)
        if (task < 1 || task > job.tasks())
            throw usageError("--tasks: there is no task {}; the job has 1 to {}", task,
                             job.tasks());
    return tasks;
}

/// As many as Slurm gives; 0 for all, where it does not say, or the job does.
int threadsHere(const Job& job) {
    if (std::any_of(job.options.begin(), job.options.end(),
                    [](const std::string& option) { return option.starts_with("--threads"); }))
        return 0;
    for (const char* name : {"SLURM_CPUS_PER_TASK", "SLURM_CPUS_ON_NODE"})
        if (const char* const value = std::getenv(name)) return std::max(0, std::atoi(value));
    return 0;
}

/// Ends with what the report says.
void endWithReport(const RunReport& report, bool json) {
    if (json)
        printJson(nlohmann::ordered_json{
            {"done", report.done}, {"failed", report.failed}, {"interrupted", report.interrupted}});
    if (report.interrupted) endWith(exitInterrupted);
    if (report.worst != exitDone) endWith(report.worst);
}

void runRun(const JobOptions& options) {
    const ProgressStyle style = options.reports.start();
    const Job job = readJob(options.folder);
    const std::vector<int> tasks = tasksAskedFor(job, options);
    catchInterrupts();
    endWithReport(runTasks(job, tasks, threadsHere(job), style), options.reports.json);
}

void runStatus(const JobOptions& options) {
    options.reports.start();
    const Job job = readJob(options.folder);
    const JobStatus status = statusOf(job);
    if (options.reports.json)
        printJson(statusJson(job, status));
    else if (options.reports.printsText())
        printText(statusText(job, status));
}

/// Whether what is not done may be submitted by the job itself.
bool maySubmitAgain(const Job& job, const JobStatus& status) {
    if (status.unfinished.empty() || status.cancelled) return false;
    const std::vector<Submission> before = submissionsOf(job);
    int automatic = 0;  // in a row
    for (const Submission& submission : before)
        automatic = submission.automatic ? automatic + 1 : 0;
    if (automatic >= job.retries) {
        spdlog::error("gives up: it was submitted again {} times", automatic);
        return false;
    }
    if (!before.empty() && wasCancelled(before.back())) {
        spdlog::warn("the array was cancelled, and is not submitted again");
        return false;
    }
    return true;
}

void runFinish(const JobOptions& options) {
    options.reports.start();
    const Job job = readJob(options.folder);
    catchInterrupts();
    const RunReport report = mergePictures(job);
    if (report.interrupted) endWith(exitInterrupted);
    JobStatus status = statusOf(job);
    status.queue.clear();  // this job itself
    if (options.reports.json)
        printJson(statusJson(job, status));
    else if (options.reports.printsText())
        printText(statusText(job, status));
    if (status.allDone(job)) return;
    if (options.resubmit && maySubmitAgain(job, status))
        tellSubmission(job, submitTasks(job, status.unfinished, true));
    endWith(exitFailed);
}

void runCancel(const JobOptions& options) {
    options.reports.start();
    const Job job = readJob(options.folder);
    // First this, so that what ends does not go back into the queue.
    writeWholeFile(cancelledFile(job), "woodcock farm resubmit goes on with this job.\n");
    cancelInSlurm(submissionsOf(job));
    const JobStatus status = statusOf(job);
    spdlog::info("cancelled; woodcock farm resubmit {} goes on with it", job.folder.string());
    if (options.reports.json) printJson(statusJson(job, status));
}

void runResubmit(const JobOptions& options) {
    options.reports.start();
    const Job job = readJob(options.folder);
    const JobStatus status = statusOf(job);
    const auto running = status.parts.find(Standing::Running);
    if (!status.queue.empty() || (running != status.parts.end() && running->second > 0))
        throw usageError(
            "'{}' is still being worked on; woodcock farm status says how, and woodcock farm "
            "cancel ends it",
            job.folder.string());
    std::vector<int> tasks = status.unfinished;
    tasks.insert(tasks.end(), status.failed.begin(), status.failed.end());
    std::sort(tasks.begin(), tasks.end());
    if (status.allDone(job)) {
        spdlog::info("all is done: nothing to submit");
        return;
    }
    if (tasks.empty())
        throw usageError("all parts are drawn; woodcock farm finish {} merges them",
                         job.folder.string());
    demandSlurm();
    std::error_code none;
    fs::remove(cancelledFile(job), none);
    for (const int task : tasks) forget(job, nameOf(job, taskOf(job, task)));
    const Submission submission = submitOrTell(job, tasks);
    if (options.reports.json) printSubmission(job, submission);
}

/// A command that takes a job's folder.
CLI::App& addJobCommand(CLI::App& farm, const std::string& name, const std::string& help,
                        const std::string& json, void (*run)(const JobOptions&),
                        const std::function<void(CLI::App&, JobOptions&)>& addMore = {}) {
    const auto options = std::make_shared<JobOptions>();
    CLI::App& command = *farm.add_subcommand(name, help);
    command.add_option("FOLDER", options->folder, "The job's folder, as submit names it")
        ->required()
        ->type_name("");
    if (addMore) addMore(command, *options);
    options->reports.addTo(command, json);
    command.callback([options, run] { run(*options); });
    return command;
}

void addSubmit(CLI::App& farm) {
    const auto options = std::make_shared<SubmitOptions>();
    CLI::App& command =
        *farm.add_subcommand("submit", "Draw frames, in parts, on the machines of a farm");
    options->addTo(command);
    command.callback([options, &command] { runSubmit(*options, command); });
}

CLI::App& addTo(CLI::App& app, const std::string&) {
    CLI::App& farm =
        *app.add_subcommand("farm", "Draw frames on many machines: by Slurm, or by other farms");
    farm.require_subcommand(1);
    addSubmit(farm);
    const std::string statusHelp = "Print the counts and what failed as a JSON object on stdout";
    addJobCommand(farm, "status", "Show what of a job is done, runs or failed, and why", statusHelp,
                  runStatus);
    addJobCommand(farm, "cancel", "End a job; what is drawn by then stays", statusHelp, runCancel);
    addJobCommand(farm, "resubmit", "Submit what of a job is not done",
                  "Print the job's folder and numbers as a JSON object on stdout", runResubmit);
    addJobCommand(farm, "run", "Do tasks of a job here; farms call this",
                  "Print what was done and failed as a JSON object on stdout", runRun,
                  [](CLI::App& command, JobOptions& options) {
                      addParsed(command, "--tasks", options.tasks, parseFrameRange,
                                "The tasks of these numbers, such as 3 or 1-4: lines of the job "
                                "file")
                          ->type_name("RANGE");
                      addFrames(command, options.frames, "All parts of these frames");
                  });
    addJobCommand(farm, "finish", "Merge the parts of pictures that have all of them; say the rest",
                  statusHelp, runFinish, [](CLI::App& command, JobOptions& options) {
                      command.add_flag("--resubmit", options.resubmit,
                                       "Submit tasks again that were lost; Slurm's job has this");
                  });
    farm.footer(
        examplesText({"woodcock farm submit shot.toml --frames 1-240 --parts 4 -o smoke.####.exr",
                      "woodcock farm status shot.farm", "woodcock farm submit --help"}));
    for (CLI::App* command : farm.get_subcommands(nullptr))
        for (CLI::Option* option : command->get_options()) option->disable_flag_override();
    return farm;
}

}  // namespace

extern const Command farmCommand{&addTo};

}  // namespace woodcock::tool
