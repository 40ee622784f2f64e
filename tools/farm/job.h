// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace woodcock::tool::farm {

/// What a farm is to draw: pictures, each in parts. It lies in a folder of its own, which every
/// machine sees at the same place, and is not changed once it is written.
struct Job {
    std::filesystem::path folder;  ///< absolute; not in the file
    std::string program;           ///< that does the tasks
    std::string input;             ///< what was submitted, for people
    std::string scene;             ///< the scene file in the folder; may hold a frame's number
    std::string digest;            ///< of sceneDigest(); empty where each frame has its own scene

    std::vector<int> frames;  ///< one at least
    bool sequence = true;     ///< false: one picture without a number, and `frames` is {0}
    int parts = 1;            ///< of each picture

    // What the parts share out.
    int samples = 0;
    bool adaptive = false;  ///< parts differ in their seeds
    std::uint64_t seed = 0;
    bool endsEarly = false;  ///< by a limit of time or noise

    std::vector<std::string> outputs;  ///< absolute; hold the frame's number, if it is a sequence
    std::string mattesFile, deepFile;  ///< the same; may be empty
    bool denoises = false;             ///< the merged picture
    std::vector<std::string> options;  ///< of every render
    double checkpoint = 60;            ///< seconds between two
    int retries = 3;
    bool keepsParts = false;

    std::vector<std::string> sbatchOptions;
    int atOnce = 0;           ///< array elements; 0: as many as there is room for
    int tasksPerElement = 1;  ///< at least

    int tasks() const { return static_cast<int>(frames.size()) * parts; }
};

/// One line of the job file: a part of a picture.
struct Task {
    std::size_t picture = 0;  ///< the place of its frame in Job::frames
    int part = 0;             ///< from 0
};

/// `number`: from 1, as lines count; the parts of a picture follow each other.
Task taskOf(const Job& job, int number);
/// The numbers of the tasks of a picture.
std::vector<int> tasksOf(const Job& job, std::size_t picture);

/// "frame 7, part 1", "frame 7", "part 1" or "picture": as far as there are several.
std::string describe(const Job& job, const Task& task);
std::string describe(const Job& job, std::size_t picture);

/// "0007" and "0007.1": what files about a picture and about a part begin with.
std::string nameOf(const Job& job, std::size_t picture);
std::string nameOf(const Job& job, const Task& task);

std::filesystem::path partFile(const Job& job, const Task& task);
/// What a render may leave beside a part: a checkpoint, and mattes and deep pixels by themselves.
std::vector<std::filesystem::path> filesBeside(const Job& job, const Task& task);
std::filesystem::path logFile(const Job& job, const std::string& name);

/// The file that says that a job is cancelled.
std::filesystem::path cancelledFile(const Job& job);

/// The words that draw a part, and those that merge a picture. `threads`: 0 for all.
std::vector<std::string> renderCommand(const Job& job, const Task& task, int threads);
std::vector<std::string> mergeCommand(const Job& job, std::size_t picture);

/// Writes what the folder of a new job holds, beside its scenes: job.json, and the job file
/// `tasks`, with one command a line. Throws Error{Failure}.
void writeJob(const Job& job);

/// Throws Error{Usage} where `folder` is no job's, and Error{Input} where its file is damaged.
Job readJob(const std::filesystem::path& folder);

}  // namespace woodcock::tool::farm
