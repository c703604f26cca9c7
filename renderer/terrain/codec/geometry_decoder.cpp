// SPDX-License-Identifier: Apache-2.0
#include "renderer/terrain/codec/geometry_decoder.h"

#include <algorithm>
#include <cstring>

#include "renderer/terrain/codec/tile_outline.h"
#include "renderer/terrain/vertex_packing.h"

namespace eyrie::terrain {
namespace {

/// Adds the samples that a walk found to be split points.
void markSplit(std::span<const std::uint16_t> slots, std::span<std::uint32_t> split) {
    for (std::size_t first = 0; first < slots.size(); first += 32) {
        std::uint32_t bits = 0;
        const std::size_t count = std::min<std::size_t>(32, slots.size() - first);
        for (std::size_t k = 0; k < count; ++k)
            bits |= (slots[first + k] <= kAbsentPoint ? 1U : 0U) << k;
        split[first / 32] |= bits;
    }
}

}  // namespace

const char* GeometryDecoder::begin() {
    for (std::array<std::uint32_t, codec::kAllShares>& slots : symbols_) {
        codec::SymbolShares shares;
        if (!shares.read(raw_, Residual::kSymbols))
            return "shares of height symbols";
        shares.fillSlots(slots);
    }
    return nullptr;
}

[[gnu::always_inline]] inline bool GeometryDecoder::flag(int context) {
    codec::AdaptiveFlag& model = flags_[static_cast<std::size_t>(context)];
    const bool value = rans_.slot(0, codec::AdaptiveFlag::kBits) < model.ones();
    rans_.take(0, model.share(value), codec::AdaptiveFlag::kBits);
    model.learn(value);
    return value;
}

[[gnu::always_inline]] inline std::uint32_t GeometryDecoder::height(int context,
                                                                    std::uint32_t foreseen) {
    const codec::SlotEntry entry{
        symbols_[static_cast<std::size_t>(context)][rans_.slot(1, codec::kSymbolBits)]};
    rans_.take(1, entry, codec::kSymbolBits);
    Residual residual{entry.symbol(), Residual::rawBitsOf(entry.symbol()), 0};
    if (residual.rawBits != 0)
        residual.raw = raw_.get(static_cast<int>(residual.rawBits));
    return residual.heightFrom(foreseen);
}

inline void GeometryDecoder::triangle(int part, std::uint16_t a, std::uint16_t b, std::uint16_t c) {
    std::uint16_t*& end = ends_[static_cast<std::size_t>(part)];
    end[0] = a;
    end[1] = b;
    end[2] = c;
    end += 3;
}

const char* GeometryDecoder::decode(const TileHeader& header, const TileShape& shape,
                                    std::span<std::uint32_t> vertices,
                                    std::span<std::uint16_t> indices,
                                    std::array<IndexRange, kTileParts>& parts) {
    ends_[kInteriorPart] = scratch_->interior.data();
    for (std::size_t part = 1; part < kTileParts; ++part)
        ends_[part] = scratch_->borders[part].data();
    TileModel<GeometryDecoder> model(*this, header.isSparse != 0, scratch_->positions.data(),
                                     scratch_->heights.data());
    TileTriangulation<TileModel<GeometryDecoder>>(shape, slots_, model).walk();
    if (const char* wrong = checkWalk(header, model.vertices()))
        return wrong;
    if (const char* wrong = copyIndices(indices, parts))
        return wrong;
    if (const char* wrong = checkHeights(header))
        return wrong;
    packVertices({scratch_->positions.data(), header.vertices},
                 {scratch_->heights.data(), header.vertices}, header.wordsPerVertex, vertices);
    return nullptr;
}

const char* GeometryDecoder::decodeOutline(const TileHeader& header, const TileShape& shape,
                                           std::span<std::uint32_t> outline,
                                           std::array<IndexRange, kTileParts>& parts) {
    const auto cells = static_cast<std::size_t>(shape.cells);
    const std::size_t setWords = pointSetWords(cells);
    const std::span split = outline.subspan(kOutlineHeaderWords, setWords);
    const std::span absent =
        outline.subspan(kOutlineHeaderWords + setWords, header.isSparse != 0 ? setWords : 0);
    std::fill(split.begin(), split.end(), 0U);
    std::fill(absent.begin(), absent.end(), 0U);

    Outlining outlining{*this};
    TileModel<Outlining> model(outlining, header.isSparse != 0, scratch_->positions.data(),
                               scratch_->heights.data());
    OutlineModel<Outlining> source(model, cells, split, absent);
    TileTriangulation<OutlineModel<Outlining>>(shape, slots_, source).walk();
    if (const char* wrong = checkWalk(header, model.vertices()))
        return wrong;
    OutlineHeader head{static_cast<std::uint32_t>(shape.cells),
                       static_cast<std::uint32_t>(shape.limitX),
                       static_cast<std::uint32_t>(shape.limitY),
                       shape.finerEdges,
                       header.isSparse,
                       header.vertices,
                       header.wordsPerVertex,
                       {}};
    std::uint32_t first = 0;
    for (std::size_t part = 0; part < kTileParts; ++part) {
        head.firstTriangles[part] = first;
        parts[part] = {3 * first, 3 * outlining.triangles[part]};
        first += outlining.triangles[part];
    }
    if (first != header.triangles)
        return "number of triangles";
    if (const char* wrong = checkHeights(header))
        return wrong;
    std::memcpy(outline.data(), &head, sizeof head);
    markSplit(slots_, split);
    copyHeights(header, outline.subspan(kOutlineHeaderWords + split.size() + absent.size()));
    return nullptr;
}

/// Of the walk that has just ended.
const char* GeometryDecoder::checkWalk(const TileHeader& header, std::uint16_t vertices) const {
    if (rans_.isPastEnd() || raw_.isPastEnd())
        return "length of the geometry's bits";
    return vertices == header.vertices ? nullptr : "number of vertices";
}

const char* GeometryDecoder::copyIndices(std::span<std::uint16_t> out,
                                         std::array<IndexRange, kTileParts>& parts) const {
    std::size_t count = 0;
    for (std::size_t part = 0; part < kTileParts; ++part) {
        const std::uint16_t* first =
            part == kInteriorPart ? scratch_->interior.data() : scratch_->borders[part].data();
        const auto size = static_cast<std::size_t>(ends_[part] - first);
        if (size > out.size() - count)
            return "number of triangles";
        parts[part] = {static_cast<std::uint32_t>(count), static_cast<std::uint32_t>(size)};
        std::copy_n(first, size, out.data() + count);
        count += size;
    }
    return count == out.size() ? nullptr : "number of triangles";
}

const char* GeometryDecoder::checkHeights(const TileHeader& header) const {
    const std::span heights(scratch_->heights.data(), header.vertices);
    const std::uint32_t highest = *std::max_element(heights.begin(), heights.end());
    const std::int64_t top = header.baseHeight + (std::int64_t{highest} << header.heightShift);
    if (top > kMaxHeightSteps)
        return "vertex height";
    return (highest <= kMaxShortHeight) == (header.wordsPerVertex == 1) ? nullptr
                                                                        : "wordsPerVertex";
}

void GeometryDecoder::copyHeights(const TileHeader& header, std::span<std::uint32_t> out) const {
    const std::uint32_t* heights = scratch_->heights.data();
    if (header.wordsPerVertex != 1) {
        std::copy_n(heights, header.vertices, out.data());
        return;
    }
    for (std::size_t k = 0; k < out.size(); ++k) {
        const bool hasSecond = 2 * k + 1 < header.vertices;
        out[k] = heights[2 * k] | (hasSecond ? heights[2 * k + 1] << 16 : 0);
    }
}

const char* GeometryDecoder::finish() const {
    if (!rans_.isAtEnd() || raw_.bytesRead() + raw_.bytesRead() % 2 != raw_.size())
        return "length of the geometry's bits";
    return nullptr;
}

}  // namespace eyrie::terrain
