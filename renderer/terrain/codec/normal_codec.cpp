// SPDX-License-Identifier: Apache-2.0
#include "renderer/terrain/codec/normal_codec.h"

#include <algorithm>
#include <array>
#include <cstring>

#include "fabric/simd_clones.h"

namespace eyrie::terrain {
namespace {

inline std::uint8_t zigzag(int difference) {
    const auto d = static_cast<std::int8_t>(difference);
    return static_cast<std::uint8_t>(d << 1 ^ d >> 7);
}

inline int unzigzag(std::uint8_t code) { return (code >> 1) ^ -(code & 1); }

/// The median of left, up and the plane through the three.
inline int medianEdge(int left, int up, int upLeft) {
    const int low = left < up ? left : up;
    const int high = left < up ? up : left;
    const int plane = left + (up - upLeft);
    const int capped = plane < high ? plane : high;
    return capped > low ? capped : low;
}

/// Contexts of a row from the residuals of the row above; the first row's are all alike.
EYRIE_SIMD_CLONES void rowContexts(const std::uint8_t* above, std::size_t samples,
                                   std::uint8_t* contexts) {
    std::array<std::uint8_t, kPaddedRow> sizes{};
    for (std::size_t k = 0; k < samples; ++k)
        sizes[k + 1] = static_cast<std::uint8_t>((above[k] >> 1) + (above[k] & 1));
    sizes[0] = sizes[1];
    sizes[samples + 1] = sizes[samples];
    for (std::size_t k = 0; k < samples; ++k) {
        const int around = sizes[k] + 2 * sizes[k + 1] + sizes[k + 2];
        contexts[k] = static_cast<std::uint8_t>((around > 2) + (around > 6) + (around > 14));
    }
}

constexpr std::uint8_t kFirstRowContext = 2;

/// Whether y at column i of a row between two others is foreseen from x.
constexpr std::size_t kFirstCurlColumn = 2;

/// Foreseen from the samples before it in the same plane.
inline int fromPlane(const std::int8_t* row, const std::int8_t* above, std::size_t i) {
    if (above == nullptr)
        return i == 0 ? 0 : row[i - 1];
    return i == 0 ? above[0] : medianEdge(row[i - 1], above[i], above[i - 1]);
}

/// A row of x, or a row or the first columns of y, from its residuals.
void restoreFromPlane(const std::uint8_t* left, const std::int8_t* above, std::size_t count,
                      std::int8_t* row) {
    if (above == nullptr) {
        for (std::size_t i = 0; i < count; ++i)
            row[i] = static_cast<std::int8_t>(fromPlane(row, above, i) + unzigzag(left[i]));
        return;
    }
    int last = static_cast<std::int8_t>(above[0] + unzigzag(left[0]));
    row[0] = static_cast<std::int8_t>(last);
    for (std::size_t i = 1; i < count; ++i) {
        last =
            static_cast<std::int8_t>(medianEdge(last, above[i], above[i - 1]) + unzigzag(left[i]));
        row[i] = static_cast<std::int8_t>(last);
    }
}

/// The residuals of a row of x, or of a row or the first columns of y.
EYRIE_SIMD_CLONES void leaveFromPlane(const std::int8_t* row, const std::int8_t* above,
                                      std::size_t count, std::uint8_t* left) {
    left[0] = zigzag(row[0] - fromPlane(row, above, 0));
    if (above == nullptr)
        for (std::size_t i = 1; i < count; ++i) left[i] = zigzag(row[i] - row[i - 1]);
    else
        for (std::size_t i = 1; i < count; ++i)
            left[i] = zigzag(row[i] - medianEdge(row[i - 1], above[i], above[i - 1]));
}

/// Of the rest of a row of y between two of x.
EYRIE_SIMD_CLONES void leaveFromCurl(const std::int8_t* row, const std::int8_t* xBelow,
                                     const std::int8_t* xAbove, std::size_t samples,
                                     std::uint8_t* left) {
    for (std::size_t i = kFirstCurlColumn; i < samples; ++i)
        left[i] = zigzag(row[i] - (row[i - 2] + xAbove[i - 1] - xBelow[i - 1]));
}

EYRIE_SIMD_CLONES void restoreFromCurl(const std::uint8_t* left, const std::int8_t* xBelow,
                                       const std::int8_t* xAbove, std::size_t samples,
                                       std::int8_t* row) {
    std::array<std::int8_t, kPaddedRow> change{};
    for (std::size_t i = kFirstCurlColumn; i < samples; ++i)
        change[i] = static_cast<std::int8_t>(xAbove[i - 1] - xBelow[i - 1] + unzigzag(left[i]));
    for (std::size_t i = kFirstCurlColumn; i < samples; ++i)
        row[i] = static_cast<std::int8_t>(row[i - 2] + change[i]);
}

EYRIE_SIMD_CLONES void separate(const std::int8_t* in, std::size_t count, std::int8_t* x,
                                std::int8_t* y) {
    for (std::size_t k = 0; k < count; ++k) {
        x[k] = in[2 * k];
        y[k] = in[2 * k + 1];
    }
}

EYRIE_SIMD_CLONES void interleave(const std::int8_t* x, const std::int8_t* y, std::size_t count,
                                  std::int8_t* out) {
    for (std::size_t k = 0; k < count; ++k) {
        out[2 * k] = x[k];
        out[2 * k + 1] = y[k];
    }
}

}  // namespace

void NormalEncoder::add(std::int32_t cells, std::span<const std::int8_t> normals) {
    samples_ = static_cast<std::size_t>(cells) + 1;
    const std::size_t n = samples_;
    x_.resize(n * n);
    y_.resize(n * n);
    left_.resize(n * n);
    separate(normals.data(), n * n, x_.data(), y_.data());
    for (std::size_t j = 0; j < n; ++j) {
        const std::int8_t* row = x_.data() + j * n;
        leaveFromPlane(row, j == 0 ? nullptr : row - n, n, left_.data() + j * n);
    }
    addPlane(0);
    for (std::size_t j = 0; j < n; ++j) {
        const std::int8_t* row = y_.data() + j * n;
        const std::int8_t* x = x_.data() + j * n;
        const bool isBetween = j > 0 && j + 1 < n;
        leaveFromPlane(row, j == 0 ? nullptr : row - n, isBetween ? kFirstCurlColumn : n,
                       left_.data() + j * n);
        if (isBetween)
            leaveFromCurl(row, x - n, x + n, n, left_.data() + j * n);
    }
    addPlane(kNormalContexts);
}

void NormalEncoder::addPlane(std::size_t firstContext) {
    const std::size_t first = contexts_.size();
    contexts_.resize(first + left_.size(), kFirstRowContext);
    for (std::size_t j = 1; j < samples_; ++j)
        rowContexts(left_.data() + (j - 1) * samples_, samples_,
                    contexts_.data() + first + j * samples_);
    for (std::size_t k = first; k < contexts_.size(); ++k)
        contexts_[k] = static_cast<std::uint8_t>(contexts_[k] + firstContext);
    symbols_.insert(symbols_.end(), left_.begin(), left_.end());
}

std::vector<std::uint8_t> NormalEncoder::finish() {
    std::array<std::array<std::uint32_t, 256>, 2 * kNormalContexts> counts{};
    for (std::size_t k = 0; k < symbols_.size(); ++k) ++counts[contexts_[k]][symbols_[k]];
    std::array<codec::ReadyShare<codec::kSymbolBits>, 2 * kNormalContexts << 8> ready;
    codec::BitWriter writer;
    for (std::size_t k = 0; k < counts.size(); ++k) {
        const codec::SymbolShares shares(counts[k]);
        shares.write(writer);
        for (std::uint32_t symbol = 0; symbol < counts[k].size(); ++symbol)
            if (counts[k][symbol] > 0)
                ready[k << 8 | symbol] = codec::ReadyShare<codec::kSymbolBits>(shares.of(symbol));
    }
    codec::RansEncoder<4> rans;
    for (std::size_t row = symbols_.size(); row > 0;) {
        row -= samples_;
        for (std::size_t i = samples_; i-- > 0;)
            rans.put(i % 4, ready[std::size_t{contexts_[row + i]} << 8 | symbols_[row + i]]);
    }
    std::vector<std::uint8_t> bytes = std::move(writer).finish();
    const std::vector<std::uint16_t> words = std::move(rans).finish();
    const std::size_t first = bytes.size() + bytes.size() % 2;
    bytes.resize(first + words.size() * sizeof(std::uint16_t));
    std::memcpy(bytes.data() + first, words.data(), words.size() * sizeof(std::uint16_t));
    symbols_.clear();
    contexts_.clear();
    return bytes;
}

NormalDecoder::NormalDecoder(std::span<const std::uint8_t> bytes, std::int32_t cells)
    : samples_(static_cast<std::size_t>(cells) + 1),
      bytes_(bytes),
      rans_({}),
      slots_(2 * kNormalContexts * codec::kAllShares),
      left_(samples_ * samples_),
      x_(samples_ * samples_),
      y_(samples_ * samples_) {}

bool NormalDecoder::begin() {
    codec::BitReader reader(bytes_);
    for (std::size_t k = 0; k < 2 * kNormalContexts; ++k) {
        codec::SymbolShares shares;
        if (!shares.read(reader, 256))
            return false;
        shares.fillSlots(std::span<std::uint32_t, codec::kAllShares>(
            slots_.data() + k * codec::kAllShares, std::size_t{codec::kAllShares}));
    }
    const std::size_t first = reader.bytesRead() + reader.bytesRead() % 2;
    if (first > bytes_.size() || bytes_.size() % 2 != 0)
        return false;
    rans_ = codec::RansDecoder<4>({reinterpret_cast<const std::uint16_t*>(bytes_.data() + first),
                                   (bytes_.size() - first) / sizeof(std::uint16_t)});
    return true;
}

void NormalDecoder::decodePlane(std::size_t firstContext, std::uint8_t* left) {
    std::array<std::uint8_t, kPaddedRow> contexts;
    contexts.fill(kFirstRowContext);
    const std::uint32_t* slots = slots_.data() + firstContext * codec::kAllShares;
    for (std::size_t j = 0; j < samples_; ++j, left += samples_) {
        if (j > 0)
            rowContexts(left - samples_, samples_, contexts.data());
        rans_.takeRow<codec::kSymbolBits>(slots, contexts.data(), samples_, left);
    }
}

bool NormalDecoder::decode(std::span<std::int8_t> normals) {
    const std::size_t n = samples_;
    decodePlane(0, left_.data());
    for (std::size_t j = 0; j < n; ++j) {
        std::int8_t* row = x_.data() + j * n;
        restoreFromPlane(left_.data() + j * n, j == 0 ? nullptr : row - n, n, row);
    }
    decodePlane(kNormalContexts, left_.data());
    for (std::size_t j = 0; j < n; ++j) {
        std::int8_t* row = y_.data() + j * n;
        const std::int8_t* x = x_.data() + j * n;
        const bool isBetween = j > 0 && j + 1 < n;
        restoreFromPlane(left_.data() + j * n, j == 0 ? nullptr : row - n,
                         isBetween ? kFirstCurlColumn : n, row);
        if (isBetween)
            restoreFromCurl(left_.data() + j * n, x - n, x + n, n, row);
    }
    interleave(x_.data(), y_.data(), n * n, normals.data());
    return !rans_.isPastEnd();
}

}  // namespace eyrie::terrain
