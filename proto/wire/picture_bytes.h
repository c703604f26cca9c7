// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <string_view>

#include <absl/status/statusor.h>

#include "fabric/image.h"

/// Pictures between processes: a header that describes one, and its pixels in chunks.
namespace eyrie::wire {

class BandDecoder;
class BandEncoder;

/// What the bytes of the chunks are.
enum class PixelEncoding {
    Raw,         ///< colour, then depth, as they lie in memory
    ActiveRuns,  ///< bands (active_run.h)
};

/// What takes the least time to or from `address`, as measured
/// (docs/decisions/0039-active-runs.md): raw for colour alone over a Unix socket, else active runs.
PixelEncoding encodingFor(const std::string& address, bool hasDepth);

/// Cuts a picture's bytes into chunks.
class PictureWriter {
public:
    /// `image` outlives the writer.
    PictureWriter(const fabric::Image& image, PixelEncoding encoding);
    ~PictureWriter();
    PictureWriter(PictureWriter&&) noexcept;

    bool isDone() const;

    /// Replaces `chunk` with the next one: at most kChunkBytes, of bands kBandOverheadBytes more.
    /// Precondition: not done.
    void next(std::string& chunk);

private:
    const fabric::Image* image_;
    std::unique_ptr<BandEncoder> bands_;  ///< null: raw
    std::size_t sent_ = 0;                ///< raw bytes
};

/// Puts a picture together from its chunks, which are untrusted: nothing but its pixels is written.
class PictureReader {
public:
    /// `image` outlives the reader, and has its area and all its pixels, of any value.
    PictureReader(fabric::Image& image, PixelEncoding encoding);
    ~PictureReader();
    PictureReader(PictureReader&&) noexcept;

    /// DataLoss, saying what was found, for bytes that do not continue the picture.
    absl::Status take(std::string_view chunk);

    /// DataLoss when there was less than the picture.
    absl::Status finish() const;

private:
    absl::Status takeRaw(std::string_view bytes);

    fabric::Image* image_;
    std::unique_ptr<BandDecoder> bands_;  ///< null: raw
    std::size_t received_ = 0;            ///< raw bytes
};

}  // namespace eyrie::wire
