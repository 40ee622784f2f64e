// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <cmath>

#include "tools/trade/report.h"
#include "woodcock/base/version.h"

namespace woodcock::tool {

using Json = nlohmann::ordered_json;

namespace {

Json measured(const trade::Measured& m) {
    return {{"value", m.value}, {"se", m.se}};  // infinite becomes null
}

/// The root of a squared bias; where that is below zero by noise, 0. The error is how far one
/// standard error more takes it.
Json rootOfBias(const trade::CandidateResult& c) {
    const double square = std::max(0.0, c.squaredBias.value);
    const double root = std::sqrt(square);
    return {{"value", root},
            {"se", std::sqrt(square + c.squaredBias.se) - root},
            {"resolved", c.biasResolved()}};
}

Json pointJson(const trade::TradePoint& p) {
    Json j{{"samples", p.samples},     {"seconds", p.seconds}, {"relmse", p.relMse.value},
           {"relmse_se", p.relMse.se}, {"flip", nullptr},      {"flip_se", nullptr}};
    if (p.flip) j["flip"] = p.flip->value, j["flip_se"] = p.flip->se;
    return j;
}

Json candidateJson(const TradeReport& report, const trade::CandidateResult& c) {
    Json points = Json::array();
    for (const trade::TradePoint& p : c.points) points.push_back(pointJson(p));
    Json j{{"name", c.candidate.name},
           {"biased", c.model.biased},
           {"quality", nullptr},
           {"choices", c.candidate.choices},
           {"command", report.command.of(c.candidate)},
           {"paper", c.candidate.papers()},
           {"load_seconds", c.loadSeconds},
           {"denoise_seconds", c.denoiseSeconds},
           {"memory", c.bytes},
           {"seconds_per_sample", measured(c.secondsPerSample)},
           {"cpu_seconds_per_sample", measured(c.cpuSecondsPerSample)},
           {"bias", measured(c.bias)},
           {"rms_bias", rootOfBias(c)},
           {"variance", measured(c.variance)},
           {"points", std::move(points)},
           {"front", c.onFront},
           {"crop", nullptr}};
    if (!c.candidate.quality.empty()) j["quality"] = c.candidate.quality;
    if (c.crop) j["crop"] = *c.crop;
    return j;
}

/// What FLIP had become by so many samples: that of the last measured count before.
Json flipAt(const trade::CandidateResult& c, double samples) {
    Json flip;
    for (const trade::TradePoint& p : c.points)
        if (p.flip && (flip.is_null() || p.samples <= samples)) flip = p.flip->value;
    return flip;
}

Json timeJson(const trade::TradeResult& result, const trade::TradeReading& reading) {
    Json rows = Json::array();
    for (std::size_t i = 0; i < result.candidates.size(); ++i) {
        const trade::TradeModel& model = result.candidates[i].model;
        const auto error = model.errorAt(reading.target);
        if (!error) continue;
        const double samples = model.samplesIn(reading.target);
        rows.push_back({{"candidate", i},
                        {"samples", samples},
                        {"relmse", error->value},
                        {"relmse_se", error->se},
                        {"flip", flipAt(result.candidates[i], samples)}});
    }
    return {{"seconds", reading.target},
            {"rows", std::move(rows)},
            {"best", reading.winner.best},
            {"tied", reading.winner.tied}};
}

Json errorJson(const trade::TradeResult& result, const trade::TradeReading& reading) {
    Json rows = Json::array();
    for (std::size_t i = 0; i < result.candidates.size(); ++i) {
        const trade::TradeModel& model = result.candidates[i].model;
        Json row{
            {"candidate", i}, {"samples", nullptr}, {"seconds", nullptr}, {"seconds_se", nullptr}};
        if (const auto seconds = model.secondsTo(reading.target)) {
            row["samples"] = *model.samplesTo(reading.target);
            row["seconds"] = seconds->value, row["seconds_se"] = seconds->se;
        }
        rows.push_back(std::move(row));
    }
    return {{"relmse", reading.target},
            {"rows", std::move(rows)},
            {"best", reading.winner.best},
            {"tied", reading.winner.tied}};
}

Json recommendations(const TradeReport& report) {
    Json all = Json::array();
    const trade::TradeResult& result = report.result;
    for (const trade::TradeReading& r : result.equalTime) {
        const trade::CandidateResult& c = result.candidates[r.winner.recommended];
        all.push_back({{"kind", "time"},
                       {"target", r.target},
                       {"candidate", r.winner.recommended},
                       {"samples", c.model.samplesIn(r.target)},
                       {"expected_relmse", c.model.errorAt(r.target)->value},
                       {"command", report.command.ofSeconds(c.candidate, r.target)}});
    }
    for (const trade::TradeReading& r : result.equalError) {
        const trade::CandidateResult& c = result.candidates[r.winner.recommended];
        const double samples = *c.model.samplesTo(r.target);
        all.push_back({{"kind", "error"},
                       {"target", r.target},
                       {"candidate", r.winner.recommended},
                       {"samples", samples},
                       {"expected_relmse", r.target},
                       {"command", report.command.ofSamples(c.candidate, samples)}});
    }
    return all;
}

Json referenceJson(const trade::TradeReference& r) {
    Json mean = Json::array(), errors = Json::array();
    for (const trade::Measured& m : r.mean) mean.push_back(m.value), errors.push_back(m.se);
    return {{"samples", r.samples},        {"seeds", r.seeds},        {"seconds", r.seconds},
            {"relmse", r.error.value},     {"relmse_se", r.error.se}, {"mean", std::move(mean)},
            {"mean_se", std::move(errors)}};
}

}  // namespace

nlohmann::ordered_json tradeJson(const TradeReport& report, bool withPictures) {
    const trade::TradeResult& result = report.result;
    Json j{{"woodcock", {{"version", version()}}},
           {"command", report.commandLine},
           {"scene", report.scene},
           {"digest", report.digest},
           {"resolution", {result.full.width, result.full.height}},
           {"measured_resolution", {result.measured.width, result.measured.height}},
           {"threads", report.threads},
           {"budget", report.budget},
           {"seconds", result.seconds},
           {"reference", referenceJson(result.reference)}};
    Json& candidates = j["candidates"] = Json::array();
    for (const trade::CandidateResult& c : result.candidates)
        candidates.push_back(candidateJson(report, c));
    Json& front = j["front"] = Json::array();
    for (const trade::FrontPoint& p : result.front)
        front.push_back({{"seconds", p.seconds},
                         {"relmse", p.error},
                         {"candidate", p.candidate},
                         {"samples", result.candidates[p.candidate].model.samplesIn(p.seconds)}});
    Json& times = j["equal_time"] = Json::array();
    for (const trade::TradeReading& r : result.equalTime) times.push_back(timeJson(result, r));
    Json& errors = j["equal_error"] = Json::array();
    for (const trade::TradeReading& r : result.equalError) errors.push_back(errorJson(result, r));
    j["recommendations"] = recommendations(report);
    Json& crops = j["crops"] = Json::array();
    for (std::size_t i = 0; i < result.crops.size(); ++i) {
        Json crop{{"title", result.crops[i].title}};
        if (withPictures) crop["png"] = report.pictures.at(i);
        crops.push_back(std::move(crop));
    }
    j["notes"] = result.notes;
    return j;
}

}  // namespace woodcock::tool
