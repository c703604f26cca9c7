// SPDX-License-Identifier: Apache-2.0
#include "cli/log.h"

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <string_view>
#include <utility>

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <spdlog/formatter.h>
#include <spdlog/pattern_formatter.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/sinks/stdout_sinks.h>
#include <unistd.h>

#include "cli/json_object.h"
#include "fabric/log.h"
#include "fabric/shown_name.h"

namespace eyrie::cli {
namespace {

LogOptions current;

std::string shownMessage(const spdlog::details::log_msg& entry) {
    return fabric::shownName({entry.payload.data(), entry.payload.size()});
}

/// %v of text for people.
class ShownMessage final : public spdlog::custom_flag_formatter {
public:
    void format(const spdlog::details::log_msg& entry, const std::tm&,
                spdlog::memory_buf_t& line) override {
        const std::string message = shownMessage(entry);
        line.append(message.data(), message.data() + message.size());
    }

    std::unique_ptr<spdlog::custom_flag_formatter> clone() const override {
        return std::make_unique<ShownMessage>();
    }
};

std::unique_ptr<spdlog::formatter> textLines() {
    auto lines = std::make_unique<spdlog::pattern_formatter>();
    lines->add_flag<ShownMessage>('v').set_pattern("%H:%M:%S.%e %^%l%$ %v");
    return lines;
}

class JsonLines final : public spdlog::formatter {
public:
    explicit JsonLines(std::string command) : command_(std::move(command)) {}

    void format(const spdlog::details::log_msg& entry, spdlog::memory_buf_t& line) override {
        const auto seconds = std::chrono::floor<std::chrono::seconds>(entry.time);
        const auto micro =
            std::chrono::duration_cast<std::chrono::microseconds>(entry.time - seconds);
        const auto level = spdlog::level::to_string_view(entry.level);
        JsonObject json;
        json.text("time", fmt::format("{:%Y-%m-%dT%H:%M:%S}.{:06}Z",
                                      fmt::gmtime(std::chrono::system_clock::to_time_t(seconds)),
                                      micro.count()))
            .text("level", std::string_view(level.data(), level.size()))
            .text("command", command_)
            .count("process", static_cast<std::uint64_t>(getpid()))
            .count("thread", entry.thread_id)
            .text("message", shownMessage(entry));
        const std::string text = json.str() + "\n";
        line.append(text.data(), text.data() + text.size());
    }

    std::unique_ptr<spdlog::formatter> clone() const override {
        return std::make_unique<JsonLines>(command_);
    }

private:
    const std::string command_;
};

/// Past the level that a command leaves to its coordinator and renderers, not past --log-level.
void addEntry(std::string_view line, spdlog::level::level_enum level) {
    if (!current.level.empty() && level < spdlog::level::from_str(current.level))
        return;
    const spdlog::logger& logger = *spdlog::default_logger();
    const spdlog::details::log_msg entry(logger.name(), level, {line.data(), line.size()});
    for (const auto& sink : logger.sinks()) sink->log(entry);
}

/// fmt::print would throw where the terminal is gone, in the midst of what is to end in order.
void toStandardError(const std::string& text) { std::fputs(text.c_str(), stderr); }

void tellLines(std::string_view lines, spdlog::level::level_enum level) {
    while (!lines.empty()) {
        const std::string_view line = lines.substr(0, lines.find('\n'));
        lines.remove_prefix(std::min(line.size() + 1, lines.size()));
        if (current.isJson)
            addEntry(line, level);
        else
            toStandardError(fabric::shownName(line) + "\n");
    }
}

}  // namespace

void startLog(const LogOptions& options) {
    current = options;
    spdlog::drop("eyrie");
    auto logger =
        options.isJson ? spdlog::stderr_logger_mt("eyrie") : spdlog::stderr_color_mt("eyrie");
    if (options.isJson)
        logger->set_formatter(std::make_unique<JsonLines>(options.command));
    else
        logger->set_formatter(textLines());
    spdlog::set_default_logger(std::move(logger));
    spdlog::set_level(options.level.empty() ? spdlog::level::info
                                            : spdlog::level::from_str(options.level));
}

void quietLog(const std::string& level) {
    if (current.level.empty())
        spdlog::set_level(spdlog::level::from_str(level));
}

std::vector<std::string> logArguments() {
    std::vector<std::string> arguments;
    if (current.isJson)
        arguments.insert(arguments.end(), {"--log-format", "json"});
    if (!current.level.empty())
        arguments.insert(arguments.end(), {"--log-level", current.level});
    return arguments;
}

bool logsJson() { return current.isJson; }

void tell(std::string_view lines) { tellLines(lines, spdlog::level::info); }

void tellWarnings(std::string_view lines) { tellLines(lines, spdlog::level::warn); }

void tellErrors(std::string_view lines) { tellLines(lines, spdlog::level::err); }

void logFailure(const std::string& message) {
    if (current.isJson)
        spdlog::error("{}", message);
    else
        toStandardError("eyrie: " + fabric::shownName(message) + "\n");
}

}  // namespace eyrie::cli
