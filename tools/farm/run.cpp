// SPDX-License-Identifier: Apache-2.0
#include "tools/farm/run.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cstdlib>

#include "tools/common/print.h"
#include "woodcock/base/error.h"

namespace woodcock::tool::farm {

namespace {

namespace fs = std::filesystem;

void add(RunReport& report, const std::string& what, ExitCode code) {
    if (code == exitDone) {
        ++report.done;
    } else if (code == exitInterrupted) {
        report.interrupted = true;
    } else {
        report.worst = report.failed.empty() ? code : exitFailed;
        report.failed.push_back(what);
    }
}

/// 42 of "ALF_PROGRESS 42%".
std::optional<double> percentOf(const std::string& line) {
    constexpr std::string_view start = "ALF_PROGRESS ";
    if (!line.starts_with(start)) return {};
    return std::strtod(line.c_str() + start.size(), nullptr);
}

bool hasAllParts(const Job& job, std::size_t picture) {
    const std::vector<int> tasks = tasksOf(job, picture);
    return std::all_of(tasks.begin(), tasks.end(), [&](int number) {
        return statusOf(job, taskOf(job, number)).standing == Standing::Done;
    });
}

void removeParts(const Job& job, std::size_t picture) {
    if (job.keepsParts) return;
    for (const int number : tasksOf(job, picture)) {
        const Task task = taskOf(job, number);
        std::vector<fs::path> files = filesBeside(job, task);
        files.push_back(partFile(job, task));
        std::error_code none;
        for (const fs::path& file : files) fs::remove(file, none);
    }
}

void passOn(const std::string& line) { printProgress("{}\n", line); }

ExitCode merge(const Job& job, std::size_t picture) {
    return doOnce(
        job,
        {.name = nameOf(job, picture),
         .what = describe(job, picture) + ", merging",
         .command = mergeCommand(job, picture),
         .isDone = [&] { return statusOf(job, picture).record.stage == WorkRecord::Stage::Done; },
         .afterwards = [&] { removeParts(job, picture); }},
        passOn);
}

ExitCode draw(const Job& job, const Task& task, int threads,
              const std::function<void(double)>& progress) {
    std::vector<std::string> command = renderCommand(job, task, threads);
    command.insert(command.end(), {"--progress", "alfred"});
    return doOnce(job,
                  {.name = nameOf(job, task),
                   .what = describe(job, task),
                   .command = std::move(command),
                   .isDone = [&] { return statusOf(job, task).standing == Standing::Done; }},
                  [&](const std::string& line) {
                      if (const auto percent = percentOf(line))
                          progress(*percent / 100);
                      else
                          passOn(line);
                  });
}

}  // namespace

RunReport runTasks(const Job& job, const std::vector<int>& tasks, int threads,
                   ProgressStyle style) {
    RunReport report;
    ProgressBar bar(style, "farm");
    for (std::size_t i = 0; i < tasks.size() && !report.interrupted; ++i) {
        const Task task = taskOf(job, tasks[i]);
        const auto progress = [&](double fraction) {
            bar.update((static_cast<double>(i) + fraction) / static_cast<double>(tasks.size()),
                       describe(job, task));
        };
        const ExitCode code = draw(job, task, threads, progress);
        add(report, describe(job, task), code);
        if (code != exitDone) continue;
        progress(1);
        if (!hasAllParts(job, task.picture)) continue;
        if (const ExitCode merged = merge(job, task.picture); merged != exitDone)
            add(report, describe(job, task.picture) + ", merging", merged);
    }
    return report;
}

RunReport mergePictures(const Job& job) {
    RunReport report;
    for (std::size_t picture = 0; picture < job.frames.size() && !report.interrupted; ++picture)
        if (hasAllParts(job, picture))
            add(report, describe(job, picture) + ", merging", merge(job, picture));
    return report;
}

}  // namespace woodcock::tool::farm
