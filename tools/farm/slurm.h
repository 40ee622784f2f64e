// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "tools/farm/job.h"

namespace woodcock::tool::farm {

/// What was handed to Slurm at once: an array that draws, and a job after it that merges.
struct Submission {
    std::string array = {}, finish = {};  ///< their numbers
    std::size_t tasks = 0;
    bool automatic = false;  ///< by the job that merges, as tasks were lost
};
std::vector<Submission> submissionsOf(const Job& job);

/// Throws Error{Usage} where there is no sbatch.
void demandSlurm();

/// How many elements an array may have; as Slurm has it by default, where it does not say.
int largestArray();

/// Writes the scripts of the next submission of these tasks; returns their names: what draws, and
/// what merges. Throws Error{Failure}.
struct Scripts {
    std::filesystem::path render, finish;
};
Scripts writeScripts(const Job& job, const std::vector<int>& tasks);

/// Writes scripts and submits them. Throws Error{Failure} with Slurm's words; then nothing of it is
/// in the queue.
Submission submitTasks(const Job& job, const std::vector<int>& tasks, bool automatic);

/// Jobs of one state in the queue.
struct QueueEntry {
    std::string job;     ///< the array's or the other's number
    std::string state;   ///< in Slurm's words: PENDING, RUNNING
    std::string reason;  ///< why it waits
    int count = 0;
};
/// What Slurm still knows of the job; empty where there is no Slurm, or it does not answer.
std::vector<QueueEntry> queueOf(const Job& job);
/// Whether somebody cancelled elements of the array.
bool wasCancelled(const Submission& submission);

/// Throws Error{Failure} with Slurm's words.
void cancelInSlurm(const std::vector<Submission>& submissions);

}  // namespace woodcock::tool::farm
