// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <sstream>
#include <string>

#include <spdlog/sinks/ostream_sink.h>

#include "fabric/log.h"

namespace eyrie::test {

/// Catches what is logged while it lives. Make and end it, and ask it, while nobody else logs.
class CapturedLog {
public:
    CapturedLog() : before_(spdlog::default_logger()) {
        spdlog::set_default_logger(std::make_shared<spdlog::logger>(
            "test", std::make_shared<spdlog::sinks::ostream_sink_mt>(text_)));
    }
    ~CapturedLog() { spdlog::set_default_logger(before_); }
    CapturedLog(const CapturedLog&) = delete;
    CapturedLog& operator=(const CapturedLog&) = delete;

    std::string text() const { return text_.str(); }
    int count(const std::string& part) const {
        const std::string all = text();
        int times = 0;
        for (auto at = all.find(part); at != std::string::npos; at = all.find(part, at + 1))
            ++times;
        return times;
    }
    int lines() const { return count("\n"); }

private:
    std::ostringstream text_;
    std::shared_ptr<spdlog::logger> before_;
};

}  // namespace eyrie::test
