// SPDX-License-Identifier: Apache-2.0
#include "renderer/draw/terrain_draw.h"

#include <algorithm>
#include <utility>

#include "fabric/status.h"
#include "renderer/draw/object_program.h"
#include "renderer/gl/object.h"
#include "renderer/page/lru_cache.h"
#include "renderer/terrain/eyt_format.h"
#include "renderer/terrain/terrain_cut.h"

namespace eyrie::draw {
namespace {

using effects::TerrainEffect;

constexpr double kElevationBands = 5;  ///< of effects/terrain.effect
/// Pages kept in host memory after their tiles are on the device: neighbours are asked for next.
constexpr std::uint64_t kHostPageBytes = std::uint64_t{64} << 20;

/// A tile on the device: words and indices in one buffer, and its normal map.
struct DeviceTile {
    gl::Buffer buffer;
    gl::Texture2D normalMap;
    GLintptr indexOffset = 0;
    GLsizei vertexStride = 4;
    std::array<terrain::IndexRange, terrain::kTileParts> parts;
    std::int32_t baseHeight = 0;
    std::int32_t heightMultiplier = 1;
};

gl::Texture2D uploadNormals(std::span<const std::int8_t> normals, GLsizei side) {
    gl::Texture2D texture;
    glTextureStorage2D(texture.id(), 1, GL_RG8_SNORM, side, side);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glTextureSubImage2D(texture.id(), 0, 0, 0, side, side, GL_RG, GL_BYTE, normals.data());
    glTextureParameteri(texture.id(), GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    glTextureParameteri(texture.id(), GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    glTextureParameteri(texture.id(), GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glTextureParameteri(texture.id(), GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    return texture;
}

DeviceTile upload(const terrain::TileGeometry& geometry, std::uint64_t& bytesUsed) {
    DeviceTile tile;
    const auto words = static_cast<GLsizeiptr>(geometry.words.size_bytes());
    const auto indices = static_cast<GLsizeiptr>(geometry.indices.size_bytes());
    glNamedBufferStorage(tile.buffer.id(), words + indices, nullptr, GL_DYNAMIC_STORAGE_BIT);
    glNamedBufferSubData(tile.buffer.id(), 0, words, geometry.words.data());
    glNamedBufferSubData(tile.buffer.id(), words, indices, geometry.indices.data());
    tile.normalMap = uploadNormals(geometry.normals, geometry.cells + 1);
    tile.indexOffset = words;
    tile.vertexStride = 4 * geometry.wordsPerVertex;
    tile.parts = geometry.parts;
    tile.baseHeight = geometry.baseHeight;
    tile.heightMultiplier = geometry.heightMultiplier;
    bytesUsed = static_cast<std::uint64_t>(words + indices) + geometry.normals.size_bytes();
    return tile;
}

class TerrainDrawable : public Drawable {
public:
    TerrainDrawable(const fabric::SceneObject& object, TerrainPrograms& programs,
                    std::shared_ptr<const terrain::EytFile> file, std::uint64_t memoryBytes)
        : programs_(programs),
          worldFromObject_(object.worldFromObject),
          file_(std::move(file)),
          bounds_(index().bounds()),
          triangles_(index().triangles()),
          hostPages_(kHostPageBytes),
          deviceTiles_(memoryBytes) {
        TerrainEffect::kPackedVertexFromUint32x1.define(shortVertices_);
        TerrainEffect::kPackedVertexFromUint32x2.define(longVertices_);
    }

    fabric::Box bounds() const override { return bounds_; }
    std::uint64_t triangles() const override { return triangles_; }
    std::uint64_t bytes() const override { return file_->sizeBytes(); }

    Cut selectCut(const lod::ObjectView& view, double tauPixels) override;
    absl::Status draw(std::span<const Piece> pieces, const FrameState& frame,
                      fabric::FrameStatistics& statistics) override;
    void trim() override {
        hostPages_.trim();
        deviceTiles_.trim();
    }

private:
    const terrain::EytIndex& index() const { return file_->index(); }
    void use(const TerrainEffect& program, const FrameState& frame) const;
    absl::StatusOr<const terrain::Page*> hostPage(std::uint32_t page,
                                                  fabric::FrameStatistics& statistics);
    absl::StatusOr<const DeviceTile*> deviceTile(const terrain::TileId& id,
                                                 fabric::FrameStatistics& statistics);
    std::uint64_t drawTile(const TerrainEffect& program, const terrain::TileChoice& choice,
                           const DeviceTile& tile) const;

    TerrainPrograms& programs_;
    fabric::Mat4 worldFromObject_;
    std::shared_ptr<const terrain::EytFile> file_;
    fabric::Box bounds_;
    std::uint64_t triangles_;
    gl::VertexArray shortVertices_;  ///< one word a vertex; the second reads as 0
    gl::VertexArray longVertices_;   ///< two words
    page::LruCache<std::uint32_t, std::shared_ptr<const terrain::Page>> hostPages_;
    page::LruCache<std::uint32_t, DeviceTile> deviceTiles_;
    std::vector<terrain::TileChoice> choices_;  ///< of the last cut; pieces index it
};

/// The range is a share of the visible cut, by triangles: every channel of the frame computes the
/// same cut, so their shares meet exactly.
Cut TerrainDrawable::selectCut(const lod::ObjectView& view, double tauPixels) {
    terrain::TerrainCut tiles = terrain::selectCut(index(), view, tauPixels);
    choices_ = std::move(tiles.tiles);
    Cut cut;
    cut.tauAchievedPixels = tiles.tauAchievedPixels;
    std::uint64_t total = 0;
    for (std::uint32_t i = 0; i < choices_.size(); ++i) {
        const fabric::Box box = index().bounds(choices_[i].id);
        if (!view.isVisible(box))
            continue;
        cut.pieces.push_back({i, static_cast<double>(total), box});
        total += index().tile(choices_[i].id).triangles;
    }
    for (Piece& piece : cut.pieces) piece.rangePosition /= static_cast<double>(total);
    return cut;
}

void TerrainDrawable::use(const TerrainEffect& program, const FrameState& frame) const {
    const double step = index().heightStepMetres();
    const double lowest = (bounds_.min.z - index().heightOriginMetres()) / step;
    const double heights = std::max((bounds_.max.z - bounds_.min.z) / step, 1.0);
    program.use();
    setObject(program, frame, worldFromObject_, index().objectFromLattice);
    program.lastPost({index().quadtree.columns() - 1, index().quadtree.rows() - 1});
    program.lowestHeight(static_cast<float>(lowest));
    program.bandsPerHeight(static_cast<float>(kElevationBands / heights));
}

absl::StatusOr<const terrain::Page*> TerrainDrawable::hostPage(
    std::uint32_t page, fabric::FrameStatistics& statistics) {
    if (const auto* found = hostPages_.find(page); found != nullptr)
        return found->get();
    ASSIGN_OR_RETURN(std::shared_ptr<const terrain::Page> read, file_->readPage(page));
    ++statistics.pagesLoaded;
    const std::size_t bytes = read->sizeBytes();
    return hostPages_.insert(page, std::move(read), bytes).get();
}

absl::StatusOr<const DeviceTile*> TerrainDrawable::deviceTile(const terrain::TileId& id,
                                                              fabric::FrameStatistics& statistics) {
    const std::uint32_t key = index().quadtree.tileIndex(id);
    if (const DeviceTile* tile = deviceTiles_.find(key); tile != nullptr)
        return tile;
    ASSIGN_OR_RETURN(const terrain::Page* page,
                     hostPage(index().quadtree.pageIndex(id), statistics));
    std::uint64_t bytes = 0;
    DeviceTile tile = upload(page->tile(terrain::Quadtree::placeInPage(id)), bytes);
    return &deviceTiles_.insert(key, std::move(tile), bytes);
}

/// Draws the interior and one form of each edge; returns the triangles.
std::uint64_t TerrainDrawable::drawTile(const TerrainEffect& program,
                                        const terrain::TileChoice& choice,
                                        const DeviceTile& tile) const {
    const terrain::TileId& id = choice.id;
    program.tileOrigin({id.x * terrain::Quadtree::side(id.level),
                        id.y * terrain::Quadtree::side(id.level), tile.baseHeight});
    program.spacingShift(terrain::Quadtree::spacingShift(id.level));
    program.heightMultiplier(tile.heightMultiplier);
    program.normalMap(tile.normalMap);

    const bool isShort = tile.vertexStride == 4;
    const gl::VertexArray& array = isShort ? shortVertices_ : longVertices_;
    const auto& packedVertex = isShort ? TerrainEffect::kPackedVertexFromUint32x1
                                       : TerrainEffect::kPackedVertexFromUint32x2;
    glBindVertexArray(array.id());
    packedVertex.source(array, tile.buffer, 0);
    glVertexArrayElementBuffer(array.id(), tile.buffer.id());

    std::array<GLsizei, 1 + terrain::kEdges> counts{};
    std::array<const void*, 1 + terrain::kEdges> offsets{};
    GLsizei parts = 0;
    std::uint64_t indices = 0;
    const auto add = [&](int part) {
        const terrain::IndexRange& range = tile.parts[static_cast<std::size_t>(part)];
        if (range.count == 0)
            return;
        const auto at = static_cast<std::size_t>(parts++);
        counts[at] = static_cast<GLsizei>(range.count);
        offsets[at] = reinterpret_cast<const void*>(tile.indexOffset +
                                                    static_cast<GLintptr>(range.first) * 2);
        indices += range.count;
    };
    add(terrain::kInteriorPart);
    for (int edge = 0; edge < terrain::kEdges; ++edge)
        add(((choice.finerEdges >> edge & 1) != 0 ? terrain::kFinerPart : terrain::kOwnPart) +
            edge);
    glMultiDrawElements(GL_TRIANGLES, counts.data(), GL_UNSIGNED_SHORT, offsets.data(), parts);
    return indices / 3;
}

absl::Status TerrainDrawable::draw(std::span<const Piece> pieces, const FrameState& frame,
                                   fabric::FrameStatistics& statistics) {
    ASSIGN_OR_RETURN(const TerrainEffect* program,
                     programs_.find(variantFor(frame, worldFromObject_)));
    use(*program, frame);
    for (const Piece& piece : pieces) {
        const terrain::TileChoice& choice = choices_[piece.index];
        ASSIGN_OR_RETURN(const DeviceTile* tile, deviceTile(choice.id, statistics));
        statistics.triangles += drawTile(*program, choice, *tile);
    }
    return absl::OkStatus();
}

}  // namespace

absl::StatusOr<std::unique_ptr<Drawable>> openTerrain(const fabric::SceneObject& object,
                                                      TerrainPrograms& programs,
                                                      std::uint64_t memoryBytes) {
    ASSIGN_OR_RETURN(std::shared_ptr<const terrain::EytFile> file,
                     terrain::EytFile::open(object.path));
    return std::make_unique<TerrainDrawable>(object, programs, std::move(file), memoryBytes);
}

}  // namespace eyrie::draw
