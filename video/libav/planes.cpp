// SPDX-License-Identifier: Apache-2.0
// Colours by ITU-R BT.709 (2015), limited range, in whole numbers of 1/65536.
#include "video/libav/planes.h"

#include <algorithm>
#include <cstdint>
#include <span>

namespace eyrie::video {
namespace {

struct Sum {
    int r, g, b;
};

constexpr int kHalf = 1 << 15;

std::uint8_t luma(const fabric::Rgba& c) {
    return static_cast<std::uint8_t>(16 + ((11966 * c.r + 40254 * c.g + 4064 * c.b + kHalf) >> 16));
}

/// Of the sums of four pixels.
std::uint8_t blueness(const Sum& c) {
    return static_cast<std::uint8_t>(
        128 + ((-6596 * c.r - 22189 * c.g + 28785 * c.b + 2 * kHalf + kHalf) >> 18));
}
std::uint8_t redness(const Sum& c) {
    return static_cast<std::uint8_t>(
        128 + ((28785 * c.r - 26145 * c.g - 2640 * c.b + 2 * kHalf + kHalf) >> 18));
}

void fillLuma(std::span<const fabric::Rgba> row, int width, std::uint8_t* out) {
    for (std::size_t x = 0; x < row.size(); ++x) out[x] = luma(row[x]);
    if (width > static_cast<int>(row.size()))
        out[row.size()] = out[row.size() - 1];
}

void fillChroma(std::span<const fabric::Rgba> upper, std::span<const fabric::Rgba> lower,
                std::uint8_t* blue, std::uint8_t* red) {
    const std::size_t pairs = upper.size() / 2;
    const auto put = [&](std::size_t x, std::size_t left, std::size_t right) {
        const Sum sum{upper[left].r + upper[right].r + lower[left].r + lower[right].r,
                      upper[left].g + upper[right].g + lower[left].g + lower[right].g,
                      upper[left].b + upper[right].b + lower[left].b + lower[right].b};
        blue[x] = blueness(sum);
        red[x] = redness(sum);
    };
    for (std::size_t x = 0; x < pairs; ++x) put(x, 2 * x, 2 * x + 1);
    if (upper.size() % 2 != 0)
        put(pairs, upper.size() - 1, upper.size() - 1);
}

}  // namespace

absl::StatusOr<Frame> makePlanes(int width, int height) {
    Frame frame(av_frame_alloc());
    if (frame == nullptr)
        return absl::ResourceExhaustedError("video: no memory for a frame");
    frame->format = AV_PIX_FMT_YUV420P;
    frame->width = (width + 1) / 2 * 2;
    frame->height = (height + 1) / 2 * 2;
    frame->color_range = AVCOL_RANGE_MPEG;
    frame->colorspace = AVCOL_SPC_BT709;
    frame->color_primaries = AVCOL_PRI_BT709;
    frame->color_trc = AVCOL_TRC_BT709;
    if (av_frame_get_buffer(frame.get(), 0) != 0)
        return absl::ResourceExhaustedError("video: no memory for a frame");
    return frame;
}

void fillPlanes(const fabric::Image& image, AVFrame& frame) {
    const auto width = static_cast<std::size_t>(image.area.width);
    const int height = image.area.height;
    const auto row = [&](int fromTop) {
        const auto up = static_cast<std::size_t>(std::max(0, height - 1 - fromTop));
        return std::span(image.colour).subspan(up * width, width);
    };
    for (int y = 0; y < frame.height; ++y)
        fillLuma(row(y), frame.width, frame.data[0] + std::ptrdiff_t{y} * frame.linesize[0]);
    for (int y = 0; y < frame.height / 2; ++y)
        fillChroma(row(2 * y), row(2 * y + 1),
                   frame.data[1] + std::ptrdiff_t{y} * frame.linesize[1],
                   frame.data[2] + std::ptrdiff_t{y} * frame.linesize[2]);
}

}  // namespace eyrie::video
