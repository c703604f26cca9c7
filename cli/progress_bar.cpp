// SPDX-License-Identifier: Apache-2.0
#include "cli/progress_bar.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <unistd.h>

#include "cli/json_object.h"
#include "cli/log.h"

namespace eyrie::cli {
namespace {

constexpr int kBarWidth = 24;
constexpr std::chrono::milliseconds kRedrawInterval{100};
/// Before that, a rate is a guess.
constexpr double kSettledSeconds = 0.3;

/// fmt::print would throw where the terminal is gone, in the midst of what is to end in order.
void write(std::FILE* out, const std::string& text) {
    std::fputs(text.c_str(), out);
    std::fflush(out);
}

}  // namespace

std::string progressLine(std::string_view title, std::string_view stage, double fraction,
                         double seconds, double amount, std::string_view unit) {
    const int filled = static_cast<int>(std::lround(fraction * kBarWidth));
    std::string line = fmt::format("{}: {} [{:#<{}}{: <{}}] {:3.0f} %", title, stage, "", filled,
                                   "", kBarWidth - filled, fraction * 100);
    if (seconds < kSettledSeconds || fraction <= 0)
        return line;
    if (amount > 0)
        line += fmt::format(", {:.1f} {}/s", amount * fraction / seconds, unit);
    return line + fmt::format(", {:.0f} s left", std::ceil(seconds * (1 - fraction) / fraction));
}

ProgressBar::Style ProgressBar::styleFor(bool quiet) {
    if (quiet)
        return Style::Quiet;
    if (logsJson())
        return Style::Log;
    return isatty(STDERR_FILENO) != 0 ? Style::Bar : Style::Lines;
}

ProgressBar::ProgressBar(std::string title, double amount, std::string unit, Style style,
                         std::FILE* out)
    : title_(std::move(title)), amount_(amount), unit_(std::move(unit)), style_(style), out_(out) {}

ProgressBar::~ProgressBar() {
    if (lineOpen_)
        write(out_, "\r\x1b[K");
}

void ProgressBar::show(std::string_view stage, double fraction, Clock::time_point now) {
    if (style_ == Style::Quiet)
        return;
    const bool newStage = stage != stage_;
    if (newStage) {
        stage_ = stage;
        stageBegin_ = now;
        hasEnded_ = false;
        if (style_ == Style::Lines)
            write(out_, fmt::format("{}: {}\n", title_, stage));
        if (style_ == Style::Log)
            cli::tell(fmt::format("{}: {}", title_, stage));
    }
    const bool ends = fraction >= 1 && !hasEnded_;
    hasEnded_ = hasEnded_ || ends;
    if (!newStage && !ends && now - lastDrawn_ < kRedrawInterval)
        return;
    if (style_ == Style::Bar)
        draw(std::clamp(fraction, 0.0, 1.0), now);
    if (style_ == Style::Json)
        tell(std::clamp(fraction, 0.0, 1.0), now);
}

void ProgressBar::draw(double fraction, Clock::time_point now) {
    const double seconds = std::chrono::duration<double>(now - stageBegin_).count();
    write(out_, fmt::format("\r{}\x1b[K",
                            progressLine(title_, stage_, fraction, seconds, amount_, unit_)));
    lastDrawn_ = now;
    lineOpen_ = true;
}

void ProgressBar::tell(double fraction, Clock::time_point now) {
    write(out_, JsonObject().text("stage", stage_).number("fraction", fraction).str() + "\n");
    lastDrawn_ = now;
}

auto ProgressBar::callback() -> import::Progress {
    return [this](std::string_view stage, double fraction) { show(stage, fraction, Clock::now()); };
}

}  // namespace eyrie::cli
