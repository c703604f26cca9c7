// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/texel_store.h"

#include <algorithm>
#include <cassert>
#include <cstring>
#include <utility>

namespace eyrie::import {

using terrain::TexelRect;
using terrain::TextureId;

TexelStore::TexelStore(const terrain::TexturePyramid& pyramid, terrain::Scratch& scratch)
    : pyramid_(pyramid), scratch_(scratch) {
    for (int level = 1; level < pyramid.levels(); ++level)
        levels_.push_back(scratch.reserve(
            kPieceBytes, static_cast<std::uint64_t>(pyramid.tilesX(level - 1)) *
                             static_cast<std::uint64_t>(pyramid.tilesY(level - 1))));
}

std::uint64_t TexelStore::placeOf(int level, std::int64_t pieceX, std::int64_t pieceY) const {
    return levels_[static_cast<std::size_t>(level - 1)] +
           terrain::Scratch::stride(kPieceBytes) *
               static_cast<std::uint64_t>(pieceY * pyramid_.tilesX(level - 1) + pieceX);
}

void TexelStore::write(const TextureId& tile, std::span<const fabric::Rgba> texels) {
    const std::uint64_t there = placeOf(tile.level + 1, tile.x, tile.y);
    if (texels.empty())
        return scratch_.clear(there, kPieceBytes);
    const auto half = [](std::int64_t all, std::int32_t place) {
        const std::int64_t own = std::min<std::int64_t>(
            terrain::kTextureSide, all - std::int64_t{place} * terrain::kTextureSide);
        return static_cast<std::size_t>((own + 1) / 2);
    };
    const std::size_t columns = half(pyramid_.width(tile.level), tile.x);
    const std::size_t rows = half(pyramid_.height(tile.level), tile.y);
    assert(texels.size() == columns * rows);
    const std::shared_ptr<std::byte[]> piece = terrain::Scratch::newPiece(kPieceBytes);
    auto* const out = reinterpret_cast<fabric::Rgba*>(piece.get());
    for (std::size_t row = 0; row < rows; ++row)
        std::copy_n(texels.data() + row * columns, columns, out + row * kPieceSide);
    scratch_.write(there, piece, kPieceBytes);
}

void TexelStore::read(int level, const TexelRect& window, std::span<fabric::Rgba> out) const {
    const std::int64_t lastX = pyramid_.width(level) - 1;
    const std::int64_t lastY = pyramid_.height(level) - 1;
    const auto clampX = [&](std::int64_t x) { return std::clamp<std::int64_t>(x, 0, lastX); };
    const auto clampY = [&](std::int64_t y) { return std::clamp<std::int64_t>(y, 0, lastY); };
    const std::int64_t endX = window.x + window.columns;
    const std::int64_t endY = window.y + window.rows;
    for (std::int64_t py = clampY(window.y) / kPieceSide; py <= clampY(endY - 1) / kPieceSide; ++py)
        for (std::int64_t px = clampX(window.x) / kPieceSide; px <= clampX(endX - 1) / kPieceSide;
             ++px) {
            const terrain::Scratch::Piece piece =
                scratch_.read(placeOf(level, px, py), kPieceBytes);
            const auto* const texels = reinterpret_cast<const fabric::Rgba*>(piece.get());
            for (std::int64_t y = window.y; y < endY; ++y) {
                if (clampY(y) / kPieceSide != py)
                    continue;
                const fabric::Rgba* const row = texels + clampY(y) % kPieceSide * kPieceSide;
                fabric::Rgba* const to = out.data() + (y - window.y) * window.columns - window.x;
                for (std::int64_t x = window.x; x < endX; ++x)
                    if (clampX(x) / kPieceSide == px)
                        to[x] = row[clampX(x) % kPieceSide];
            }
        }
}

}  // namespace eyrie::import
