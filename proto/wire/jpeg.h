// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <absl/status/statusor.h>

#include "fabric/image.h"

namespace eyrie::wire {

/// How finely colour (as opposed to brightness) is kept.
enum class ChromaSubsampling {
    Half,  ///< 4:2:0, half the resolution each way: for moving pictures
    None,  ///< 4:4:4: for still pictures
};

/// The colour of `image` as a baseline JPEG, upright (the image's top row comes first). Alpha and
/// depth are left out. `quality` is 1 to 100. May be called from any thread.
///
/// Larger pictures are encoded in two halves at the same time, with a restart marker between them,
/// by which who decodes may do the same (jpeg_halves.h). 1280x720 takes about 2 ms at quality 75
/// 4:2:0 and 4 ms at quality 95 4:4:4 of one core.
/// Errors: InvalidArgument (an empty image, one of more than 65500 pixels a side, colour that does
/// not fill the area, a quality out of range).
absl::StatusOr<std::vector<std::byte>> encodeJpeg(const fabric::Image& image, int quality,
                                                  ChromaSubsampling subsampling);

/// The sides of the picture in `bytes`, as their header says; what comes after it is not looked at.
struct JpegSize {
    int width = 0;  ///< pixels
    int height = 0;

    bool operator==(const JpegSize&) const = default;
};
/// Errors: InvalidArgument (no header of a JPEG).
absl::StatusOr<JpegSize> jpegSize(std::span<const std::byte> bytes);

/// The picture in `bytes`, with alpha 255 and area {0, 0, width, height}.
/// Errors: InvalidArgument (no JPEG picture, or one of more than 64 Mpixel).
absl::StatusOr<fabric::Image> decodeJpeg(std::span<const std::byte> bytes);

}  // namespace eyrie::wire
