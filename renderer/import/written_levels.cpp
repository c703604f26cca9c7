// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/written_levels.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <numeric>
#include <span>
#include <vector>

#include "fabric/status.h"

namespace eyrie::import {
namespace {

/// A second of work or a few, which a killed import does again.
constexpr std::uint32_t kPagesAtOnce = 64;

/// Pages of one level, one after the other.
struct Batch {
    std::uint32_t first = 0;
    std::uint32_t end = 0;
};

/// What `index` says of the pages of a batch, and then of their tiles.
std::vector<std::byte> stateOf(const Batch& batch, const terrain::EytIndex& index) {
    const auto pages =
        std::as_bytes(std::span(index.pages).subspan(batch.first, batch.end - batch.first));
    std::vector<std::byte> state(pages.begin(), pages.end());
    for (std::uint32_t page = batch.first; page < batch.end; ++page)
        forEachTileOfPage(index.quadtree, page, [&](const terrain::TileId& tile, int) {
            const auto record = std::as_bytes(std::span(&index.tile(tile), 1));
            state.insert(state.end(), record.begin(), record.end());
        });
    return state;
}

/// False, with `index` and `writer` as they were, where this is no such state or the pages are not
/// in the file.
bool restore(const Batch& batch, std::span<const std::byte> state, terrain::EytIndex& index,
             terrain::EytWriter& writer) {
    std::size_t tiles = 0;
    for (std::uint32_t page = batch.first; page < batch.end; ++page)
        forEachTileOfPage(index.quadtree, page, [&](const terrain::TileId&, int) { ++tiles; });
    std::vector<terrain::PageRecord> pages(batch.end - batch.first);
    const std::size_t pagesBytes = pages.size() * sizeof(terrain::PageRecord);
    if (state.size() != pagesBytes + tiles * sizeof(terrain::TileRecord))
        return false;
    std::memcpy(pages.data(), state.data(), pagesBytes);
    if (!writer.takeWritten(pages))
        return false;
    std::copy(pages.begin(), pages.end(), index.pages.begin() + batch.first);
    state = state.subspan(pagesBytes);
    for (std::uint32_t page = batch.first; page < batch.end; ++page)
        forEachTileOfPage(index.quadtree, page, [&](const terrain::TileId& tile, int) {
            std::memcpy(&index.tiles[index.quadtree.tileIndex(tile)], state.data(),
                        sizeof(terrain::TileRecord));
            state = state.subspan(sizeof(terrain::TileRecord));
        });
    return true;
}

absl::Status write(const Batch& batch, const PageSources& sources, const terrain::Scratch& scratch,
                   const ImportControl& control, terrain::EytIndex& index,
                   terrain::EytWriter& writer) {
    std::vector<std::uint32_t> pages(batch.end - batch.first);
    std::iota(pages.begin(), pages.end(), batch.first);
    ImportControl ofAll = control;
    ofAll.progress = [&](std::string_view stage, double fraction) {
        control.report(stage, (batch.first + fraction * static_cast<double>(pages.size())) /
                                  index.quadtree.pageCount());
    };
    return buildPages(sources, pages, scratch, ofAll, index,
                      [&](std::uint32_t page, std::span<const std::uint32_t> bytes) {
                          absl::StatusOr<terrain::PageRecord> record = writer.addPage(bytes);
                          if (record.ok())
                              index.pages[page] = *record;
                          return record.status();
                      });
}

std::uint32_t firstPageOf(const terrain::Quadtree& quadtree, int level) {
    return level < quadtree.levels() ? quadtree.pageIndex({level, 0, 0}) : quadtree.pageCount();
}

}  // namespace

absl::Status writeLevels(int first, int end, const PageSources& sources,
                         const terrain::Scratch& scratch, const ImportControl& control,
                         TerrainStages& stages, terrain::EytIndex& index,
                         terrain::EytWriter& writer) {
    for (int level = first; level < end; ++level) {
        const std::uint32_t endPage = firstPageOf(index.quadtree, level + 1);
        for (std::uint32_t page = firstPageOf(index.quadtree, level); page < endPage;
             page += kPagesAtOnce) {
            RETURN_IF_ERROR(control.check());
            const Batch batch{page, std::min(page + kPagesAtOnce, endPage)};
            RETURN_IF_ERROR(stages.run(
                [&] { return write(batch, sources, scratch, control, index, writer); },
                {[&] { return stateOf(batch, index); },
                 [&](const auto& state) { return restore(batch, state, index, writer); }}));
        }
    }
    return absl::OkStatus();
}

}  // namespace eyrie::import
