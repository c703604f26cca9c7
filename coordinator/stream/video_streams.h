// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>

#include <absl/status/statusor.h>

#include "coordinator/stream/pacer.h"
#include "coordinator/stream/viewer_messages.h"
#include "fabric/image.h"
#include "video/module.h"

namespace eyrie::stream {

/// A session's streams of H.264, one a level of pictures, each for all viewers of its class.
///
/// A picture of a stream can be shown by who has the one before it. Who has not, because it was not
/// ready for one or has just come, is given a key, and with it all others of the stream; but only
/// when the last one is a second old, for keys are as large as JPEGs. Until then it gets JPEGs: so
/// nobody waits for another, and nobody is shown a picture that lacks what it is made from.
///
/// Guarded by the session's lock, but for encode(), which is its encoder thread's.
class VideoStreams {
public:
    /// Null: there is no video.
    explicit VideoStreams(const video::Module* module) : module_(module) {}

    /// Pictures of that size can be coded, and nothing has failed so far.
    bool canCode(int width, int height) const;

    /// Whether who was last given `place` may be given the session's picture `number` in the stream
    /// of `level`.
    bool mayFollow(int level, const std::optional<VideoPlace>& place, std::uint64_t number,
                   Clock::time_point now) const;

    /// Whether who was last given `place` lacks the one before the stream's next.
    bool needsKey(int level, const std::optional<VideoPlace>& place) const;

    struct Coded {
        video::StreamPicture picture;
        VideoPlace place;
    };
    /// The next picture of a stream; a key where `asKey` or `image` has another size than the one
    /// before. Nothing where a key is wanted too soon after the last one, and after giveUp().
    /// Errors: the module's.
    absl::StatusOr<std::optional<Coded>> encode(int level, const fabric::Image& image,
                                                int rateFactor, bool asKey, Clock::time_point now);

    /// What encode() gave is that of the session's picture `number`.
    void coded(int level, const VideoPlace& place, std::uint64_t number, Clock::time_point now);

    /// The module has failed: from now on there is no video.
    void giveUp() { module_ = nullptr; }

private:
    /// Of the encoder thread.
    struct Encoding {
        std::unique_ptr<video::StreamEncoder> encoder;
        int width = 0;
        int height = 0;
        VideoPlace last;
        std::optional<Clock::time_point> keyAt;
    };
    struct Stream {
        VideoPlace last;
        std::uint64_t number = 0;  ///< of the session's picture that it shows
        std::optional<Clock::time_point> keyAt;
    };

    const video::Module* module_;
    std::map<int, Stream> streams_;
    std::map<int, Encoding> encodings_;
    std::uint64_t lastStream_ = 0;
};

}  // namespace eyrie::stream
