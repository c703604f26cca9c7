// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <string_view>

#include <absl/status/status.h>

#include "fabric/image.h"

/// A lossless form of pictures that is written and read about as fast as memory: only pixels that
/// are drawn (runs of them, row by row), each as its difference from what its neighbours let
/// expect, in as few bits as sixteen of them need. Any bits come back as they were, of colour and
/// of depth.
///
/// A picture travels in bands, from the bottom up: whole rows, of at most one chunk of pixels
/// (transport.h), each readable by itself. docs/decisions/0039-active-runs.md says what was
/// measured, active_run_format.h what the bytes are.
namespace eyrie::wire {

/// Cuts a picture into bands.
class BandEncoder {
public:
    /// `image` outlives the encoder; its sides are kMaxViewPixels at most.
    explicit BandEncoder(const fabric::Image& image);
    ~BandEncoder();
    BandEncoder(const BandEncoder&) = delete;
    BandEncoder& operator=(const BandEncoder&) = delete;

    bool isDone() const;

    /// Replaces `bytes` with the next band: at most kBandOverheadBytes more than its pixels have.
    /// Precondition: not done.
    void next(std::string& bytes);

private:
    class Impl;
    std::unique_ptr<Impl> impl_;
};

inline constexpr std::size_t kBandOverheadBytes = 4;

/// Puts a picture together from its bands. They are untrusted bytes: whatever they hold, nothing
/// but the picture's pixels is written, and no more than a few rows allocated.
class BandDecoder {
public:
    /// `image` outlives the decoder and has its area and all its pixels, of any value; its sides
    /// are kMaxViewPixels at most.
    explicit BandDecoder(fabric::Image& image);
    ~BandDecoder();
    BandDecoder(const BandDecoder&) = delete;
    BandDecoder& operator=(const BandDecoder&) = delete;

    /// True when all rows have been read.
    bool isDone() const;

    /// DataLoss, saying what was found, where `bytes` are not the next band.
    absl::Status take(std::string_view bytes);

private:
    class Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace eyrie::wire
