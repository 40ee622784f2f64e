// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "tools/common/progress.h"
#include "tools/farm/job.h"
#include "tools/farm/work.h"

namespace woodcock::tool::farm {

/// How pieces of work went.
struct RunReport {
    std::vector<std::string> failed;  ///< what they are
    std::size_t done = 0;
    ExitCode worst = exitDone;  ///< the code of one that failed; exitFailed of several
    bool interrupted = false;
};

/// Draws these tasks, and merges each picture whose last part that was. One that fails does not
/// stop the rest. `threads` of each render; 0 for all.
RunReport runTasks(const Job& job, const std::vector<int>& tasks, int threads, ProgressStyle style);

/// Merges the pictures that have all their parts, unless that is done. The others are left.
RunReport mergePictures(const Job& job);

}  // namespace woodcock::tool::farm
