// SPDX-License-Identifier: Apache-2.0
#include "coordinator/stream/quality.h"

namespace eyrie::stream {
namespace {

using std::chrono::milliseconds;

struct Step {
    Level level;
    double size;            ///< of what the best JPEG takes; rendered terrain and scans, 1280x720
    milliseconds time;      ///< that a frame may have the link for
    double streamSize = 0;  ///< the same in a stream; 0: there is none of this level
};

constexpr std::array<Step, 9> kSteps = {{
    {{1, 75, 20}, 1.00, milliseconds(14), 0.30},
    {{1, 60}, 0.80, milliseconds(12)},
    {{1, 50}, 0.72, milliseconds(18)},
    {{1, 40}, 0.64, milliseconds(22)},
    {{0.75, 60, 22}, 0.50, milliseconds(30), 0.13},
    {{0.75, 40}, 0.40, milliseconds(36)},
    {{0.5, 60, 24}, 0.26, milliseconds(45), 0.06},
    {{0.5, 40}, 0.20, milliseconds(45)},
    {{0.5, 20}, 0.14, milliseconds(45)},
}};
constexpr int kWorst = static_cast<int>(kSteps.size()) - 1;
/// A picture of a stream may have the link for so long whatever its level: there are few of them.
constexpr milliseconds kStreamTime{36};

const Step& step(int index) { return kSteps[static_cast<std::size_t>(index)]; }

double sizeOf(int index, Codec as) {
    return as == Codec::Jpeg ? step(index).size : step(index).streamSize;
}

/// The next worse (1) or better (-1) level; `index` itself where there is none.
int beside(int index, int direction, Codec as) {
    for (int next = index + direction; next >= 0 && next <= kWorst; next += direction)
        if (sizeOf(next, as) > 0)
            return next;
    return index;
}

/// A frame of so few bytes is not made smaller: how long it takes says more of threads that wait
/// for their turn than of the link.
constexpr double kSmallBytes = 8 * 1024;

/// Of the time allowed, before a better level is taken, and no sooner than after this.
constexpr double kRoomToSpare = 0.8;
constexpr milliseconds kPatience{300};

/// Bytes a second below and above which the codecs change, and how long they are to stay there.
constexpr double kSlowLink = 20e6 / 8;
constexpr double kFastLink = 30e6 / 8;
constexpr milliseconds kSlowFor{500};
constexpr milliseconds kFastFor{2000};

/// How much a new frame tells of those to come.
constexpr double kNews = 0.4;

}  // namespace

int QualityControl::levelCount() { return kWorst + 1; }

const Level& QualityControl::level(int index) { return step(index).level; }

int QualityControl::streamLevel(int index) {
    while (step(index).streamSize == 0) --index;
    return index;
}

void QualityControl::chooseCodec(double bytesPerSecond, Clock::time_point now, bool canShowVideo) {
    if (!canShowVideo && codec_ == Codec::H264)
        return take(Codec::Jpeg);
    const bool isOther =
        codec_ == Codec::Jpeg ? bytesPerSecond < kSlowLink : bytesPerSecond > kFastLink;
    if (!canShowVideo || !isOther) {
        otherSince_.reset();
        return;
    }
    if (!otherSince_)
        otherSince_ = now;
    if (now - *otherSince_ >= (codec_ == Codec::Jpeg ? kSlowFor : kFastFor))
        take(codec_ == Codec::Jpeg ? Codec::H264 : Codec::Jpeg);
}

void QualityControl::take(Codec codec) {
    codec_ = codec;
    index_ = 0;
    otherSince_.reset();
}

double QualityControl::load(int index, Codec as, double bytesPerSecond, double pixels) const {
    const double seconds =
        std::chrono::duration<double>(as == Codec::Jpeg ? step(index).time : kStreamTime).count();
    const auto& known = bytesPerPixel_[static_cast<std::size_t>(as)];
    const auto& other = bytesPerPixel_[as == Codec::Jpeg ? 1 : 0];
    const double taken = (known ? *known : *other) * pixels * sizeOf(index, as);
    return taken <= kSmallBytes ? 0 : taken / (bytesPerSecond * seconds);
}

void QualityControl::adapt(std::optional<double> bytesPerSecond, double pixels,
                           Clock::time_point now, bool canShowVideo) {
    if (!bytesPerSecond || (!bytesPerPixel_[0] && !bytesPerPixel_[1]))
        return;
    const Codec codecBefore = codec_;
    chooseCodec(*bytesPerSecond, now, canShowVideo);
    // Of the time that the level may take, the share that it would.
    const auto loadOf = [&](int index) { return load(index, codec_, *bytesPerSecond, pixels); };
    const auto worse = [&](int index) { return beside(index, 1, codec_); };
    const int before = index_;
    while (worse(index_) != index_ && loadOf(index_) > 1) index_ = worse(index_);
    const int better = beside(index_, -1, codec_);
    const bool mayRise = !changedAt_ || now >= *changedAt_ + kPatience;
    if (index_ == before && better != index_ && mayRise && loadOf(better) < kRoomToSpare)
        index_ = better;
    if (index_ != before || codec_ != codecBefore)
        changedAt_ = now;
    jpegIndex_ = 0;
    while (jpegIndex_ < kWorst && load(jpegIndex_, Codec::Jpeg, *bytesPerSecond, pixels) > 1)
        ++jpegIndex_;
}

void QualityControl::encoded(int index, std::size_t bytes, double pixels, Codec as) {
    const double sample = static_cast<double>(bytes) / (sizeOf(index, as) * pixels);
    auto& known = bytesPerPixel_[static_cast<std::size_t>(as)];
    known = known ? *known + kNews * (sample - *known) : sample;
}

}  // namespace eyrie::stream
