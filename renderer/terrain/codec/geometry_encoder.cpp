// SPDX-License-Identifier: Apache-2.0
#include "renderer/terrain/codec/geometry_encoder.h"

#include <algorithm>
#include <cassert>

namespace eyrie::terrain {

void GeometryEncoder::add(const TileMesh& mesh, std::int32_t baseHeight, int heightShift) {
    baseHeight_ = baseHeight;
    heightShift_ = heightShift;
    vertex_ = mesh.vertices.data();
    positions_.resize(kMaxTileVertices);
    heights_.resize(kMaxTileVertices);
    TileModel<GeometryEncoder> model(*this, mesh.isSparse, positions_.data(), heights_.data());
    const auto point = [](std::uint16_t number) { return TilePoint{0, 0, number}; };
    for (const WalkStep& step : mesh.walk) {
        isVertexNext_ = step.isVertex();
        if (step.isFlag())
            flag(step.context, step.kind == WalkStep::Kind::FlagYes);
        else if (step.isCorner())
            model.addCorner({}, {});
        else
            model.add({}, point(step.apex), point(step.left), point(step.right), step.context);
    }
    assert(vertex_ == mesh.vertices.data() + mesh.vertices.size());
}

bool GeometryEncoder::flag(int context, bool value) {
    codec::AdaptiveFlag& model = flags_[static_cast<std::size_t>(context)];
    const codec::Share share = model.share(value);
    model.learn(value);
    events_.push_back(
        {static_cast<std::uint16_t>(share.start), static_cast<std::uint16_t>(share.size)});
    return value;
}

bool GeometryEncoder::isPresent(int context) { return flag(context, isVertexNext_); }

std::uint32_t GeometryEncoder::height(int context, std::uint32_t foreseen) {
    const TileVertex& vertex = *vertex_++;
    const auto height = static_cast<std::uint32_t>(vertex.q - baseHeight_) >> heightShift_;
    const Residual residual = Residual::of(height, foreseen);
    static_assert(Residual::kSymbols <= 256);
    events_.push_back(
        {static_cast<std::uint16_t>(static_cast<std::uint32_t>(context) << 8 | residual.symbol),
         0});
    ++counts_[static_cast<std::size_t>(context)][residual.symbol];
    if (residual.rawBits != 0)
        raws_.push_back({residual.raw, residual.rawBits});
    return height;
}

GeometryBits GeometryEncoder::finish() {
    codec::BitWriter raw;
    std::array<codec::ReadyShare<codec::kSymbolBits>, kHeightContexts << 8> ofHeights;
    for (std::size_t context = 0; context < kHeightContexts; ++context) {
        const codec::SymbolShares shares(counts_[context]);
        shares.write(raw);
        for (std::uint32_t symbol = 0; symbol < Residual::kSymbols; ++symbol)
            if (counts_[context][symbol] > 0)
                ofHeights[context << 8 | symbol] =
                    codec::ReadyShare<codec::kSymbolBits>(shares.of(symbol));
    }
    for (const RawBits& bits : raws_) raw.put(bits.value, static_cast<int>(bits.count));

    codec::RansEncoder<2> rans;
    for (std::size_t k = events_.size(); k-- > 0;) {
        const auto [start, size] = events_[k];
        if (size != 0)
            rans.put(0, codec::ReadyShare<codec::AdaptiveFlag::kBits>(
                            {start, size}, codec::kReciprocals<codec::AdaptiveFlag::kBits>[size]));
        else
            rans.put(1, ofHeights[start]);
    }
    std::vector<std::uint8_t> bytes = std::move(raw).finish();
    bytes.resize(bytes.size() + bytes.size() % 2);
    events_.clear();
    flags_ = {};
    raws_.clear();
    counts_ = {};
    return {std::move(rans).finish(), std::move(bytes)};
}

}  // namespace eyrie::terrain
