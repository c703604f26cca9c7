// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <cstdio>
#include <string>
#include <string_view>

#include "renderer/import/progress.h"

namespace eyrie::cli {

/// Shows how far long work is, on standard error: a bar with rate and time left on a terminal, one
/// line a stage otherwise, JSON for programs, entries of a JSON log, nothing when quiet. Used by
/// one thread at a time.
class ProgressBar {
public:
    enum class Style { Quiet, Lines, Bar, Json, Log };
    using Clock = std::chrono::steady_clock;

    /// Bar on a terminal, otherwise Lines; Log where that is of JSON, Quiet if asked for.
    static Style styleFor(bool quiet);

    /// `title` says what is worked on; `amount` of `unit` ("MB", "M samples") is the whole of each
    /// stage, 0 for none to speak of.
    ProgressBar(std::string title, double amount, std::string unit, Style style,
                std::FILE* out = stderr);
    /// Leaves the terminal on a fresh line.
    ~ProgressBar();
    ProgressBar(const ProgressBar&) = delete;
    ProgressBar& operator=(const ProgressBar&) = delete;

    void show(std::string_view stage, double fraction, Clock::time_point now);
    /// For ImportControl. Valid while this object lives.
    import::Progress callback();

private:
    void draw(double fraction, Clock::time_point now);
    void tell(double fraction, Clock::time_point now);

    const std::string title_;
    const double amount_;
    const std::string unit_;
    const Style style_;
    std::FILE* const out_;
    std::string stage_;
    Clock::time_point stageBegin_{};
    Clock::time_point lastDrawn_{};
    bool hasEnded_ = false;  ///< the end of the stage has been shown
    bool lineOpen_ = false;
};

/// The bar's line: "title: reading [#####     ]  50 %, 12.3 MB/s, 4 s left".
std::string progressLine(std::string_view title, std::string_view stage, double fraction,
                         double seconds, double amount, std::string_view unit);

}  // namespace eyrie::cli
