// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <optional>

#include <absl/status/statusor.h>

#include "renderer/draw/tile_decoder.h"
#include "renderer/terrain/eyt_format.h"
#include "renderer/tile_decoding.h"

namespace eyrie::draw {

/// What one way of decoding pages takes, from a page's bytes to tiles that can be drawn.
struct DecodeCost {
    std::chrono::duration<double> time{0};  ///< the device's work included
    std::size_t triangles = 0;              ///< of all parts
    std::size_t tiles = 0;                  ///< that have triangles
    std::size_t bytesSent = 0;              ///< to the device; without normals

    double millionTrianglesPerSecond() const {
        return static_cast<double>(triangles) / time.count() / 1e6;
    }
};

/// Decodes `bytes` once and waits for the device. A null `decoder`: on the CPU. Errors: those of
/// Page::decode. GL thread.
absl::StatusOr<DecodeCost> measureDecode(std::span<const std::uint32_t> bytes,
                                         TileDecoder* decoder);

/// Which of the two ways a renderer takes, for all its terrains and as long as it lives. GL thread.
class DecodeChoice {
public:
    explicit DecodeChoice(TileDecoding asked) : asked_(asked) {}

    /// Null: the CPU decodes. With TileDecoding::Auto the first file that has pages to measure
    /// decides, before any frame of it is drawn: in some tens of milliseconds, on llvmpipe in up to
    /// some hundreds. Valid as long as this.
    /// Errors: FailedPrecondition, where Gpu was asked for and cannot be had.
    absl::StatusOr<TileDecoder*> decoderFor(const terrain::EytFile& file);

private:
    void measure(const terrain::EytFile& file);
    TileDecoder* chosen() { return decoder_ ? &*decoder_ : nullptr; }

    TileDecoding asked_;
    bool isChosen_ = false;
    std::optional<TileDecoder> decoder_;
};

}  // namespace eyrie::draw
