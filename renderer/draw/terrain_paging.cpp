// SPDX-License-Identifier: Apache-2.0
#include "renderer/draw/terrain_paging.h"

#include <algorithm>
#include <unordered_set>
#include <utility>

#include <glm/geometric.hpp>

#include "fabric/status.h"
#include "renderer/draw/least_memory.h"
#include "renderer/terrain/tile_bytes.h"

namespace eyrie::draw {
namespace {

using std::chrono::duration;
using terrain::Quadtree;
using terrain::Refinement;
using terrain::TextureId;
using terrain::TileId;

page::Loader::Load loadFrom(std::shared_ptr<const terrain::EytFile> file, const TerrainItems& names,
                            terrain::PageForm form) {
    return
        [file = std::move(file), names, form](std::uint32_t page) -> absl::StatusOr<page::Loaded> {
            if (names.isTexture(page)) {
                ASSIGN_OR_RETURN(const auto read, file->readTexture(names.textureOf(page)));
                return page::Loaded{std::make_shared<const TextureImage>(*read, names.format()),
                                    names.greatestPageBytes(page)};
            }
            ASSIGN_OR_RETURN(std::shared_ptr<const terrain::Page> read, file->readPage(page, form));
            const std::uint64_t bytes = read->sizeBytes();
            return page::Loaded{std::move(read), bytes};
        };
}

terrain::PageForm formFor(TileDecoder* decoder) {
    return decoder == nullptr ? terrain::PageForm::Drawable : terrain::PageForm::Outlines;
}

}  // namespace

absl::StatusOr<std::unique_ptr<TerrainPaging>> TerrainPaging::open(
    std::shared_ptr<const terrain::EytFile> file, page::Loader& loader, const TerrainMemory& limits,
    TextureFormat format, TileDecoder* decoder) {
    const terrain::EytIndex& index = file->index();
    const TileId top = index.quadtree.top();
    ASSIGN_OR_RETURN(const std::shared_ptr<const terrain::Page> page,
                     file->readPage(index.quadtree.pageIndex(top), formFor(decoder)));
    const terrain::TileGeometry& geometry = page->tile(Quadtree::placeInPage(top));
    const TerrainItems names(index, format);
    std::uint64_t topBytes = terrain::tileBytes(geometry);
    std::unique_ptr<DeviceTexture> topTexture;
    if (index.imagery && index.imagery->has(index.imagery->pyramid.top())) {
        const TextureId topId = index.imagery->pyramid.top();
        ASSIGN_OR_RETURN(const auto texture, file->readTexture(topId));
        topTexture = std::make_unique<DeviceTexture>(TextureImage(*texture, format));
        topBytes += names.of(topId).deviceBytes;
    }
    const std::uint64_t greatestPage = names.greatestOfAllPages();
    RETURN_IF_ERROR(checkHolds({limits.deviceBytes, limits.hostBytes}, {topBytes, 2 * greatestPage},
                               file->path()));
    std::unique_ptr<TerrainPaging> paging(
        new TerrainPaging(std::move(file), loader, limits, format, decoder, topBytes));
    paging->top_ = std::make_unique<DeviceTile>(geometry, decoder);
    if (decoder != nullptr)
        decoder->publish();
    paging->topTexture_ = std::move(topTexture);
    return paging;
}

TerrainPaging::TerrainPaging(std::shared_ptr<const terrain::EytFile> file, page::Loader& loader,
                             const TerrainMemory& limits, TextureFormat format,
                             TileDecoder* decoder, std::uint64_t topBytes)
    : file_(std::move(file)),
      index_(file_->index()),
      names_(index_, format),
      decoder_(decoder),
      items_(limits.deviceBytes - topBytes),
      topBytes_(topBytes),
      pages_(loader, loadFrom(file_, names_, formFor(decoder)),
             {file_->path(), [this](std::uint32_t page) { return names_.greatestPageBytes(page); },
              [this](std::uint32_t page) { return names_.bytesOnDisk(page); }},
             limits.hostBytes, names_.greatestOfAllPages()) {}

MemoryUse TerrainPaging::memory() const { return {topBytes_ + items_.bytes(), pages_.bytes()}; }

Refinement TerrainPaging::drawable(const Refinement& wanted, const NeededTiles& needed) const {
    Refinement drawn = wanted;
    drawn.coarsen([&](const TileId& tile) { return !needed.contains(tile) || isDrawable(tile); });
    return drawn;
}

ViewClaim& TerrainPaging::beginFrame(const ViewTurn& turn) {
    items_.beginFrame();
    pages_.beginFrame();
    missing_.clear();
    return claims_.begin(turn);
}

void TerrainPaging::rankAs(std::uint32_t key, std::uint32_t rank, ViewClaim& claim) {
    items_.rank(key, rank);
    claim.items.emplace_back(key, rank);
}

std::vector<TextureId> TerrainPaging::chainOf(TextureId texture) const {
    std::vector<TextureId> chain;
    for (; texture != index_.imagery->pyramid.top();
         texture = terrain::TexturePyramid::parent(texture))
        chain.push_back(texture);
    return chain;
}

std::uint64_t TerrainPaging::sortTextures(const std::vector<TextureId>& textures,
                                          std::vector<TextureId>& below,
                                          std::vector<TextureId>& above, ViewClaim& claim) {
    std::unordered_set<std::uint32_t> known;
    std::unordered_set<std::uint32_t> drawn;
    std::uint64_t drawnBytes = 0;
    for (const TextureId& texture : textures) {
        bool isBelow = true;
        for (const TextureId& one : chainOf(texture)) {
            const TerrainItem item = names_.of(one);
            if (names_.bytesOnDisk(item.page) == 0)
                continue;
            if (isBelow && items_.contains(item.key)) {
                isBelow = false;
                rankAs(item.key, 0, claim);
                if (drawn.insert(item.key).second)
                    drawnBytes += item.deviceBytes;
            } else if (known.insert(item.key).second) {
                (isBelow ? below : above).push_back(one);
            }
        }
    }
    std::erase_if(above, [&](const TextureId& one) { return drawn.contains(names_.of(one).key); });
    return drawnBytes;
}

/// Gives what is on the device its rank, and lists what is missing as far as it will fit.
void TerrainPaging::rankItems(const std::vector<TerrainItem>& order, std::uint64_t reservedBytes,
                              ViewClaim& claim) {
    std::uint64_t bytes = reservedBytes;
    std::uint32_t rank = 0;
    for (const TerrainItem& item : order) {
        bytes += item.deviceBytes;
        if (bytes > items_.limitBytes())
            return;
        rankAs(item.key, ++rank, claim);
        if (!items_.contains(item.key))
            missing_.push_back({item, rank});
    }
}

std::vector<std::uint32_t> TerrainPaging::missingPages() const {
    std::vector<std::uint32_t> pages;
    for (const RankedItem& ranked : missing_) pages.push_back(ranked.item.page);
    return pages;
}

bool TerrainPaging::upload(const RankedItem& ranked, const std::shared_ptr<const void>& page) {
    const auto& [item, rank] = ranked;
    if (names_.isTexture(item.page)) {
        if (!items_.makeRoom(item.deviceBytes, rank))
            return false;
        items_.insert(item.key, DeviceTexture(*static_cast<const TextureImage*>(page.get())),
                      item.deviceBytes, rank);
        return true;
    }
    const TileId tile = index_.quadtree.tileOf(item.key);
    const terrain::TileGeometry& geometry =
        static_cast<const terrain::Page*>(page.get())->tile(Quadtree::placeInPage(tile));
    const std::uint64_t bytes = terrain::tileBytes(geometry);
    if (!items_.makeRoom(bytes, rank))
        return false;
    items_.insert(item.key, DeviceTile(geometry, decoder_), bytes, rank);
    tilesDecodedOnGpu_ += geometry.outline.empty() ? 0 : 1;
    return true;
}

bool TerrainPaging::upload(duration<double> time) {
    const auto end = Clock::now() + time;
    bool hasUploaded = false;
    std::erase_if(missing_, [&](const RankedItem& ranked) {
        if (hasUploaded && Clock::now() >= end)
            return false;
        const auto* page = pages_.find(ranked.item.page);
        if (page == nullptr || !upload(ranked, *page))
            return false;
        hasUploaded = true;
        return true;
    });
    if (decoder_ != nullptr)
        decoder_->publish();  // all are still there: what came first ranks first
    return hasUploaded;
}

/// Each, or in its place the nearest above that may still come.
std::vector<TextureId> TerrainPaging::readableOf(const std::vector<TextureId>& textures,
                                                 Clock::time_point start) const {
    std::vector<TextureId> readable;
    std::unordered_set<std::uint32_t> known;
    for (const TextureId& texture : textures)
        for (const TextureId& one : chainOf(texture)) {
            const TerrainItem item = names_.of(one);
            if (names_.bytesOnDisk(item.page) == 0 ||
                (!items_.contains(item.key) && pages_.isGivenUp(item.page, start)))
                continue;
            if (known.insert(item.key).second)
                readable.push_back(one);
            break;
        }
    return readable;
}

std::vector<TileId> TerrainPaging::tilesOf(const Refinement& cut, const NeededTiles& needed) const {
    std::vector<TileId> tiles;
    std::unordered_set<std::uint32_t> normalTiles;
    cut.forEachLeaf([&](const TileId& tile) {
        if (!needed.contains(tile) || isEmpty(tile) || tile == index_.quadtree.top())
            return;
        tiles.push_back(tile);
        const TileId normals = index_.quadtree.normalTile(tile);
        if (normals != tile && normals != index_.quadtree.top() &&
            normalTiles.insert(index_.quadtree.tileIndex(normals)).second)
            tiles.push_back(normals);
    });
    return tiles;
}

std::uint64_t TerrainPaging::bytesOf(const Refinement& wanted, const NeededTiles& needed,
                                     const std::vector<TextureId>& textures) const {
    std::uint64_t bytes = 0;
    for (const TileId& tile : tilesOf(wanted, needed)) bytes += names_.of(tile).deviceBytes;
    for (const TextureId& texture : textures) bytes += names_.of(texture).deviceBytes;
    return bytes;
}

TerrainPaging::Result TerrainPaging::resultOf(Refinement drawn, const NeededTiles& needed,
                                              const std::vector<TextureId>& textures) const {
    std::unordered_set<std::uint32_t> missing;
    for (const TileId& leaf : needed.leaves())
        for (const TileId& tile : {leaf, index_.quadtree.normalTile(leaf)})
            if (!isResident(tile))
                missing.insert(index_.quadtree.pageIndex(tile));
    for (const TextureId& texture : textures)
        if (!isResident(texture))
            missing.insert(names_.of(texture).page);
    Result result{std::move(drawn), {}, missing.size(), 0, tilesDecodedOnGpu_};
    for (const std::uint32_t page : missing) result.pagesFailed += pages_.isFailing(page) ? 1 : 0;
    return result;
}

TerrainPaging::Result TerrainPaging::approach(const Refinement& wanted, const NeededTiles& needed,
                                              const std::vector<TextureId>& textures,
                                              const lod::ObjectView& view, const ViewTurn& turn,
                                              const Prefetch& prefetch) {
    ViewClaim& claim = beginFrame(turn);
    tilesDecodedOnGpu_ = 0;
    Refinement drawn = drawable(wanted, needed);
    // What is drawn stays, with the normals it is drawn with; then comes what lies below it, then,
    // against the day when the camera draws back, what lies above.
    std::vector<TileId> below;
    std::vector<TileId> above;
    std::uint64_t drawnBytes = 0;
    const auto sort = [&](const TileId& tile) {
        const bool isTop = tile == index_.quadtree.top();
        if (isTop || !isStored(tile))
            return;
        const bool isReached = drawn.isSplit(Quadtree::parent(tile));
        const bool isDrawn = !drawn.isSplit(tile) ||
                             (tile.level == index_.quadtree.normalLevel() && isResident(tile));
        if (isReached && isDrawn) {
            rankAs(index_.quadtree.tileIndex(tile), 0, claim);
            drawnBytes += terrain::estimatedTileBytes(index_, tile);
        } else {
            (isReached ? above : below).push_back(tile);
        }
    };
    for (const TileId& tile : needed.leaves()) sort(tile);
    for (const TileId& tile : needed.inner()) sort(tile);
    std::vector<TextureId> texturesBelow;
    std::vector<TextureId> texturesAbove;
    drawnBytes += sortTextures(textures, texturesBelow, texturesAbove, claim);
    std::vector<TerrainItem> order = names_.inOrder(below, texturesBelow, view);
    const bool isUrgent = std::any_of(order.begin(), order.end(), [&](const TerrainItem& item) {
        return !items_.contains(item.key);
    });
    const std::vector<TerrainItem> last = names_.inOrder(above, texturesAbove, view);
    order.insert(order.end(), last.begin(), last.end());
    rankItems(order, drawnBytes, claim);
    claim.pages = missingPages();
    if (!isUrgent)
        for (const TerrainItem& item : prefetch())
            if (!items_.contains(item.key))
                claim.soon.push_back(item.page);
    claims_.rankOthers(turn, items_, 0);
    claims_.want(pages_);
    const page::HostPages::Loads loaded = pages_.tryTake();
    if (upload(kUploadTime))
        drawn = drawable(wanted, needed);
    claim.pages = missingPages();
    pages_.tryWish();
    Result result = resultOf(std::move(drawn), needed, textures);
    result.loaded = loaded;
    return result;
}

TerrainPaging::Result TerrainPaging::reach(const Refinement& wanted, const NeededTiles& needed,
                                           const std::vector<TextureId>& textures,
                                           const lod::ObjectView& view, const ViewTurn& turn,
                                           const std::stop_token& stop) {
    const auto start = Clock::now();
    page::HostPages::Loads loaded;
    tilesDecodedOnGpu_ = 0;
    while (!stop.stop_requested()) {
        ViewClaim& claim = beginFrame(turn);
        Refinement readable = wanted;
        const auto mayCome = [&](const TileId& tile) {
            return isResident(tile) || !pages_.isGivenUp(index_.quadtree.pageIndex(tile), start);
        };
        readable.coarsen([&](const TileId& tile) {
            return !needed.contains(tile) || isEmpty(tile) ||
                   (mayCome(tile) && mayCome(index_.quadtree.normalTile(tile)));
        });
        rankItems(names_.inOrder(tilesOf(readable, needed), readableOf(textures, start), view), 0,
                  claim);
        if (missing_.empty())
            break;
        claims_.rankOthers(turn, items_, static_cast<std::uint32_t>(claim.items.size()) + 1);
        for (const std::uint32_t page : missingPages()) pages_.want(page);
        const page::HostPages::Loads arrived = pages_.take();
        loaded.add(arrived);
        const bool hasUploaded = upload(std::chrono::hours(1));
        pages_.wish();
        // What could not be read is replaced by what lies above it: that is still to be wished for.
        if (missing_.empty() || (!hasUploaded && !arrived.hasFailed && !pages_.wait(stop)))
            break;
    }
    Result result = resultOf(drawable(wanted, needed), needed, textures);
    result.loaded = loaded;
    return result;
}

}  // namespace eyrie::draw
