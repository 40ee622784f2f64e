// SPDX-License-Identifier: Apache-2.0
#include "tools/farm/status.h"

#include <fmt/format.h>

namespace woodcock::tool::farm {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;
using Counts = std::map<Standing, int>;

constexpr std::array standings{Standing::Done,        Standing::Running, Standing::Waiting,
                               Standing::Interrupted, Standing::Lost,    Standing::Failed};

int countOf(const Counts& counts, Standing standing) {
    const auto found = counts.find(standing);
    return found == counts.end() ? 0 : found->second;
}

std::string countsText(const Counts& counts) {
    std::string text;
    for (const Standing standing : standings)
        if (const int count = countOf(counts, standing))
            text += fmt::format("{}{} {}", text.empty() ? "" : ", ", count, nameOf(standing));
    return text;
}

Json countsJson(const Counts& counts) {
    Json json;
    for (const Standing standing : standings) json[nameOf(standing)] = countOf(counts, standing);
    return json;
}

std::string troubleText(const Job& job, const JobStatus::Trouble& trouble) {
    const WorkRecord& record = trouble.status.record;
    return fmt::format("{}  {}: {} after {} attempt{} on {}: {}\n{:10}its log: {}\n",
                       nameOf(trouble.status.standing), trouble.what,
                       trouble.status.standing == Standing::Lost ? "gone" : "fails",
                       record.attempts, record.attempts == 1 ? "" : "s", record.host,
                       record.error.empty() ? "killed without a word" : record.error, "",
                       logFile(job, trouble.name).string());
}

std::string queueText(const std::vector<QueueEntry>& queue) {
    std::string text;
    for (const QueueEntry& entry : queue)
        text += fmt::format("Slurm {}: {} {}{}\n", entry.job, entry.count, entry.state,
                            entry.state == "PENDING" ? fmt::format(" ({})", entry.reason) : "");
    return text;
}

void addTrouble(JobStatus& status, const std::string& name, const std::string& what,
                const WorkStatus& work) {
    if (work.standing == Standing::Failed || work.standing == Standing::Lost)
        status.troubles.push_back({name, what, work});
}

}  // namespace

bool JobStatus::allDone(const Job& job) const {
    return countOf(pictures, Standing::Done) == static_cast<int>(job.frames.size());
}

JobStatus statusOf(const Job& job) {
    JobStatus status;
    for (std::size_t picture = 0; picture < job.frames.size(); ++picture) {
        const WorkStatus merged = statusOf(job, picture);
        ++status.pictures[merged.standing];
        if (merged.standing == Standing::Done) {
            status.parts[Standing::Done] += job.parts;
            continue;
        }
        addTrouble(status, nameOf(job, picture), describe(job, picture) + ", merging", merged);
        for (const int number : tasksOf(job, picture)) {
            const Task task = taskOf(job, number);
            const WorkStatus work = statusOf(job, task);
            ++status.parts[work.standing];
            addTrouble(status, nameOf(job, task), describe(job, task), work);
            if (work.standing == Standing::Failed)
                status.failed.push_back(number);
            else if (work.standing != Standing::Done)
                status.unfinished.push_back(number);
        }
    }
    status.queue = queueOf(job);
    std::error_code none;
    status.cancelled = fs::exists(cancelledFile(job), none);
    return status;
}

std::string statusText(const Job& job, const JobStatus& status) {
    std::string text = fmt::format(
        "{}: {}, {} in {} part{}{}\n", job.folder.string(), job.input,
        job.sequence
            ? fmt::format("{} frame{}", job.frames.size(), job.frames.size() == 1 ? "" : "s")
            : "one picture",
        job.parts, job.parts == 1 ? "" : "s", status.cancelled ? ", cancelled" : "");
    text += fmt::format("{:5} part{}: {}\n", job.tasks(), job.tasks() == 1 ? "" : "s",
                        countsText(status.parts));
    text += fmt::format("{:5} {} merged\n", countOf(status.pictures, Standing::Done),
                        job.sequence ? "frames" : "picture");
    for (const JobStatus::Trouble& trouble : status.troubles) text += troubleText(job, trouble);
    return text + queueText(status.queue);
}

Json statusJson(const Job& job, const JobStatus& status) {
    Json troubles = Json::array(), queue = Json::array();
    for (const JobStatus::Trouble& trouble : status.troubles)
        troubles.push_back({{"what", trouble.what},
                            {"standing", nameOf(trouble.status.standing)},
                            {"attempts", trouble.status.record.attempts},
                            {"exit_code", trouble.status.record.exitCode},
                            {"host", trouble.status.record.host},
                            {"error", trouble.status.record.error},
                            {"log", logFile(job, trouble.name).string()}});
    for (const QueueEntry& entry : status.queue)
        queue.push_back({{"job", entry.job},
                         {"state", entry.state},
                         {"reason", entry.reason},
                         {"count", entry.count}});
    return {{"folder", job.folder.string()},
            {"input", job.input},
            {"scene_digest", job.digest},
            {"frames", job.frames.size()},
            {"parts_per_frame", job.parts},
            {"parts", countsJson(status.parts)},
            {"frames_merged", countOf(status.pictures, Standing::Done)},
            {"all_done", status.allDone(job)},
            {"cancelled", status.cancelled},
            {"troubles", troubles},
            {"slurm", queue}};
}

}  // namespace woodcock::tool::farm
