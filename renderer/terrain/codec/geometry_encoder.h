// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "renderer/codec/symbol_shares.h"
#include "renderer/terrain/codec/tile_model.h"
#include "renderer/terrain/tile_mesh.h"

namespace eyrie::terrain {

/// The geometry of a page's tiles in bits; geometry_decoder.h reads them.
struct GeometryBits {
    std::vector<std::uint16_t> words;  ///< flags and symbols
    std::vector<std::uint8_t> raw;  ///< symbol shares by context, then the raw bits of heights; an
                                    ///< even number
};

/// Collects tiles first, since all of a page share their symbols' shares. For one page after the
/// other.
class GeometryEncoder {
public:
    /// Heights are counted in steps of 2^heightShift from baseHeight. Give the tiles in the order
    /// in which they are to be decoded. Precondition: `mesh` has triangles.
    void add(const TileMesh& mesh, std::int32_t baseHeight, int heightShift);

    /// Starts over.
    GeometryBits finish();

private:
    friend class TileModel<GeometryEncoder>;

    /// A flag's share, which is known when it comes, or what tells a height's: of size 0, and
    /// starting at context << 8 | symbol. In the order of the walk.
    struct Event {
        std::uint16_t start = 0;
        std::uint16_t size = 0;
    };

    struct RawBits {
        std::uint32_t value;
        std::uint32_t count;
    };

    bool isPresent(int context);
    std::uint32_t height(int context, std::uint32_t foreseen);

    bool flag(int context, bool value);

    std::vector<Event> events_;
    std::array<codec::AdaptiveFlag, kFlagContexts> flags_;
    std::vector<RawBits> raws_;
    std::array<std::array<std::uint32_t, Residual::kSymbols>, kHeightContexts> counts_{};

    // The tile being added.
    const TileVertex* vertex_ = nullptr;  ///< the next
    bool isVertexNext_ = false;
    std::int32_t baseHeight_ = 0;
    int heightShift_ = 0;
    std::vector<std::uint32_t> positions_;
    std::vector<std::uint32_t> heights_;
};

}  // namespace eyrie::terrain
