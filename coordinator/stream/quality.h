// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <optional>

#include "coordinator/stream/pacer.h"

namespace eyrie::stream {

enum class Codec { Jpeg, H264 };

/// How a moving picture is made: of which share of the sides asked for, and as which JPEG, or by
/// which rate factor (x264's crf) in a stream of H.264. Its chroma is always halved: whole, it
/// takes a quarter more bytes where nobody sees it.
struct Level {
    double scale = 1;
    int quality = 75;
    int rateFactor = 20;
};

/// Chooses levels so that a frame has the link for about 14 ms, and up to 45 ms where that would
/// cost too much of the picture: worse levels may take longer, and the best whose time is kept is
/// taken. Worse ones at once, better ones one by one and only with room to spare, or the picture
/// would flicker. What a level takes is told from the frames before.
///
/// Where H.264 can be shown it is taken on links that have carried less than 20 Mbit/s for half a
/// second, until they have carried 30 for two: for no worse a picture than the best JPEG it takes a
/// quarter of its bytes and over twice its processor time (bench/codecs). Its levels are one a
/// scale, since each is a stream. Not thread-safe.
class QualityControl {
public:
    QualityControl() = default;

    /// Chooses the level of the next frame, of a view of `pixels`, on a link that carries so much;
    /// absent: not known. `canShowVideo`: H.264 may be chosen.
    void adapt(std::optional<double> bytesPerSecond, double pixels, Clock::time_point now,
               bool canShowVideo = false);

    /// A frame of a view of `pixels` at the level number `index` took `bytes`.
    void encoded(int index, std::size_t bytes, double pixels, Codec as = Codec::Jpeg);

    Codec codec() const { return codec_; }
    int index() const { return index_; }  ///< of codec()'s; 0 is the best
    /// For a picture that is to be a JPEG although codec() is another.
    int jpegIndex() const { return codec_ == Codec::Jpeg ? index_ : jpegIndex_; }

    static int levelCount();
    static const Level& level(int index);
    /// The level whose stream has the scale of `index`.
    static int streamLevel(int index);

private:
    void chooseCodec(double bytesPerSecond, Clock::time_point now, bool canShowVideo);
    void take(Codec codec);
    double load(int index, Codec as, double bytesPerSecond, double pixels) const;

    Codec codec_ = Codec::Jpeg;
    int index_ = 0;
    int jpegIndex_ = 0;
    /// As the best JPEG would take, told from frames of each codec; of none yet: from the other's.
    std::array<std::optional<double>, 2> bytesPerPixel_;
    std::optional<Clock::time_point> changedAt_;
    std::optional<Clock::time_point> otherSince_;  ///< the link has called for the other codec
};

}  // namespace eyrie::stream
