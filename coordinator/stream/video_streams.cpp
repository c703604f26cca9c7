// SPDX-License-Identifier: Apache-2.0
#include "coordinator/stream/video_streams.h"

#include <algorithm>
#include <utility>

#include "fabric/status.h"

namespace eyrie::stream {
namespace {

constexpr std::chrono::milliseconds kBetweenKeys{1000};
constexpr int kLeastSide = 16;

bool mayBeKey(const std::optional<Clock::time_point>& lastKey, Clock::time_point now) {
    return !lastKey || now >= *lastKey + kBetweenKeys;
}

/// Whether `next` is the picture after `place`.
bool follows(const VideoPlace& next, const std::optional<VideoPlace>& place) {
    return place && place->stream == next.stream && place->picture + 1 == next.picture;
}

}  // namespace

bool VideoStreams::canCode(int width, int height) const {
    return module_ != nullptr && std::min(width, height) >= 2 * kLeastSide &&
           std::int64_t{width} * height <= video::kMostPixels;
}

bool VideoStreams::mayFollow(int level, const std::optional<VideoPlace>& place,
                             std::uint64_t number, Clock::time_point now) const {
    const auto known = streams_.find(level);
    if (known == streams_.end())
        return true;
    const Stream& stream = known->second;
    if (stream.number == number)
        return stream.last.isKey || follows(stream.last, place);
    return !needsKey(level, place) || mayBeKey(stream.keyAt, now);
}

bool VideoStreams::needsKey(int level, const std::optional<VideoPlace>& place) const {
    const auto known = streams_.find(level);
    return known == streams_.end() || !place || place->stream != known->second.last.stream ||
           place->picture != known->second.last.picture;
}

absl::StatusOr<std::optional<VideoStreams::Coded>> VideoStreams::encode(int level,
                                                                        const fabric::Image& image,
                                                                        int rateFactor, bool asKey,
                                                                        Clock::time_point now) {
    Encoding& one = encodings_[level];
    const bool isOther = one.width != image.area.width || one.height != image.area.height;
    if (module_ == nullptr || ((asKey || isOther) && !mayBeKey(one.keyAt, now)))
        return std::nullopt;
    if (isOther) {
        one = {nullptr, image.area.width, image.area.height, {++lastStream_, 0, false}, {}};
        ASSIGN_OR_RETURN(one.encoder, module_->makeStream({one.width, one.height, rateFactor}));
    }
    Coded coded;
    ASSIGN_OR_RETURN(coded.picture, one.encoder->encode(image, asKey));
    one.last = {one.last.stream, one.last.picture + 1, coded.picture.isKey};
    if (coded.picture.isKey)
        one.keyAt = now;
    coded.place = one.last;
    return coded;
}

void VideoStreams::coded(int level, const VideoPlace& place, std::uint64_t number,
                         Clock::time_point now) {
    Stream& stream = streams_[level];
    stream.last = place;
    stream.number = number;
    if (place.isKey)
        stream.keyAt = now;
}

}  // namespace eyrie::stream
