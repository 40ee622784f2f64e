// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tools/farm/job.h"
#include "tools/farm/slurm.h"
#include "tools/farm/work.h"

namespace woodcock::tool::farm {

struct JobStatus {
    std::map<Standing, int> parts, pictures;  ///< how many; pictures as far as merging goes
    /// What failed, or was lost: its name, in words, and what it said.
    struct Trouble {
        std::string name, what;
        WorkStatus status;
    };
    std::vector<Trouble> troubles;
    std::vector<int> unfinished;  ///< tasks that are neither done nor failed
    std::vector<int> failed;      ///< tasks
    std::vector<QueueEntry> queue;
    bool cancelled = false;

    bool allDone(const Job& job) const;
};

/// From the folder's files alone, but for the queue.
JobStatus statusOf(const Job& job);

std::string statusText(const Job& job, const JobStatus& status);
nlohmann::ordered_json statusJson(const Job& job, const JobStatus& status);

}  // namespace woodcock::tool::farm
