// SPDX-License-Identifier: Apache-2.0
#include "renderer/terrain/codec/geometry_encoder.h"

#include <algorithm>
#include <cassert>

namespace eyrie::terrain {

bool isSparse(const TileMesh& mesh) { return mesh.isPresent.size() != mesh.vertices.size(); }

void GeometryEncoder::add(const TileMesh& mesh, std::int32_t baseHeight, int heightShift) {
    mesh_ = &mesh;
    baseHeight_ = baseHeight;
    heightShift_ = heightShift;
    nextSplit_ = nextPoint_ = nextVertex_ = 0;
    positions_.resize(kMaxTileVertices);
    heights_.resize(kMaxTileVertices);
    TileModel<GeometryEncoder> model(*this, isSparse(mesh), positions_.data(), heights_.data());
    TileTriangulation<TileModel<GeometryEncoder>>(mesh.shape, slots_, model).walk();
    assert(nextSplit_ == mesh.splits.size() && nextVertex_ == mesh.vertices.size());
}

bool GeometryEncoder::flag(int context, bool value) {
    events_.push_back({true, static_cast<std::uint8_t>(context), value});
    return value;
}

bool GeometryEncoder::isVertex(int context) {
    return flag(context, mesh_->splits[nextSplit_++] != 0);
}

bool GeometryEncoder::isPresent(int context) {
    return flag(context, mesh_->isPresent[nextPoint_++] != 0);
}

std::uint32_t GeometryEncoder::height(int context, std::uint32_t foreseen) {
    const TileVertex& vertex = mesh_->vertices[nextVertex_++];
    const auto height = static_cast<std::uint32_t>(vertex.q - baseHeight_) >> heightShift_;
    const Residual residual = Residual::of(height, foreseen);
    events_.push_back(
        {false, static_cast<std::uint8_t>(context), static_cast<std::uint8_t>(residual.symbol)});
    ++counts_[static_cast<std::size_t>(context)][residual.symbol];
    if (residual.rawBits != 0)
        raws_.push_back(residual);
    return height;
}

GeometryBits GeometryEncoder::finish() {
    std::array<SymbolShares, kHeightContexts> symbols;
    for (std::size_t k = 0; k < kHeightContexts; ++k) symbols[k] = SymbolShares(counts_[k]);
    BitWriter raw;
    for (const SymbolShares& shares : symbols) shares.write(raw);
    for (const Residual& residual : raws_)
        raw.put(residual.raw, static_cast<int>(residual.rawBits));

    std::array<AdaptiveFlag, kFlagContexts> flags;
    shares_.clear();
    for (const Event& event : events_) {
        if (event.isFlag) {
            shares_.push_back(flags[event.context].share(event.value != 0));
            flags[event.context].learn(event.value != 0);
        } else {
            shares_.push_back(symbols[event.context].of(event.value));
        }
    }
    RansEncoder<2> rans;
    for (std::size_t k = events_.size(); k-- > 0;)
        rans.put(events_[k].isFlag ? 0 : 1, shares_[k],
                 events_[k].isFlag ? AdaptiveFlag::kBits : kSymbolBits);
    std::vector<std::uint8_t> bytes = std::move(raw).finish();
    bytes.resize(bytes.size() + bytes.size() % 2);
    events_.clear();
    raws_.clear();
    counts_ = {};
    return {std::move(rans).finish(), std::move(bytes)};
}

}  // namespace eyrie::terrain
