// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "tools/trade/report.h"
#include "woodcock/base/parse.h"

namespace woodcock::tool {

namespace {

constexpr std::size_t nameWidth = 27, lineWidth = 100;

/// Letters of UTF-8 count once.
std::string padded(std::string text, std::size_t width) {
    std::size_t letters = 0, bytes = 0;
    for (; bytes < text.size(); ++bytes)
        if ((text[bytes] & 0xc0) != 0x80 && ++letters > width) break;
    if (letters > width) return text.substr(0, bytes);
    return text + std::string(width - letters, ' ');
}

std::string nameOf(const trade::TradeResult& result, std::size_t i) {
    return result.candidates[i].candidate.name;
}

std::string megabytes(std::size_t bytes) {
    return fmt::format("{:.1f}", static_cast<double>(bytes) / 1e6);
}

/// "1.23e-02 +-4%": relative, as columns are narrow.
std::string withError(const trade::Measured& m) {
    if (!(m.value > 0)) return fmt::format("{:.2e}", m.value);
    return fmt::format("{:.2e} +-{:.0f}%", m.value, std::min(999.0, 100 * m.se / m.value));
}

std::string candidateLine(const trade::CandidateResult& c) {
    const double bias = std::sqrt(std::max(0.0, c.squaredBias.value));
    const trade::TradePoint& last = c.points.back();
    return fmt::format(
        "{} {:>9.3g} {:>6.1f} {:>14} {:>7.2f} {:>5.2f} {:>8.1e} {:>6} {:>6}\n",
        padded((c.onFront ? "* " : "  ") + c.candidate.name, nameWidth), c.secondsPerSample.value,
        100 * c.secondsPerSample.se / c.secondsPerSample.value, withError(c.variance),
        100 * c.bias.value, 100 * c.bias.se, c.model.biased && c.biasResolved() ? bias : 0.0,
        last.flip ? fmt::format("{:.3f}", last.flip->value) : "-", megabytes(c.bytes));
}

std::string candidatesText(const trade::TradeResult& result) {
    std::string text = fmt::format("\n{} {:>9} {:>6} {:>14} {:>7} {:>5} {:>8} {:>6} {:>6}\n",
                                   padded("  candidate", nameWidth), "s/sample", "+-%", "variance",
                                   "bias %", "+-", "rms bias", "FLIP", "MB");
    for (const trade::CandidateResult& c : result.candidates) text += candidateLine(c);
    return text +
           "  * has the least error at some time. variance: of one sample, relative; rms bias: per "
           "pixel,\n  relative, 0 where noise explains it; relMSE = variance / samples + (rms "
           "bias)^2\n";
}

/// As many of those that are tied with it as a line has room for.
std::string tiedText(const trade::TradeResult& result, const std::vector<std::size_t>& tied,
                     std::size_t room) {
    std::string text;
    for (std::size_t i = 0; i < tied.size(); ++i) {
        const std::size_t more = tied.size() - i;
        const std::string next = (i ? ", " : "tied: ") + nameOf(result, tied[i]);
        if (text.size() + next.size() + 10 > room)
            return fmt::format("{}{}{}", text, i ? " +" : "tied: ", more);
        text += next;
    }
    return text;
}

/// Broken between words, what follows the first line indented.
std::string wrapped(const std::string& text) {
    std::istringstream words(text);
    std::string lines, line;
    for (std::string word; words >> word;) {
        if (!line.empty() && line.size() + 1 + word.size() > lineWidth) {
            lines += line + "\n";
            line = "   ";
        }
        line += (line.empty() ? "" : " ") + word;
    }
    return lines + line + "\n";
}

std::string readingLine(const std::string& target, const trade::TradeResult& result,
                        const trade::TradeReading& reading, double samples,
                        const trade::Measured& number) {
    const std::string line = fmt::format(
        "{:>10}  {} {:>9.0f} {:>14}  ", target,
        padded(nameOf(result, reading.winner.recommended), nameWidth), samples, withError(number));
    std::vector<std::size_t> others = reading.winner.tied;
    std::replace(others.begin(), others.end(), reading.winner.recommended, reading.winner.best);
    return line + tiedText(result, others, lineWidth - line.size()) + "\n";
}

std::string readingsText(const TradeReport& report) {
    const trade::TradeResult& result = report.result;
    std::string text;
    if (!result.equalTime.empty())
        text += fmt::format("\n{:>10}  {} {:>9} {:>14}\n", "in", padded("take", nameWidth),
                            "samples", "relMSE");
    for (const trade::TradeReading& r : result.equalTime) {
        const trade::TradeModel& model = result.candidates[r.winner.recommended].model;
        text += readingLine(formatDuration(r.target), result, r, model.samplesIn(r.target),
                            *model.errorAt(r.target));
    }
    if (!result.equalError.empty())
        text += fmt::format("\n{:>10}  {} {:>9} {:>14}\n", "to relMSE", padded("take", nameWidth),
                            "samples", "seconds");
    for (const trade::TradeReading& r : result.equalError) {
        const trade::TradeModel& model = result.candidates[r.winner.recommended].model;
        text += readingLine(fmt::format("{:.0e}", r.target), result, r, *model.samplesTo(r.target),
                            *model.secondsTo(r.target));
    }
    return text;
}

}  // namespace

std::string tradeText(const TradeReport& report) {
    const trade::TradeResult& result = report.result;
    const trade::TradeReference& r = result.reference;
    std::string text = fmt::format(
        "{}: {} x {} pixels, measured at {} x {} in {}\nreference: {} samples per pixel in {} "
        "seeds, relMSE {:.1e} +- {:.0e}\n",
        report.scene, result.full.width, result.full.height, result.measured.width,
        result.measured.height, formatDuration(result.seconds), r.samples, r.seeds, r.error.value,
        r.error.se);
    text += candidatesText(result) + readingsText(report);
    for (const std::string& note : result.notes) text += wrapped("note: " + note);
    text += "\n";
    for (const trade::TradeReading& reading : result.equalTime) {
        const trade::CandidateResult& c = result.candidates[reading.winner.recommended];
        text +=
            fmt::format("{}: {}\n", formatDuration(reading.target),
                        report.command.ofSeconds(c.candidate, reading.target - c.denoiseSeconds));
    }
    return text;
}

}  // namespace woodcock::tool
