// SPDX-License-Identifier: Apache-2.0
#include "tools/farm/work.h"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <thread>

#include "tools/common/child_process.h"
#include "tools/common/interrupt.h"
#include "tools/common/json_text.h"
#include "tools/common/render_command.h"
#include "tools/farm/file_lock.h"
#include "woodcock/base/error.h"
#include "woodcock/base/whole_file.h"

namespace woodcock::tool::farm {

namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;
using Stage = WorkRecord::Stage;

constexpr const char* killedEachTime = "who worked on it was killed each time";
constexpr std::array<const char*, 4> stageNames{"begun", "interrupted", "failed", "done"};

fs::path recordFile(const Job& job, const std::string& name) {
    return job.folder / "state" / (name + ".json");
}
fs::path lockFile(const Job& job, const std::string& name) {
    return job.folder / "state" / (name + ".lock");
}

std::optional<WorkRecord> readRecord(const Job& job, const std::string& name) {
    const fs::path file = recordFile(job, name);
    std::ifstream in(file);
    if (!in) return {};
    std::stringstream text;
    text << in.rdbuf();
    try {
        const auto json = nlohmann::json::parse(text.str());
        const std::string stage = json.at("stage");
        const auto found = std::find(stageNames.begin(), stageNames.end(), stage);
        if (found == stageNames.end())
            throw inputError("'{}' is damaged: the stage is '{}'", file.string(), stage);
        return WorkRecord{static_cast<Stage>(found - stageNames.begin()), json.at("attempts"),
                          json.at("exit_code"), json.at("error"), json.at("host")};
    } catch (const nlohmann::json::exception& error) {
        throw inputError("'{}' is damaged: {}", file.string(), error.what());
    }
}

void writeRecord(const Job& job, const std::string& name, const WorkRecord& record) {
    const nlohmann::ordered_json json{{"stage", stageNames[static_cast<std::size_t>(record.stage)]},
                                      {"attempts", record.attempts},
                                      {"exit_code", record.exitCode},
                                      {"error", record.error},
                                      {"host", record.host}};
    writeWholeFile(recordFile(job, name), jsonText(json) + "\n");
}

std::string hostName() {
    std::array<char, 256> name{};
    return gethostname(name.data(), name.size() - 1) == 0 ? name.data() : "unknown";
}

/// ", Slurm 12_3" where Slurm runs this.
std::string slurmPlace() {
    const char* const job = std::getenv("SLURM_ARRAY_JOB_ID");
    const char* const element = std::getenv("SLURM_ARRAY_TASK_ID");
    return job && element ? fmt::format(", Slurm {}_{}", job, element) : "";
}

std::string nowText() {
    return fmt::format("{:%Y-%m-%d %H:%M:%S}Z", fmt::gmtime(std::time(nullptr)));
}

/// Asks whether the work has to stop: by a signal, or as the job is cancelled, which is looked up
/// once a second.
class StopQuestion {
public:
    explicit StopQuestion(const Job& job) : file_(cancelledFile(job)) {}

    bool operator()() {
        if (interrupted() || cancelled_) return true;
        const Clock::time_point now = Clock::now();
        if (now < next_) return false;
        next_ = now + std::chrono::seconds(1);
        std::error_code none;
        return cancelled_ = fs::exists(file_, none);
    }

private:
    fs::path file_;
    bool cancelled_ = false;
    Clock::time_point next_{};
};

/// Absent where it has to stop before.
std::optional<FileLock> waitForLock(const Job& job, const Work& work, StopQuestion& shouldStop) {
    const fs::path file = lockFile(job, work.name);
    for (bool told = false; !shouldStop();
         std::this_thread::sleep_for(std::chrono::milliseconds(100))) {
        if (auto lock = FileLock::tryToHold(file)) return lock;
        if (!std::exchange(told, true))
            spdlog::info("{}: another process is at it; waits for it", work.what);
    }
    return {};
}

struct Attempt {
    int exitCode = 0;
    std::string error;
};

std::string endText(int exitCode) {
    if (exitCode <= 128 || exitCode == exitInterrupted)
        return fmt::format("exit code {}", exitCode);
    const int signal = exitCode - 128;
    return fmt::format("ended by signal {}{}", signal,
                       signal == 9 ? " (SIGKILL, as where memory runs out)" : "");
}

/// Runs the command once, with a log.
Attempt tryOnce(const Job& job, const Work& work, int number,
                const std::function<void(const std::string&)>& onLine, StopQuestion& shouldStop) {
    std::ofstream log(logFile(job, work.name), std::ios::app);
    std::string line;
    for (const std::string& word : work.command) line += " " + shellWord(word);
    log << fmt::format("--- {} attempt {} on {}{}:{}\n", nowText(), number, hostName(),
                       slurmPlace(), line)
        << std::flush;
    Attempt attempt;
    const auto take = [&](const std::string& text) {
        constexpr std::string_view error = "error: ";
        if (text.starts_with(error)) attempt.error = text.substr(error.size());
        if (!text.starts_with("ALF_PROGRESS")) log << text << '\n' << std::flush;
        onLine(text);
    };
    // It may have a long checkpoint to write. What drives the farm knows when that is too long.
    constexpr std::chrono::hours patience(1);
    const auto start = Clock::now();
    attempt.exitCode = runChild(
                           work.command, take, [&] { return shouldStop(); }, patience)
                           .exitCode;
    const std::chrono::duration<double> seconds = Clock::now() - start;
    log << fmt::format("--- {} {} after {:.1f} s\n", nowText(), endText(attempt.exitCode),
                       seconds.count());
    if (attempt.error.empty() && attempt.exitCode != 0) attempt.error = endText(attempt.exitCode);
    return attempt;
}

bool mayBeRepeated(int exitCode) { return exitCode != exitWrongUsage && exitCode != exitBadInput; }

/// What this command ends with: as the other did; 137 tells farms that memory may have run out.
ExitCode codeOf(int exitCode) {
    return exitCode == exitDone ? exitFailed : static_cast<ExitCode>(exitCode);
}

Standing standingOf(const Job& job, const std::optional<WorkRecord>& record, bool held) {
    if (record && record->stage == Stage::Done) return Standing::Done;
    if (held) return Standing::Running;
    if (!record) return Standing::Waiting;
    if (record->stage == Stage::Interrupted) return Standing::Interrupted;
    const bool again = record->stage == Stage::Begun && record->attempts <= job.retries;
    return again ? Standing::Lost : Standing::Failed;
}

}  // namespace

std::string nameOf(Standing standing) {
    constexpr std::array names{"waiting", "running", "interrupted", "lost", "failed", "done"};
    return names[static_cast<std::size_t>(standing)];
}

WorkStatus statusOf(const Job& job, const std::string& name) {
    // The lock first: whoever lets it go has written the record before.
    const bool held = FileLock::isHeld(lockFile(job, name));
    const std::optional<WorkRecord> record = readRecord(job, name);
    WorkStatus status{standingOf(job, record, held), record.value_or(WorkRecord{})};
    if (status.standing == Standing::Failed && status.record.stage == Stage::Begun)
        status.record.error = killedEachTime;
    return status;
}

WorkStatus statusOf(const Job& job, const Task& task) {
    WorkStatus status = statusOf(job, nameOf(job, task));
    std::error_code none;
    if (fs::exists(partFile(job, task), none) ||
        statusOf(job, task.picture).standing == Standing::Done)
        status.standing = Standing::Done;
    else if (status.standing == Standing::Done)
        status.standing = Standing::Waiting;  // its file was removed
    return status;
}

WorkStatus statusOf(const Job& job, std::size_t picture) {
    return statusOf(job, nameOf(job, picture));
}

ExitCode doOnce(const Job& job, const Work& work,
                const std::function<void(const std::string&)>& onLine) {
    StopQuestion shouldStop(job);
    const auto lock = waitForLock(job, work, shouldStop);
    if (!lock) return exitInterrupted;
    WorkRecord record = readRecord(job, work.name).value_or(WorkRecord{});
    if (record.stage == Stage::Failed) record = {};
    const auto keep = [&](Stage stage) {
        record.stage = stage, record.host = hostName();
        writeRecord(job, work.name, record);
    };
    while (!work.isDone()) {
        if (record.attempts > job.retries) {
            if (record.error.empty()) record.error = killedEachTime;
            keep(Stage::Failed);
            spdlog::error("{}: gives up after {} attempt{}: {}", work.what, record.attempts,
                          record.attempts == 1 ? "" : "s", record.error);
            return codeOf(record.exitCode);
        }
        if (shouldStop()) {
            keep(Stage::Interrupted);
            return exitInterrupted;
        }
        ++record.attempts, record.error.clear();
        keep(Stage::Begun);
        const Attempt attempt = tryOnce(job, work, record.attempts, onLine, shouldStop);
        record.exitCode = attempt.exitCode, record.error = attempt.error;
        if (attempt.exitCode == exitDone) {
            keep(Stage::Done);
            if (work.isDone()) {
                spdlog::info("{}: done", work.what);
                break;
            }
            record.error = "the command ends well, and nothing is done";
        } else if (attempt.exitCode == exitInterrupted) {
            --record.attempts;
            keep(Stage::Interrupted);
            return exitInterrupted;
        } else if (!mayBeRepeated(attempt.exitCode)) {
            keep(Stage::Failed);
            spdlog::error("{}: {}", work.what, attempt.error);
            return codeOf(attempt.exitCode);
        }
        spdlog::warn("{}: attempt {} of {}: {}", work.what, record.attempts, job.retries + 1,
                     record.error);
    }
    work.afterwards();
    return exitDone;
}

void forget(const Job& job, const std::string& name) {
    const auto lock = FileLock::tryToHold(lockFile(job, name));
    if (!lock) return;
    std::error_code none;
    fs::remove(recordFile(job, name), none);
}

}  // namespace woodcock::tool::farm
