// SPDX-License-Identifier: Apache-2.0
#include "renderer/terrain/codec/geometry_decoder.h"

#include <algorithm>

#include "renderer/terrain/vertex_packing.h"

namespace eyrie::terrain {

const char* GeometryDecoder::begin() {
    for (std::array<std::uint32_t, kAllShares>& slots : symbols_) {
        SymbolShares shares;
        if (!shares.read(raw_, Residual::kSymbols))
            return "shares of height symbols";
        shares.fillSlots(slots);
    }
    return nullptr;
}

inline bool GeometryDecoder::flag(int context) {
    AdaptiveFlag& model = flags_[static_cast<std::size_t>(context)];
    const bool value = rans_.slot(0, AdaptiveFlag::kBits) < model.ones();
    rans_.take(0, model.share(value), AdaptiveFlag::kBits);
    model.learn(value);
    return value;
}

inline std::uint32_t GeometryDecoder::height(int context, std::uint32_t foreseen) {
    const SlotEntry entry{symbols_[static_cast<std::size_t>(context)][rans_.slot(1, kSymbolBits)]};
    rans_.take(1, entry, kSymbolBits);
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
    if (rans_.isPastEnd() || raw_.isPastEnd())
        return "length of the geometry's bits";
    if (model.vertices() != header.vertices)
        return "number of vertices";
    if (const char* wrong = copyIndices(indices, parts))
        return wrong;
    return copyVertices(header, vertices);
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

const char* GeometryDecoder::copyVertices(const TileHeader& header,
                                          std::span<std::uint32_t> out) const {
    const std::span heights(scratch_->heights.data(), header.vertices);
    const std::uint32_t highest = *std::max_element(heights.begin(), heights.end());
    const std::int64_t top = header.baseHeight + (std::int64_t{highest} << header.heightShift);
    if (top > kMaxHeightSteps)
        return "vertex height";
    if ((highest <= kMaxShortHeight) != (header.wordsPerVertex == 1))
        return "wordsPerVertex";
    packVertices({scratch_->positions.data(), header.vertices}, heights, header.wordsPerVertex,
                 out);
    return nullptr;
}

const char* GeometryDecoder::finish() const {
    if (!rans_.isAtEnd() || raw_.bytesRead() + raw_.bytesRead() % 2 != raw_.size())
        return "length of the geometry's bits";
    return nullptr;
}

}  // namespace eyrie::terrain
