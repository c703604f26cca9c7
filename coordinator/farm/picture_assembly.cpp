// SPDX-License-Identifier: Apache-2.0
#include "coordinator/farm/picture_assembly.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <utility>

#include <fmt/format.h>

#include "eyrie/v1/render_service.pb.h"
#include "fabric/status.h"
#include "wire/frame.h"
#include "wire/statistics.h"

namespace eyrie::coordinator {
namespace {

static_assert(std::endian::native == std::endian::little, "depth travels little-endian");

template <typename... Values>
absl::Status broken(fmt::format_string<Values...> format, Values&&... values) {
    return absl::InternalError("the renderer broke the protocol: " +
                               fmt::format(format, std::forward<Values>(values)...));
}

std::uint64_t bytesOf(const fabric::PixelViewport& area, bool hasDepth) {
    return static_cast<std::uint64_t>(area.area()) * (hasDepth ? 8 : 4);
}

/// Copies the bytes from `offset` on into `values` as far as they fit; returns how many did.
template <typename T>
std::size_t copyInto(std::vector<T>& values, std::size_t offset, std::string_view bytes) {
    const std::size_t size = values.size() * sizeof(T);
    if (offset >= size)
        return 0;
    const std::size_t count = std::min(bytes.size(), size - offset);
    std::memcpy(reinterpret_cast<char*>(values.data()) + offset, bytes.data(), count);
    return count;
}

}  // namespace

absl::Status PictureAssembly::checkSizes(const v1::ChannelHeader& header) const {
    const fabric::PixelViewport& area = result_.image.area;
    const fabric::PixelViewport& whole = task_.pixelViewport;
    if (!area.isEmpty() && !whole.contains(area))
        return broken("area is {}x{} at {},{}, outside the task's {}x{} at {},{}", area.width,
                      area.height, area.x, area.y, whole.width, whole.height, whole.x, whole.y);
    if (task_.wantsDepth && !header.has_depth() && !area.isEmpty())
        return broken("has_depth is false, but the task wants depth");
    if (header.pixel_bytes() != bytesOf(area, header.has_depth()))
        return broken("pixel_bytes is {}, but {}x{} pixels have {}", header.pixel_bytes(),
                      area.width, area.height, bytesOf(area, header.has_depth()));
    return absl::OkStatus();
}

absl::Status PictureAssembly::takeHeader(const v1::ChannelHeader& header) {
    if (hasHeader_)
        return broken("a second header");
    hasHeader_ = true;
    auto area = wire::fromMessage(header.area());
    if (!area.ok())
        return broken("{}", area.status().ToString());
    auto statistics = wire::fromMessage(header.statistics());
    if (!statistics.ok())
        return broken("{}", statistics.status().ToString());
    result_.statistics = *statistics;
    result_.image.area = *area;
    RETURN_IF_ERROR(checkSizes(header));
    const auto pixels = static_cast<std::size_t>(area->area());
    result_.image.colour.resize(pixels);
    if (header.has_depth())
        result_.image.depth.resize(pixels);
    return absl::OkStatus();
}

absl::Status PictureAssembly::takeChunk(std::string_view bytes) {
    if (!hasHeader_)
        return broken("pixels before the header");
    const std::size_t colourBytes = result_.image.colour.size() * sizeof(fabric::Rgba);
    const std::size_t inColour = copyInto(result_.image.colour, received_, bytes);
    bytes.remove_prefix(inColour);
    received_ += inColour;
    if (!bytes.empty()) {
        const std::size_t inDepth = copyInto(result_.image.depth, received_ - colourBytes, bytes);
        bytes.remove_prefix(inDepth);
        received_ += inDepth;
    }
    if (!bytes.empty())
        return broken("more than the {} bytes of pixels announced", received_);
    return absl::OkStatus();
}

absl::StatusOr<fabric::ChannelResult> PictureAssembly::finish() {
    if (!hasHeader_)
        return broken("no header");
    const std::uint64_t expected = bytesOf(result_.image.area, result_.image.hasDepth());
    if (received_ != expected)
        return broken("{} bytes of pixels, where {} were announced", received_, expected);
    return std::move(result_);
}

}  // namespace eyrie::coordinator
