// SPDX-License-Identifier: Apache-2.0
#include "renderer/draw/terrain_draw.h"

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "fabric/status.h"
#include "renderer/draw/box_lines.h"
#include "renderer/draw/needed_tiles.h"
#include "renderer/draw/node_work.h"
#include "renderer/draw/object_program.h"
#include "renderer/draw/page_bounds.h"
#include "renderer/draw/prefetch.h"
#include "renderer/draw/range_step.h"
#include "renderer/draw/seen_boxes.h"
#include "renderer/draw/tau_choice.h"
#include "renderer/draw/terrain_ahead.h"
#include "renderer/draw/terrain_error.h"
#include "renderer/draw/terrain_ground.h"
#include "renderer/draw/terrain_items.h"
#include "renderer/draw/terrain_look.h"
#include "renderer/draw/terrain_tiles.h"
#include "renderer/draw/tile_imagery.h"
#include "renderer/draw/tint.h"
#include "renderer/gl/object.h"
#include "renderer/pick/terrain_surface.h"
#include "renderer/terrain/backs.h"
#include "renderer/terrain/eyt_format.h"
#include "renderer/terrain/part_bounds.h"
#include "renderer/terrain/terrain_cut.h"
#include "renderer/terrain/tile_bytes.h"

namespace eyrie::draw {
namespace {

using effects::TerrainEffect;

constexpr glm::vec3 kPageColour(1.0F, 0.9F, 0.3F);  ///< of the bounds of pages; linear
constexpr double kElevationBands = 5;               ///< of effects/terrain.effect

/// Where memory is short, texels grow as tau does.
double texelPixels(int step) { return terrain::kTexelPixels * page::TauLadder::factor(step); }

/// Calls `draw` with those stretches of `tile`'s part `part` that may be seen, in their order.
template <typename Draw>
void forEachSeen(const SeenBoxes& seen, const terrain::EytIndex& index, const terrain::TileId& id,
                 const DeviceTile& tile, int part, const Draw& draw) {
    const terrain::IndexRange& range = tile.parts[static_cast<std::size_t>(part)];
    auto block =
        std::ranges::lower_bound(tile.blocks, range.first, {}, &terrain::TriangleBlock::first);
    for (; block != tile.blocks.end() && block->first < range.first + range.count; ++block)
        if (seen.sees(terrain::bounds(index, id, *block)))
            draw(terrain::IndexRange{block->first, block->count});
}

class TerrainDrawable : public Drawable {
public:
    TerrainDrawable(const fabric::SceneObject& object, TerrainPrograms& programs,
                    std::shared_ptr<const terrain::EytFile> file,
                    std::unique_ptr<TerrainPaging> paging)
        : programs_(programs),
          worldFromObject_(object.worldFromObject),
          file_(std::move(file)),
          bounds_(index().bounds()),
          triangles_(index().triangles()),
          needed_(index()),
          look_(index()),
          paging_(std::move(paging)),
          imagery_(index(), *paging_) {
        TerrainEffect::kPackedVertexFromUint32x1.define(shortVertices_);
        TerrainEffect::kPackedVertexFromUint32x2.define(longVertices_);
    }

    fabric::Box bounds() const override { return bounds_; }
    std::uint64_t triangles() const override { return triangles_; }
    fabric::DataFile file() const override { return {file_->sizeBytes(), file_->checksum()}; }

    std::unique_ptr<const pick::Surface> surface(const fabric::SceneObject& object) const override {
        return pick::terrainSurface(object, file_);
    }

    std::uint64_t viewTriangles(const CutRequest& request) override;
    /// All as if it were seen.
    double viewWork(const CutRequest& request) override {
        return kWorkOfSeen * static_cast<double>(viewTriangles(request));
    }
    Cut selectCut(const CutRequest& request) override;
    double errorPixels(const CutRequest& request, occlusion::HiddenGround* hidden) override {
        return TerrainError(index(), *paging_, needed_, request, hidden).pixels(drawn_);
    }
    std::vector<fabric::Box> partBounds(const Piece& piece) const override {
        return terrain::partBounds(index(), drawn_.tiles[piece.index].id);
    }
    absl::Status draw(std::span<const Piece> pieces, const FrameState& frame,
                      fabric::FrameStatistics& statistics) override;
    MemoryUse memory() const override { return paging_->memory(); }
    std::optional<fabric::GroundGrid> ground(int maxCells) const override {
        return groundOf(index(), worldFromObject_, maxCells);
    }

private:
    const terrain::EytIndex& index() const { return file_->index(); }
    void use(const TerrainEffect& program, const FrameState& frame);
    void setSides(const FrameState& frame, const lod::ObjectView& view) const;
    void addPageBounds(const terrain::TerrainCut& wanted, std::vector<Piece>& pieces) const;
    /// What a view wants at one tau.
    struct Wanted {
        terrain::Refinement refinement;
        terrain::TerrainCut cut;
    };
    Wanted wantedOf(const lod::ObjectView& view, double tauPixels) const;
    const Wanted& wantedAt(double tauPixels, const lod::ObjectView& view);
    std::vector<NeededItem> itemsOf(const lod::ObjectView& view, const terrain::TerrainCut& cut,
                                    double texelPixels);
    std::vector<NeededItem> neededItems(const lod::ObjectView& view, double texelPixels) const;
    const Wanted& need(const CutRequest& request, int step);
    std::uint64_t bytesOf(const CutRequest& request, int step);
    int stepOf(const CutRequest& request, int first);
    /// By variant; null: not used in the frame so far.
    using PicturePrograms =
        std::array<const TerrainEffect*, TerrainEffect::Variant::kMaxImagery + 1>;
    absl::StatusOr<const TerrainEffect*> programFor(const terrain::ImageryPart& part,
                                                    const FrameState& frame,
                                                    PicturePrograms& programs);
    void useNormals(const TerrainEffect& program, const terrain::TileId& tile);
    std::uint64_t drawTile(const TerrainEffect& program, const terrain::TileChoice& choice,
                           const DeviceTile& tile, const SeenBoxes& seen);

    TerrainPrograms& programs_;
    fabric::Mat4 worldFromObject_;
    std::shared_ptr<const terrain::EytFile> file_;
    fabric::Box bounds_;
    std::uint64_t triangles_;
    gl::VertexArray shortVertices_;  ///< one word a vertex; the second reads as 0
    gl::VertexArray longVertices_;   ///< two words
    NeededTiles needed_;
    PerView<Prefetch> prefetch_;
    TerrainLook look_;
    BoxLines boxLines_;
    std::unique_ptr<TerrainPaging> paging_;
    TileImagery imagery_;
    TauChoice tau_;
    std::map<double, Wanted> wanted_;  ///< of the view that is about to be drawn, by tau
    terrain::TerrainCut drawn_;        ///< the last cut; pieces index its tiles
    std::vector<GLsizei> runCounts_;   ///< what drawTile draws; keep their memory
    std::vector<const void*> runOffsets_;
};

TerrainDrawable::Wanted TerrainDrawable::wantedOf(const lod::ObjectView& view,
                                                  double tauPixels) const {
    terrain::Refinement refinement = terrain::refineForError(index(), view, tauPixels);
    terrain::TerrainCut cut = terrain::cutOf(index(), view, refinement);
    return {std::move(refinement), std::move(cut)};
}

const TerrainDrawable::Wanted& TerrainDrawable::wantedAt(double tauPixels,
                                                         const lod::ObjectView& view) {
    const auto known = wanted_.find(tauPixels);
    return known != wanted_.end()
               ? known->second
               : wanted_.emplace(tauPixels, wantedOf(view, tauPixels)).first->second;
}

/// The cut's visible tiles and texture tiles, and all above, which may stand in.
std::vector<NeededItem> TerrainDrawable::itemsOf(const lod::ObjectView& view,
                                                 const terrain::TerrainCut& cut,
                                                 double texelPixels) {
    needed_.assign(cut, cut, {view, view.view().frustum, {}, 1, {}});
    return neededItems(view, texelPixels);
}

/// With all that may stand in.
std::vector<NeededItem> TerrainDrawable::neededItems(const lod::ObjectView& view,
                                                     double texelPixels) const {
    std::vector<NeededItem> items;
    for (const auto* tiles : {&needed_.leaves(), &needed_.inner()})
        for (const terrain::TileId& tile : *tiles)
            if (tile != index().quadtree.top())
                items.push_back(
                    {index().quadtree.tileIndex(tile), terrain::estimatedTileBytes(index(), tile)});
    for (const TerrainItem& item : imagery_.itemsOf(needed_.leaves(), view, texelPixels))
        items.push_back({item.key, item.deviceBytes});
    return items;
}

std::uint64_t TerrainDrawable::viewTriangles(const CutRequest& request) {
    std::uint64_t triangles = 0;
    for (const terrain::TileChoice& tile : wantedAt(request.tauPixels, request.view).cut.tiles)
        if (tile.isVisible)
            triangles += index().tile(tile.id).triangles;
    return triangles;
}

/// Sets what the channel needs at a step of the ladder, and returns what the view wants there.
const TerrainDrawable::Wanted& TerrainDrawable::need(const CutRequest& request, int step) {
    const Wanted& wanted =
        wantedAt(request.tauPixels * page::TauLadder::factor(step), request.view);
    needed_.assign(wanted.cut, wantedAt(request.tauPixels, request.view).cut, request);
    return wanted;
}

/// What the channel brings to the device at a step. A complete frame needs nothing that stands in;
/// others come to what they need by way of it.
std::uint64_t TerrainDrawable::bytesOf(const CutRequest& request, int step) {
    const Wanted& wanted = need(request, step);
    if (request.completeness == fabric::Completeness::Complete)
        return paging_->bytesOf(
            wanted.refinement, needed_,
            imagery_.texturesOf(needed_.leaves(), request.view, texelPixels(step)));
    std::uint64_t sum = 0;
    for (const NeededItem& item : neededItems(request.view, texelPixels(step))) sum += item.bytes;
    return sum;
}

/// Where channels' steps are equal, tiles meet.
int TerrainDrawable::stepOf(const CutRequest& request, int first) {
    // Of the whole view, as ever: channels that see parts of it come to the same step, too.
    CutRequest part{
        request.view, request.view.view().frustum, {}, request.tauPixels, request.completeness};
    return stepOfRange(request.range, first, paging_->roomBytes(),
                       [&](const fabric::Range& range, int step) {
                           part.range = range;
                           return bytesOf(part, step);
                       });
}

Cut TerrainDrawable::selectCut(const CutRequest& request) {
    const page::TauLadder::Choice choice = tau_.choose(
        request,
        [&](const lod::ObjectView& view, double tauPixels, int step) {
            return &view == &request.view
                       ? itemsOf(view, wantedAt(tauPixels, view).cut, texelPixels(step))
                       : itemsOf(view, wantedOf(view, tauPixels).cut, texelPixels(step));
        },
        paging_->roomBytes());
    const int step = stepOf(request, choice.step);
    const double tauPixels = request.tauPixels * page::TauLadder::factor(step);
    const Wanted& wanted = need(request, step);
    Prefetch& prefetch = prefetch_.of(request.turn);
    prefetch.follow(request.view.view(),
                    fabric::exaggerated(worldFromObject_, request.exaggeration),
                    Prefetch::Clock::now());
    const std::vector<terrain::TextureId> textures =
        imagery_.texturesOf(needed_.leaves(), request.view, texelPixels(step));
    const TerrainPaging::Result result =
        request.completeness == fabric::Completeness::Complete
            ? paging_->reach(wanted.refinement, needed_, textures, request.view, request.turn,
                             request.stop)
            : paging_->approach(
                  wanted.refinement, needed_, textures, request.view, request.turn, [&] {
                      return itemsAhead(prefetch, index(), paging_->items(), tauPixels,
                                        texelPixels(step), paging_->latency());
                  });

    Cut cut;
    cut.isComplete = result.pagesMissing == 0 && choice.isLowest;
    cut.memoryRaisedTau = step > 0;
    cut.pagesLoaded = result.loaded.pages;
    cut.tilesDecodedOnGpu = result.tilesDecodedOnGpu;
    cut.bytesLoaded = result.loaded.bytes;
    cut.pagesMissing = result.pagesMissing;
    cut.pagesFailed = result.pagesFailed;
    drawn_ = terrain::cutOf(index(), request.view, result.drawn);
    for (std::uint32_t i = 0; i < drawn_.tiles.size(); ++i)
        if (const terrain::TileId& id = drawn_.tiles[i].id; needed_.contains(id))
            cut.pieces.push_back(
                {i, needed_.position(id), index().bounds(id), true, index().tile(id).triangles});
    imagery_.choose(drawn_.tiles, cut.pieces, request.view, texelPixels(step),
                    request.isFrozen ? terrain::Unseen::Coarsest : terrain::Unseen::LeftOut);
    if (request.wantsPageBounds)
        addPageBounds(wanted.cut, cut.pieces);
    wanted_.clear();
    return cut;
}

void TerrainDrawable::addPageBounds(const terrain::TerrainCut& wanted,
                                    std::vector<Piece>& pieces) const {
    const std::vector<Piece> pages = pagePieces(index(), wanted);
    pieces.insert(pieces.end(), pages.begin(), pages.end());
    std::stable_sort(pieces.begin(), pieces.end(), [](const Piece& a, const Piece& b) {
        return a.rangePosition < b.rangePosition;
    });
}

void TerrainDrawable::use(const TerrainEffect& program, const FrameState& frame) {
    const double step = index().heightStepMetres();
    const double lowest = (bounds_.min.z - index().heightOriginMetres()) / step;
    const double heights = std::max((bounds_.max.z - bounds_.min.z) / step, 1.0);
    program.use();
    setObject(program, frame, fabric::exaggerated(worldFromObject_, frame.look.exaggeration),
              index().objectFromLattice);
    look_.use(program, worldFromObject_, frame);
    program.lastPost({index().quadtree.columns() - 1, index().quadtree.rows() - 1});
    program.lowestHeight(static_cast<float>(lowest));
    program.bandsPerHeight(static_cast<float>(kElevationBands / heights));
}

/// Fronts are what faces up in the terrain's own space. Backs are left out where fronts hide them
/// all; lines have no sides.
void TerrainDrawable::setSides(const FrameState& frame, const lod::ObjectView& view) const {
    glFrontFace(glm::determinant(fabric::Mat3(view.viewFromObject())) < 0 ? GL_CW : GL_CCW);
    if (frame.shading != fabric::Shading::Wireframe &&
        terrain::hidesItsBacks(index(), drawn_, view))
        glEnable(GL_CULL_FACE);
}

void TerrainDrawable::useNormals(const TerrainEffect& program, const terrain::TileId& tile) {
    const terrain::TileId id = index().quadtree.normalTile(tile);
    program.normalOrigin(
        {id.x * terrain::Quadtree::side(id.level), id.y * terrain::Quadtree::side(id.level)});
    program.normalMap(*paging_->tile(id)->normalMap);
}

/// Draws the interior and one form of each edge, but for what the channel does not see; returns the
/// triangles of all of that.
std::uint64_t TerrainDrawable::drawTile(const TerrainEffect& program,
                                        const terrain::TileChoice& choice, const DeviceTile& tile,
                                        const SeenBoxes& seen) {
    const terrain::TileId& id = choice.id;
    program.tileOrigin({id.x * terrain::Quadtree::side(id.level),
                        id.y * terrain::Quadtree::side(id.level), tile.baseHeight});
    program.spacingShift(terrain::Quadtree::spacingShift(id.level));
    program.heightMultiplier(tile.heightMultiplier);

    const bool isShort = tile.vertexStride == 4;
    const gl::VertexArray& array = isShort ? shortVertices_ : longVertices_;
    const auto& packedVertex = isShort ? TerrainEffect::kPackedVertexFromUint32x1
                                       : TerrainEffect::kPackedVertexFromUint32x2;
    glBindVertexArray(array.id());
    packedVertex.source(array, tile.buffer, 0);
    glVertexArrayElementBuffer(array.id(), tile.buffer.id());

    // Stretches that follow each other are drawn as one: without finer neighbours, all of the tile.
    runCounts_.clear();
    runOffsets_.clear();
    std::uint32_t end = 0;  // of the last run
    const auto add = [&](const terrain::IndexRange& range) {
        if (range.count == 0)
            return;
        if (runCounts_.empty() || range.first != end) {
            runOffsets_.push_back(reinterpret_cast<const void*>(
                tile.indexOffset + static_cast<GLintptr>(range.first) * 2));
            runCounts_.push_back(0);
        }
        runCounts_.back() += static_cast<GLsizei>(range.count);
        end = range.first + range.count;
    };
    const bool isAllSeen = tile.blocks.empty() || seen.seesAll(index().bounds(id));
    std::uint64_t indices = 0;
    for (const int part : drawnParts(choice)) {
        const terrain::IndexRange& range = tile.parts[static_cast<std::size_t>(part)];
        indices += range.count;
        if (isAllSeen)
            add(range);
        else
            forEachSeen(seen, index(), id, tile, part, add);
    }
    if (!runCounts_.empty())
        glMultiDrawElements(GL_TRIANGLES, runCounts_.data(), GL_UNSIGNED_SHORT, runOffsets_.data(),
                            static_cast<GLsizei>(runCounts_.size()));
    return indices / 3;
}

/// The program for a part of a tile, in use and with the frame's uniforms.
absl::StatusOr<const TerrainEffect*> TerrainDrawable::programFor(const terrain::ImageryPart& part,
                                                                 const FrameState& frame,
                                                                 PicturePrograms& programs) {
    TerrainEffect::Variant variant = TerrainLook::variantFor(frame, worldFromObject_);
    variant.imagery = !part.isWhole() ? 2 : part.texture ? 1 : 0;
    const TerrainEffect*& program = programs[static_cast<std::size_t>(variant.imagery)];
    if (program == nullptr) {
        ASSIGN_OR_RETURN(program, programs_.find(variant));
        use(*program, frame);
    }
    program->use();
    return program;
}

absl::Status TerrainDrawable::draw(std::span<const Piece> pieces, const FrameState& frame,
                                   fabric::FrameStatistics& statistics) {
    PicturePrograms programs{};
    if (frame.look.tileBounds || frame.look.pageBounds)
        RETURN_IF_ERROR(boxLines_.begin(
            frame.view, fabric::exaggerated(worldFromObject_, frame.look.exaggeration)));
    const lod::ObjectView view(frame.view,
                               fabric::exaggerated(worldFromObject_, frame.look.exaggeration));
    setSides(frame, view);
    const SeenBoxes seen(view, frame);
    for (const Piece& piece : pieces) {
        if (!piece.isNode) {
            boxLines_.draw(piece.bounds, kPageColour);
            continue;
        }
        const terrain::TileChoice& choice = drawn_.tiles[piece.index];
        for (const terrain::ImageryPart& part : imagery_.partsOf(choice.id)) {
            ASSIGN_OR_RETURN(const TerrainEffect* program, programFor(part, frame, programs));
            TerrainLook::tint(*program, frame, choice.id.level);
            useNormals(*program, choice.id);
            imagery_.use(*program, choice.id, part);
            statistics.triangles += drawTile(*program, choice, *paging_->tile(choice.id), seen);
        }
        // At once, so that where depths tie the lower range wins as in compositing.
        if (frame.look.tileBounds)
            boxLines_.draw(piece.bounds, levelColour(choice.id.level));
    }
    glDisable(GL_CULL_FACE);
    return absl::OkStatus();
}

}  // namespace

MemoryUse greatestUse(const terrain::EytFile& file, TextureFormat format) {
    return TerrainItems(file.index(), format).greatestUse();
}

absl::StatusOr<std::unique_ptr<Drawable>> openTerrain(
    const fabric::SceneObject& object, std::shared_ptr<const terrain::EytFile> file,
    TerrainPrograms& programs, page::Loader& loader, const TerrainMemory& limits,
    TextureFormat format, DecodeChoice& decoding) {
    ASSIGN_OR_RETURN(TileDecoder * decoder, decoding.decoderFor(*file));
    ASSIGN_OR_RETURN(std::unique_ptr<TerrainPaging> paging,
                     TerrainPaging::open(file, loader, limits, format, decoder));
    return std::make_unique<TerrainDrawable>(object, programs, std::move(file), std::move(paging));
}

}  // namespace eyrie::draw
