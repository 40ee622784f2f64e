// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "tools/common/exit_codes.h"
#include "tools/farm/job.h"

namespace woodcock::tool::farm {

// Work on a part or a picture, known by its name as of nameOf(). It is done once, whoever tries:
// one process at a time holds its lock, and what is done is not done again.

/// What the last to work on it said.
struct WorkRecord {
    enum class Stage { Begun, Interrupted, Failed, Done };
    Stage stage = Stage::Begun;
    int attempts = 0;  ///< that were not interrupted
    int exitCode = 0;  ///< of the last; 128 + signal where one ended it
    std::string error;
    std::string host;
};

/// How it stands with it.
enum class Standing {
    Waiting,      ///< nobody began it
    Running,      ///< somebody holds its lock
    Interrupted,  ///< it goes on from its checkpoint
    Lost,         ///< who began it is gone without a word
    Failed,
    Done
};
std::string nameOf(Standing standing);

struct WorkStatus {
    Standing standing = Standing::Waiting;
    WorkRecord record;
};
WorkStatus statusOf(const Job& job, const std::string& name);
/// Those of a part and of a picture. A part is done while its file is there, and once its picture
/// is done.
WorkStatus statusOf(const Job& job, const Task& task);
WorkStatus statusOf(const Job& job, std::size_t picture);

struct Work {
    std::string name;
    std::string what;  ///< for messages: "frame 7, part 1"
    std::vector<std::string> command;
    std::function<bool()> isDone;
    std::function<void()> afterwards = [] {};  ///< under the lock, whenever it is done
};

/// Does the work, unless it is done, after whoever else is at it. Repeats what fails or is killed,
/// as often as the job says, but not what is wrong in the input or the command line. A command that
/// ends well and leaves the work undone has failed. Work that
/// failed before is begun anew. `onLine` gets what the command writes; the log keeps it.
/// exitInterrupted: after interrupted(), or as the job is cancelled.
ExitCode doOnce(const Job& job, const Work& work,
                const std::function<void(const std::string&)>& onLine);

/// Forgets what is recorded of work that failed or was lost, so that it is begun anew.
void forget(const Job& job, const std::string& name);

}  // namespace woodcock::tool::farm
