// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <absl/status/statusor.h>

#include "fabric/image.h"

/// What Eyrie knows of video. libavcodec and what it brings are larger than Eyrie itself, so they
/// are in a module, libeyrie_h264.so, that is loaded only where somebody asks for video (load.h).
namespace eyrie::video {

/// Sides of H.264's level 5.2, which browsers decode: no picture has more pixels.
inline constexpr std::int64_t kMostPixels = std::int64_t{4096} * 2304;

struct StreamSettings {
    int width = 0;  ///< of the pictures, pixels, odd ones too
    int height = 0;
    int rateFactor = 26;  ///< x264's crf, 0 to 51: the less the better
};

/// A picture of a stream, as H.264 in Annex B's form. It is coded with even sides: of odd ones, the
/// last column and row are there twice.
struct StreamPicture {
    std::vector<std::byte> bytes;
    bool isKey = false;  ///< it needs none of those before it; any other needs all since the last
};

/// A stream of moving pictures without delay: each is coded before the next one is known. BT.709,
/// limited range. Belongs to one thread at a time.
class StreamEncoder {
public:
    virtual ~StreamEncoder() = default;

    /// The first is a key, and so is each with `asKey`. InvalidArgument: `image` has another size.
    virtual absl::StatusOr<StreamPicture> encode(const fabric::Image& image, bool asKey) = 0;
};

struct MovieSettings {
    std::string ending;  ///< "mp4", "mkv" (H.264) or "webm" (VP9)
    int width = 0;       ///< pixels, even
    int height = 0;
    int framesPerSecond = 30;
};

/// Takes bytes of a file at a place.
using MovieSink = std::function<absl::Status(std::uint64_t offset, std::span<const std::byte>)>;

/// A file of pictures, as good as they look the same. Belongs to one thread.
class Movie {
public:
    virtual ~Movie() = default;

    /// The next picture. InvalidArgument: it has another size. Errors of the sink.
    virtual absl::Status add(const fabric::Image& image) = 0;

    /// Writes what is left; nothing may be added afterwards. Errors of the sink.
    virtual absl::Status finish() = 0;
};

class Module {
public:
    virtual ~Module() = default;

    /// InvalidArgument (sides below 16 or more than kMostPixels), FailedPrecondition (the
    /// libavcodec here has no such encoder), Internal.
    virtual absl::StatusOr<std::unique_ptr<StreamEncoder>> makeStream(
        const StreamSettings& settings) const = 0;

    /// `sink` is called by the movie's functions only. Errors as of makeStream, and InvalidArgument
    /// for another ending or odd sides.
    virtual absl::StatusOr<std::unique_ptr<Movie>> makeMovie(const MovieSettings& settings,
                                                             MovieSink sink) const = 0;
};

/// The one function that the module exports, by this name and type: the module, which lives as long
/// as the process, or null where it was built for another version of Eyrie.
inline constexpr const char* kEntryName = "eyrieVideoModule";
using Entry = const Module* (*)(const char* version, std::size_t versionLength);

}  // namespace eyrie::video
