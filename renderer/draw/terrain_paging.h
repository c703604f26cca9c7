// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <stop_token>
#include <variant>
#include <vector>

#include <absl/status/status.h>

#include "renderer/draw/device_texture.h"
#include "renderer/draw/needed_tiles.h"
#include "renderer/draw/terrain_items.h"
#include "renderer/draw/terrain_tiles.h"
#include "renderer/draw/view_claims.h"
#include "renderer/draw/view_turns.h"
#include "renderer/page/host_pages.h"
#include "renderer/page/loader.h"
#include "renderer/page/resident_set.h"
#include "renderer/terrain/eyt_format.h"
#include "renderer/terrain/refinement.h"

namespace eyrie::draw {

/// Limits in bytes of what one terrain holds; they hold at all times. Of scenes two are held,
/// one within its limits, while the other is opened (RendererOptions::memoryBytes).
struct TerrainMemory {
    std::uint64_t deviceBytes = 0;
    std::uint64_t hostBytes = 0;  ///< pages in memory or being loaded
};

/// Which tiles and texture tiles of one terrain are on the device, and the pages on their way
/// there. GL thread.
///
/// What a channel needs is brought to the device coarse levels first, so that it refines evenly,
/// and within a level by error and nearness to the view's axis; texture tiles in turn with the
/// tiles of their size. Whatever is missing, what is there is drawn as a restricted cut: there are
/// no cracks to hide; a texture tile's ancestor stands in for it. A page that cannot be read is
/// logged once, and tried again by the loader.
class TerrainPaging {
public:
    /// Reads the top tile and texture tile, which stay on the device: they stand in for everything.
    /// `decoder` makes the tiles; null: the CPU does. It and `loader` outlive this. Errors: of
    /// reading its page; ResourceExhausted when the limits hold no page of `file`.
    static absl::StatusOr<std::unique_ptr<TerrainPaging>> open(
        std::shared_ptr<const terrain::EytFile> file, page::Loader& loader,
        const TerrainMemory& limits, TextureFormat format, TileDecoder* decoder);

    using Prefetch = std::function<std::vector<TerrainItem>()>;

    /// What there is to draw.
    struct Result {
        terrain::Refinement drawn;  ///< all needed tiles of this cut are on the device
        page::HostPages::Loads loaded;
        std::uint64_t pagesMissing = 0;  ///< pages of wanted needed tiles that are not there
        std::uint64_t pagesFailed = 0;   ///< of them; all, while their source is unavailable
        std::uint64_t tilesDecodedOnGpu = 0;
    };

    /// Goes towards `wanted` as far as it can without waiting: takes what the loader has, brings
    /// tiles to the device for a few milliseconds, and wishes for the rest; where nothing is
    /// missing, for the pages of `prefetch()`: what may be needed soon, likely things first.
    /// `textures`: distinct ones, of those that the terrain has. Views that take turns spare each
    /// other's tiles, and their pages come by turns, too.
    Result approach(const terrain::Refinement& wanted, const NeededTiles& needed,
                    const std::vector<terrain::TextureId>& textures, const lod::ObjectView& view,
                    const ViewTurn& turn, const Prefetch& prefetch);

    /// Goes there: waits for every page that can be read, through the first failures of a server,
    /// or until `stop`. Other views' tiles give way where there is no other room.
    Result reach(const terrain::Refinement& wanted, const NeededTiles& needed,
                 const std::vector<terrain::TextureId>& textures, const lod::ObjectView& view,
                 const ViewTurn& turn, const std::stop_token& stop);

    /// Null when it is not on the device. Valid until the next approach() or reach().
    const DeviceTile* tile(const terrain::TileId& id) {
        if (id == index_.quadtree.top())
            return top_.get();
        const auto* item = items_.find(index_.quadtree.tileIndex(id));
        return item == nullptr ? nullptr : &std::get<DeviceTile>(*item);
    }
    const DeviceTexture* texture(const terrain::TextureId& id) {
        if (id == index_.imagery->pyramid.top())
            return topTexture_.get();
        const auto* item = items_.find(names_.of(id).key);
        return item == nullptr ? nullptr : &std::get<DeviceTexture>(*item);
    }
    bool isResident(const terrain::TextureId& texture) const {
        return texture == index_.imagery->pyramid.top() || items_.contains(names_.of(texture).key);
    }

    MemoryUse memory() const;
    /// What reach() brings to the device where all can be read.
    std::uint64_t bytesOf(const terrain::Refinement& wanted, const NeededTiles& needed,
                          const std::vector<terrain::TextureId>& textures) const;
    /// Room on the device beside the top tile and texture tile.
    std::uint64_t roomBytes() const { return items_.limitBytes(); }
    const TerrainItems& items() const { return names_; }
    /// From a page's first wish to its arrival, averaged over the last ones.
    std::chrono::duration<double> latency() const { return pages_.latency(); }

private:
    using Clock = std::chrono::steady_clock;

    TerrainPaging(std::shared_ptr<const terrain::EytFile> file, page::Loader& loader,
                  const TerrainMemory& limits, TextureFormat format, TileDecoder* decoder,
                  std::uint64_t topBytes);

    struct RankedItem {
        TerrainItem item;
        std::uint32_t rank;
    };

    bool isEmpty(const terrain::TileId& tile) const { return index_.tile(tile).triangles == 0; }
    /// Whether there is anything of it to bring to the device.
    bool isStored(const terrain::TileId& tile) const {
        return !isEmpty(tile) || index_.hasNormals(tile);
    }
    bool isResident(const terrain::TileId& tile) const {
        return tile == index_.quadtree.top() || items_.contains(index_.quadtree.tileIndex(tile));
    }
    /// Whether it can be drawn: it and the tile that has its normals are resident.
    bool isDrawable(const terrain::TileId& tile) const {
        return isEmpty(tile) || (isResident(tile) && isResident(index_.quadtree.normalTile(tile)));
    }
    terrain::Refinement drawable(const terrain::Refinement& wanted,
                                 const NeededTiles& needed) const;

    ViewClaim& beginFrame(const ViewTurn& turn);
    void rankAs(std::uint32_t key, std::uint32_t rank, ViewClaim& claim);
    /// A texture tile and those above it, up to below the top.
    std::vector<terrain::TextureId> chainOf(terrain::TextureId texture) const;
    /// What of `textures` and all above is drawn with, which gets its rank, and what lies below and
    /// above that. Returns the bytes of the first.
    std::uint64_t sortTextures(const std::vector<terrain::TextureId>& textures,
                               std::vector<terrain::TextureId>& below,
                               std::vector<terrain::TextureId>& above, ViewClaim& claim);
    void rankItems(const std::vector<TerrainItem>& order, std::uint64_t reservedBytes,
                   ViewClaim& claim);
    /// Pages of what is missing.
    std::vector<std::uint32_t> missingPages() const;
    /// Returns whether it brought any.
    bool upload(std::chrono::duration<double> time);
    /// One item of a page that is in memory; false when there is no room.
    bool upload(const RankedItem& ranked, const std::shared_ptr<const void>& page);
    std::vector<terrain::TextureId> readableOf(const std::vector<terrain::TextureId>& textures,
                                               Clock::time_point start) const;
    /// The leaves of `cut` that are needed, and the tiles that have their normals.
    std::vector<terrain::TileId> tilesOf(const terrain::Refinement& cut,
                                         const NeededTiles& needed) const;
    Result resultOf(terrain::Refinement drawn, const NeededTiles& needed,
                    const std::vector<terrain::TextureId>& textures) const;

    const std::shared_ptr<const terrain::EytFile> file_;
    const terrain::EytIndex& index_;
    const TerrainItems names_;
    TileDecoder* const decoder_;
    std::unique_ptr<DeviceTile> top_;
    std::unique_ptr<DeviceTexture> topTexture_;  ///< null: it has none
    page::ResidentSet<std::uint32_t, std::variant<DeviceTile, DeviceTexture>> items_;  // by key
    std::uint64_t topBytes_;

    std::vector<RankedItem> missing_;      // of this frame, in the order in which they are to come
    std::uint64_t tilesDecodedOnGpu_ = 0;  // of this frame
    ViewClaims claims_;

    page::HostPages pages_;  // terrain::Page or TextureImage; last: its loads use the file
};

}  // namespace eyrie::draw
