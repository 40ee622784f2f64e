// SPDX-License-Identifier: Apache-2.0
#include "log.h"

#include <fmt/core.h>
#include <spdlog/sinks/base_sink.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <mutex>
#include <nlohmann/json.hpp>

namespace woodcock::tool {

namespace {

class JsonSink : public spdlog::sinks::base_sink<std::mutex> {
    void sink_it_(const spdlog::details::log_msg& message) override {
        const nlohmann::ordered_json line{
            {"event", "log"},
            {"level",
             fmt::to_string(fmt::string_view(spdlog::level::to_string_view(message.level)))},
            {"message", fmt::to_string(fmt::string_view(message.payload))}};
        fmt::print(stderr, "{}\n",
                   line.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
    }
    void flush_() override { std::fflush(stderr); }
};

}  // namespace

void setUpLog(LogStyle style, const std::string& level) {
    spdlog::sink_ptr sink;
    if (style == LogStyle::Json)
        sink = std::make_shared<JsonSink>();
    else
        sink = std::make_shared<spdlog::sinks::stderr_color_sink_mt>();
    auto logger = std::make_shared<spdlog::logger>("woodcock", sink);
    logger->set_level(spdlog::level::from_str(level));
    if (style == LogStyle::Text) logger->set_pattern("%^%l%$: %v");
    spdlog::set_default_logger(logger);
}

}  // namespace woodcock::tool
