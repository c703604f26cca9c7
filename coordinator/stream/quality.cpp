// SPDX-License-Identifier: Apache-2.0
#include "coordinator/stream/quality.h"

#include <array>

namespace eyrie::stream {
namespace {

using std::chrono::milliseconds;

struct Step {
    Level level;
    double size;        ///< of what the best level takes; rendered terrain and scans, 1280x720
    milliseconds time;  ///< that a frame may have the link for
};

constexpr std::array<Step, 9> kSteps = {{
    {{1, 75}, 1.00, milliseconds(14)},
    {{1, 60}, 0.80, milliseconds(12)},
    {{1, 50}, 0.72, milliseconds(18)},
    {{1, 40}, 0.64, milliseconds(22)},
    {{0.75, 60}, 0.50, milliseconds(30)},
    {{0.75, 40}, 0.40, milliseconds(36)},
    {{0.5, 60}, 0.26, milliseconds(45)},
    {{0.5, 40}, 0.20, milliseconds(45)},
    {{0.5, 20}, 0.14, milliseconds(45)},
}};
constexpr int kWorst = static_cast<int>(kSteps.size()) - 1;

const Step& step(int index) { return kSteps[static_cast<std::size_t>(index)]; }

/// A frame of so few bytes is not made smaller: how long it takes says more of threads that wait
/// for their turn than of the link.
constexpr double kSmallBytes = 8 * 1024;

/// Of the time allowed, before a better level is taken, and no sooner than after this.
constexpr double kRoomToSpare = 0.8;
constexpr milliseconds kPatience{300};

/// How much a new frame tells of those to come.
constexpr double kNews = 0.4;

}  // namespace

int QualityControl::levelCount() { return kWorst + 1; }

const Level& QualityControl::level(int index) { return step(index).level; }

void QualityControl::adapt(std::optional<double> bytesPerSecond, double pixels,
                           Clock::time_point now) {
    if (!bytesPerSecond || !bytesPerPixel_)
        return;
    const double bytes = *bytesPerPixel_ * pixels;
    // Of the time that the level may take, the share that it would.
    const auto load = [&](int index) {
        const double seconds = std::chrono::duration<double>(step(index).time).count();
        const double taken = bytes * step(index).size;
        return taken <= kSmallBytes ? 0 : taken / (*bytesPerSecond * seconds);
    };
    const int before = index_;
    while (index_ < kWorst && load(index_) > 1) ++index_;
    const bool mayRise = !changedAt_ || now >= *changedAt_ + kPatience;
    if (index_ == before && index_ > 0 && mayRise && load(index_ - 1) < kRoomToSpare)
        --index_;
    if (index_ != before)
        changedAt_ = now;
}

void QualityControl::encoded(int index, std::size_t bytes, double pixels) {
    const double sample = static_cast<double>(bytes) / (step(index).size * pixels);
    bytesPerPixel_ = bytesPerPixel_ ? *bytesPerPixel_ + kNews * (sample - *bytesPerPixel_) : sample;
}

}  // namespace eyrie::stream
