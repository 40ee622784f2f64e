// SPDX-License-Identifier: Apache-2.0
#include "tools/farm/job.h"

#include <fmt/format.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tools/common/json_text.h"
#include "tools/common/render_command.h"
#include "woodcock/base/error.h"
#include "woodcock/base/frame_names.h"
#include "woodcock/base/whole_file.h"

namespace woodcock::tool::farm {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr int formatVersion = 1;

Json jsonOf(const Job& job) {
    return {{"woodcock_farm", formatVersion},
            {"program", job.program},
            {"input", job.input},
            {"scene", job.scene},
            {"scene_digest", job.digest},
            {"frames", job.frames},
            {"sequence", job.sequence},
            {"parts", job.parts},
            {"samples", job.samples},
            {"adaptive", job.adaptive},
            {"seed", job.seed},
            {"ends_early", job.endsEarly},
            {"outputs", job.outputs},
            {"mattes_file", job.mattesFile},
            {"deep_file", job.deepFile},
            {"denoise", job.denoises},
            {"options", job.options},
            {"checkpoint", job.checkpoint},
            {"retries", job.retries},
            {"keep_parts", job.keepsParts},
            {"sbatch_options", job.sbatchOptions},
            {"at_once", job.atOnce},
            {"tasks_per_element", job.tasksPerElement}};
}

Job jobOf(const Json& json) {
    Job job;
    json.at("program").get_to(job.program);
    json.at("input").get_to(job.input);
    json.at("scene").get_to(job.scene);
    json.at("scene_digest").get_to(job.digest);
    json.at("frames").get_to(job.frames);
    json.at("sequence").get_to(job.sequence);
    json.at("parts").get_to(job.parts);
    json.at("samples").get_to(job.samples);
    json.at("adaptive").get_to(job.adaptive);
    json.at("seed").get_to(job.seed);
    json.at("ends_early").get_to(job.endsEarly);
    json.at("outputs").get_to(job.outputs);
    json.at("mattes_file").get_to(job.mattesFile);
    json.at("deep_file").get_to(job.deepFile);
    json.at("denoise").get_to(job.denoises);
    json.at("options").get_to(job.options);
    json.at("checkpoint").get_to(job.checkpoint);
    json.at("retries").get_to(job.retries);
    json.at("keep_parts").get_to(job.keepsParts);
    json.at("sbatch_options").get_to(job.sbatchOptions);
    json.at("at_once").get_to(job.atOnce);
    json.at("tasks_per_element").get_to(job.tasksPerElement);
    return job;
}

/// The first sample of a part; the parts are as even as they can be.
int firstSample(const Job& job, int part) {
    return static_cast<int>(std::int64_t{job.samples} * part / job.parts);
}

/// An output with the picture's number filled in.
fs::path inPicture(const Job& job, const std::string& output, std::size_t picture) {
    return job.sequence ? withFrame(output, job.frames[picture]) : output;
}

std::string taskLines(const Job& job) {
    std::string text;
    for (int number = 1; number <= job.tasks(); ++number)
        text +=
            fmt::format("{} farm run {} --tasks {}  # {}\n", shellWord(job.program),
                        shellWord(job.folder.string()), number, describe(job, taskOf(job, number)));
    return text;
}

}  // namespace

Task taskOf(const Job& job, int number) {
    return {static_cast<std::size_t>((number - 1) / job.parts), (number - 1) % job.parts};
}

std::vector<int> tasksOf(const Job& job, std::size_t picture) {
    std::vector<int> numbers;
    for (int part = 0; part < job.parts; ++part)
        numbers.push_back(static_cast<int>(picture) * job.parts + part + 1);
    return numbers;
}

std::string describe(const Job& job, std::size_t picture) {
    return job.sequence ? fmt::format("frame {}", job.frames[picture]) : "picture";
}

std::string describe(const Job& job, const Task& task) {
    if (job.parts == 1) return describe(job, task.picture);
    return fmt::format("{}part {}", job.sequence ? describe(job, task.picture) + ", " : "",
                       task.part);
}

std::string nameOf(const Job& job, std::size_t picture) {
    return withFrame("####", job.frames[picture]);
}

std::string nameOf(const Job& job, const Task& task) {
    return fmt::format("{}.{}", nameOf(job, task.picture), task.part);
}

fs::path partFile(const Job& job, const Task& task) {
    return job.folder / "parts" / (nameOf(job, task) + ".exr");
}

std::vector<fs::path> filesBeside(const Job& job, const Task& task) {
    std::vector<fs::path> files;
    for (const char* extension : {".checkpoint.exr", ".mattes.exr", ".deep.exr"})
        files.push_back(job.folder / "parts" / (nameOf(job, task) + extension));
    return files;
}

fs::path logFile(const Job& job, const std::string& name) {
    return job.folder / "logs" / (name + ".log");
}

fs::path cancelledFile(const Job& job) { return job.folder / "cancelled"; }

std::vector<std::string> renderCommand(const Job& job, const Task& task, int threads) {
    const std::string part = (job.folder / "parts" / fmt::format("####.{}", task.part)).string();
    std::vector<std::string> words{job.program,
                                   "render",
                                   (job.folder / job.scene).string(),
                                   fmt::format("--frames={}", job.frames[task.picture]),
                                   "-o",
                                   part + ".exr",
                                   "--checkpoint",
                                   fmt::format("{}", job.checkpoint),
                                   "--resume"};
    words.insert(words.end(), job.options.begin(), job.options.end());
    const int first = firstSample(job, task.part), end = firstSample(job, task.part + 1);
    const auto add = [&words](const char* option, const std::string& value) {
        words.insert(words.end(), {option, value});
    };
    if (job.adaptive) {
        add("--spp", std::to_string(end - first));
        add("--seed", std::to_string(job.seed + static_cast<std::uint64_t>(task.part)));
        words.push_back("--mergeable");
    } else {
        add("--samples", fmt::format("{}:{}", first, end));
    }
    if (!job.mattesFile.empty()) add("--mattes-file", part + ".mattes.exr");
    if (!job.deepFile.empty()) add("--deep", part + ".deep.exr");
    if (threads > 0) add("--threads", std::to_string(threads));
    return words;
}

std::vector<std::string> mergeCommand(const Job& job, std::size_t picture) {
    std::vector<std::string> words{job.program, "merge"};
    for (int part = 0; part < job.parts; ++part)
        words.push_back(partFile(job, {picture, part}).string());
    const auto add = [&](const char* option, const std::string& output) {
        words.insert(words.end(), {option, inPicture(job, output, picture).string()});
    };
    for (const std::string& output : job.outputs) add("-o", output);
    if (!job.mattesFile.empty()) add("--mattes-file", job.mattesFile);
    if (!job.deepFile.empty()) add("--deep", job.deepFile);
    if (job.denoises) words.push_back("--denoise");
    if (!job.adaptive && !job.endsEarly)
        words.insert(words.end(), {"--spp", std::to_string(job.samples)});
    return words;
}

void writeJob(const Job& job) {
    writeWholeFile(job.folder / "tasks", taskLines(job));
    writeWholeFile(job.folder / "job.json", jsonText(jsonOf(job), 4) + "\n");
}

Job readJob(const fs::path& folder) {
    const fs::path file = folder / "job.json";
    std::ifstream in(file);
    if (!in)
        throw usageError(
            "'{}' is no job's folder: it has no job.json; woodcock farm submit makes one",
            folder.string());
    std::stringstream text;
    text << in.rdbuf();
    try {
        const Json json = Json::parse(text.str());
        if (const int version = json.at("woodcock_farm"); version != formatVersion)
            throw inputError("'{}' is of another woodcock: its format is {}, and this one knows {}",
                             file.string(), version, formatVersion);
        Job job = jobOf(json);
        if (job.frames.empty() || job.parts < 1 || job.outputs.empty())
            throw inputError("'{}' is damaged: it names no pictures", file.string());
        job.folder = fs::canonical(folder);
        return job;
    } catch (const nlohmann::json::exception& error) {
        throw inputError("'{}' is damaged: {}", file.string(), error.what());
    }
}

}  // namespace woodcock::tool::farm
