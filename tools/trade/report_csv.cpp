// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include "tools/trade/report.h"

namespace woodcock::tool {

namespace {

/// As RFC 4180 has it.
std::string field(const std::string& text) {
    if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
    std::string quoted = "\"";
    for (const char c : text) quoted += c == '"' ? "\"\"" : std::string(1, c);
    return quoted + "\"";
}

}  // namespace

std::string tradeCsv(const TradeReport& report) {
    std::string text =
        "name,biased,samples,seconds,relmse,relmse_se,flip,flip_se,seconds_per_sample,"
        "seconds_per_sample_se,variance,variance_se,bias,bias_se,squared_bias,squared_bias_se,"
        "memory,load_seconds,command\n";
    for (const trade::CandidateResult& c : report.result.candidates)
        for (const trade::TradePoint& p : c.points) {
            text += fmt::format("{},{},{},{:.6g},{:.6g},{:.6g},", field(c.candidate.name),
                                c.model.biased, p.samples, p.seconds, p.relMse.value, p.relMse.se);
            text += p.flip ? fmt::format("{:.6g},{:.6g},", p.flip->value, p.flip->se) : ",,";
            for (const trade::Measured& m : {c.secondsPerSample, c.variance, c.bias, c.squaredBias})
                text += fmt::format("{:.6g},{:.6g},", m.value, m.se);
            text += fmt::format("{},{:.6g},{}\n", c.bytes, c.loadSeconds,
                                field(report.command.of(c.candidate)));
        }
    return text;
}

}  // namespace woodcock::tool
