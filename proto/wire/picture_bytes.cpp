// SPDX-License-Identifier: Apache-2.0
#include "wire/picture_bytes.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cstring>
#include <span>

#include <fmt/format.h>

#include "wire/active_run.h"
#include "wire/transport.h"

namespace eyrie::wire {
namespace {

static_assert(std::endian::native == std::endian::little, "depth travels little-endian");

template <typename T>
std::span<const char> bytesOf(const std::vector<T>& values) {
    return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)};
}

std::size_t rawBytes(const fabric::Image& image) {
    return bytesOf(image.colour).size() + bytesOf(image.depth).size();
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

PixelEncoding encodingFor(const std::string& address, bool hasDepth) {
    return address.starts_with("unix:") && !hasDepth ? PixelEncoding::Raw
                                                     : PixelEncoding::ActiveRuns;
}

PictureWriter::PictureWriter(const fabric::Image& image, PixelEncoding encoding)
    : image_(&image),
      bands_(encoding == PixelEncoding::ActiveRuns ? std::make_unique<BandEncoder>(image)
                                                   : nullptr) {}
PictureWriter::~PictureWriter() = default;
PictureWriter::PictureWriter(PictureWriter&&) noexcept = default;

bool PictureWriter::isDone() const {
    return bands_ != nullptr ? bands_->isDone() : sent_ == rawBytes(*image_);
}

void PictureWriter::next(std::string& chunk) {
    assert(!isDone());
    if (bands_ != nullptr)
        return bands_->next(chunk);
    const std::span<const char> colour = bytesOf(image_->colour);
    const bool inColour = sent_ < colour.size();
    std::span<const char> rest =
        inColour ? colour.subspan(sent_) : bytesOf(image_->depth).subspan(sent_ - colour.size());
    rest = rest.first(std::min(rest.size(), kChunkBytes));
    chunk.assign(rest.data(), rest.size());
    sent_ += rest.size();
}

PictureReader::PictureReader(fabric::Image& image, PixelEncoding encoding)
    : image_(&image),
      bands_(encoding == PixelEncoding::ActiveRuns ? std::make_unique<BandDecoder>(image)
                                                   : nullptr) {}
PictureReader::~PictureReader() = default;
PictureReader::PictureReader(PictureReader&&) noexcept = default;

absl::Status PictureReader::take(std::string_view chunk) {
    return bands_ != nullptr ? bands_->take(chunk) : takeRaw(chunk);
}

absl::Status PictureReader::takeRaw(std::string_view bytes) {
    const std::size_t colourBytes = bytesOf(image_->colour).size();
    const std::size_t inColour = copyInto(image_->colour, received_, bytes);
    bytes.remove_prefix(inColour);
    received_ += inColour;
    if (!bytes.empty()) {
        const std::size_t inDepth = copyInto(image_->depth, received_ - colourBytes, bytes);
        bytes.remove_prefix(inDepth);
        received_ += inDepth;
    }
    if (!bytes.empty())
        return absl::DataLossError(
            fmt::format("more than the {} bytes of pixels announced", received_));
    return absl::OkStatus();
}

absl::Status PictureReader::finish() const {
    if (bands_ != nullptr)
        return bands_->isDone() ? absl::OkStatus()
                                : absl::DataLossError("fewer bands than the picture has rows for");
    const std::size_t expected = rawBytes(*image_);
    if (received_ == expected)
        return absl::OkStatus();
    return absl::DataLossError(
        fmt::format("{} bytes of pixels, where {} were announced", received_, expected));
}

}  // namespace eyrie::wire
