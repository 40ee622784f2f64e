// SPDX-License-Identifier: Apache-2.0
#include "tools/common/log.h"

#include <fmt/core.h>
#include <spdlog/sinks/base_sink.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <mutex>
#include <nlohmann/json.hpp>

#include "tools/common/json_text.h"
#include "tools/common/print.h"
#include "woodcock/base/printable.h"

namespace woodcock::tool {

namespace {

// What a command printed on stdout stands before what it logs later, where both end in one file.
void orderStdout() { std::fflush(stdout); }

class JsonSink : public spdlog::sinks::base_sink<std::mutex> {
    void sink_it_(const spdlog::details::log_msg& message) override {
        orderStdout();
        const nlohmann::ordered_json line{
            {"event", "log"},
            {"level",
             fmt::to_string(fmt::string_view(spdlog::level::to_string_view(message.level)))},
            {"message", fmt::to_string(fmt::string_view(message.payload))}};
        printProgress("{}\n", jsonText(line, -1));
    }
    void flush_() override {}
};

/// Names and texts of files are in messages: what could drive the terminal is spelled out, and
/// nobody reads what fills more than a screen or two.
class TextSink : public spdlog::sinks::base_sink<std::mutex> {
public:
    explicit TextSink(LogStyle style) : style_(style) {}

private:
    void sink_it_(const spdlog::details::log_msg& message) override {
        constexpr std::size_t longest = 16000, end = 2000;
        orderStdout();
        const std::string_view said(message.payload.data(), message.payload.size());
        std::string text = printableLines(said.substr(0, longest));
        if (said.size() > longest)
            text += "..." + printableLines(said.substr(std::max(longest, said.size() - end)));
        spdlog::details::log_msg shownMessage = message;
        shownMessage.payload = text;
        terminal_.log(shownMessage);
        if (style_ != LogStyle::OpenJd || message.level < spdlog::level::err) return;
        for (char& c : text)
            if (c == '\n') c = ' ';
        printData(fmt::format("openjd_fail: {}\n", text));
        orderStdout();
    }
    void flush_() override { terminal_.flush(); }
    void set_pattern_(const std::string& pattern) override { terminal_.set_pattern(pattern); }
    void set_formatter_(std::unique_ptr<spdlog::formatter> formatter) override {
        terminal_.set_formatter(std::move(formatter));
    }

    LogStyle style_;
    spdlog::sinks::stderr_color_sink_st terminal_;
};

}  // namespace

void setUpLog(LogStyle style, const std::string& level) {
    spdlog::sink_ptr sink;
    if (style == LogStyle::Json)
        sink = std::make_shared<JsonSink>();
    else
        sink = std::make_shared<TextSink>(style);
    auto logger = std::make_shared<spdlog::logger>("woodcock", sink);
    logger->set_level(spdlog::level::from_str(level));
    if (style != LogStyle::Json) logger->set_pattern("%^%l%$: %v");
    spdlog::set_default_logger(logger);
}

}  // namespace woodcock::tool
