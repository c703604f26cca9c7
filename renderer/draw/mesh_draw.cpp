// SPDX-License-Identifier: Apache-2.0
#include "renderer/draw/mesh_draw.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include <fmt/format.h>
#include <glm/matrix.hpp>

#include "fabric/status.h"
#include "renderer/draw/box_lines.h"
#include "renderer/draw/hidden_backs.h"
#include "renderer/draw/mesh_cut.h"
#include "renderer/draw/mesh_paging.h"
#include "renderer/draw/mesh_textures.h"
#include "renderer/draw/object_program.h"
#include "renderer/draw/prefetch.h"
#include "renderer/draw/tau_choice.h"
#include "renderer/draw/tint.h"
#include "renderer/gl/object.h"
#include "renderer/mesh/eym_format.h"
#include "renderer/pick/mesh_surface.h"

namespace eyrie::draw {
namespace {

using Program = effects::MeshEffect;

std::uint32_t packedSrgb(const fabric::Vec3& linear) {
    const auto byte = [](double value) {
        return static_cast<std::uint32_t>(
            std::lround(std::sqrt(std::clamp(value, 0.0, 1.0)) * 255));
    };
    return byte(linear.x) | byte(linear.y) << 8 | byte(linear.z) << 16 | 0xFF000000U;
}

/// For Prefetch::nodes.
struct NodeTree {
    using Node = std::uint32_t;

    const mesh::EymFile& file;
    double tauPixels;
    bool mayBePoints;

    Node root() const { return 0; }
    fabric::Box bounds(Node node) const { return file.bounds(node); }
    double errorMetres(Node node) const {
        const mesh::Node& at = file.nodes()[node];
        if (at.isOfPoints() && mayBePoints)
            return std::max(at.errorMetres * std::max(tauPixels / kMostPointPixels, 1.0),
                            double{at.farthestMetres()});
        return at.indexCount > 0 ? at.farthestMetres() : std::numeric_limits<double>::infinity();
    }
    template <typename Visit>
    void forEachChild(Node node, const Visit& visit) const {
        const mesh::Node& at = file.nodes()[node];
        if (at.isLeaf())
            return;
        visit(static_cast<Node>(at.left));
        visit(static_cast<Node>(at.right));
    }
};

class MeshDrawable : public Drawable {
public:
    MeshDrawable(const fabric::SceneObject& object, MeshPrograms& programs,
                 PointPrograms& pointPrograms, std::shared_ptr<const mesh::EymFile> file,
                 MeshTextures textures, std::unique_ptr<MeshPaging> paging)
        : programs_(programs),
          worldFromObject_(object.worldFromObject),
          uniformColour_(packedSrgb(object.colour)),
          singleSided_(object.singleSided),
          file_(std::move(file)),
          lids_(file_->lids()),
          objectFromLattice_(file_->lattice().objectFromLattice()),
          textures_(std::move(textures)),
          points_(pointPrograms, *file_, object),
          paging_(std::move(paging)) {
        defineVertexFormat();
    }

    fabric::Box bounds() const override { return file_->bounds(); }
    std::uint64_t triangles() const override { return file_->triangleCount(); }
    fabric::DataFile file() const override { return {file_->fileBytes(), file_->checksum()}; }

    std::unique_ptr<const pick::Surface> surface(const fabric::SceneObject& object) const override {
        return pick::meshSurface(object, file_);
    }

    std::uint64_t viewTriangles(const CutRequest& request) override;
    Cut selectCut(const CutRequest& request) override;
    double errorPixels(const CutRequest&, occlusion::HiddenGround*) override {
        return errorPixels_;
    }
    absl::Status draw(std::span<const Piece> pieces, const FrameState& frame,
                      fabric::FrameStatistics& statistics) override;
    fabric::FileLights lights() const override { return file_->lights(); }
    MemoryUse memory() const override {
        MemoryUse use = paging_->memory();
        use.deviceBytes += textures_.bytes();
        return use;
    }

private:
    /// Points are lit as their triangles, but do not know which way these face.
    bool mayBePoints() const { return !singleSided_; }
    void defineVertexFormat();
    MeshCut cutNow(const lod::ObjectView& view, double tauPixels) const;
    const MeshCut& cutAt(int step, const CutRequest& request);
    std::vector<NeededItem> itemsOf(const MeshCut& cut) const;
    std::uint64_t countMissing(const MeshCut& cut) const;
    page::HostPages::Loads reach(const CutRequest& request, double tauPixels);
    std::uint64_t costOf(const CutNode& node) const;
    bool hasBlended(std::uint32_t node) const;
    void source(const DeviceNode& node) const;
    void bind(const FrameState& frame) const;
    void use(const Program& program, const FrameState& frame) const;
    std::uint32_t colourOf(const Piece& piece, const FrameState& frame) const;
    void colour(const Piece& piece, const FrameState& frame) const;
    int levelOf(std::uint32_t node) const;
    absl::Status drawWhole(std::span<const Piece> pieces, const FrameState& frame,
                           fabric::FrameStatistics& statistics);
    /// Programs of which the object is set.
    using Prepared = std::map<Program::Variant, const Program*>;
    absl::Status prepare(const mesh::Material& material, const FrameState& frame,
                         Prepared& prepared);
    absl::Status drawByMaterial(std::span<const Piece> pieces, const FrameState& frame,
                                fabric::FrameStatistics& statistics);
    absl::Status drawPoints(const Piece& piece, const FrameState& frame,
                            fabric::FrameStatistics& statistics);
    void drawRange(const DeviceNode& node, GLsizei first, const mesh::MaterialRange& range,
                   const Piece& piece, const HiddenBacks& backs) const;

    MeshPrograms& programs_;
    fabric::Mat4 worldFromObject_;
    std::uint32_t uniformColour_;
    bool singleSided_;
    std::shared_ptr<const mesh::EymFile> file_;
    std::vector<fabric::Box> lids_;
    fabric::Mat4 objectFromLattice_;
    MeshTextures textures_;
    double errorPixels_ = 0;  ///< of the last cut
    gl::VertexArray vertexArray_;
    MeshPoints points_;
    BoxLines boxLines_;
    std::unique_ptr<MeshPaging> paging_;
    PerView<Prefetch> prefetch_;
    TauChoice tau_;
    std::map<int, MeshCut> cuts_;  ///< of this view and tau, by step
};

void MeshDrawable::defineVertexFormat() {
    Program::kPackedPosition.define(vertexArray_);
    Program::kPackedNormal.define(vertexArray_);
    Program::kPackedColour.define(vertexArray_, file_->hasColours());
    Program::kPackedPlace.define(vertexArray_, file_->hasTextures());
}

MeshCut MeshDrawable::cutNow(const lod::ObjectView& view, double tauPixels) const {
    return cutOf(
        *file_, view, tauPixels, [this](std::uint32_t node) { return paging_->isResident(node); },
        mayBePoints());
}

const MeshCut& MeshDrawable::cutAt(int step, const CutRequest& request) {
    const auto known = cuts_.find(step);
    if (known != cuts_.end())
        return known->second;
    const double tauPixels = request.tauPixels * page::TauLadder::factor(step);
    return cuts_.emplace(step, cutNow(request.view, tauPixels)).first->second;
}

/// With what may stand in, whatever of it is there.
std::vector<NeededItem> MeshDrawable::itemsOf(const MeshCut& cut) const {
    std::vector<NeededItem> items;
    for (const auto* nodes : {&cut.wanted, &cut.between, &cut.above})
        for (const CutNode& node : *nodes)
            if (const std::uint64_t bytes = paging_->bytesOf(node.node); bytes > 0)
                items.push_back({node.node, bytes});
    return items;
}

std::uint64_t MeshDrawable::countMissing(const MeshCut& cut) const {
    return static_cast<std::uint64_t>(std::ranges::count_if(
        cut.wanted, [this](const CutNode& node) { return !paging_->isResident(node.node); }));
}

/// Waits for every page that can be read; what stands in for one that cannot is waited for, too.
page::HostPages::Loads MeshDrawable::reach(const CutRequest& request, double tauPixels) {
    const auto start = page::HostPages::Clock::now();
    const auto readable = [&] {
        return cutOf(
                   *file_, request.view, tauPixels,
                   [&](std::uint32_t node) { return paging_->mayCome(node, start); }, mayBePoints())
            .drawn;
    };
    page::HostPages::Loads loaded;
    page::HostPages::Loads round;
    std::vector<CutNode> needed = readable();
    while (paging_->reach(needed, request.turn, round, request.stop) &&
           !request.stop.stop_requested()) {
        loaded.add(round);
        if (round.hasFailed)
            needed = readable();
        round = {};
    }
    loaded.add(round);
    return loaded;
}

/// In triangles: a point takes about as long as one.
std::uint64_t MeshDrawable::costOf(const CutNode& node) const {
    return node.points > 0 ? node.points : file_->nodes()[node.node].indexCount / 3;
}

std::uint64_t MeshDrawable::viewTriangles(const CutRequest& request) {
    std::uint64_t triangles = 0;
    const MeshCut cut = cutOf(
        *file_, request.view, request.tauPixels, [](std::uint32_t) { return true; }, mayBePoints());
    for (const CutNode& node : cut.wanted) triangles += costOf(node);
    return triangles;
}

Cut MeshDrawable::selectCut(const CutRequest& request) {
    cuts_.clear();
    const page::TauLadder::Choice choice = tau_.choose(
        request,
        [&](const lod::ObjectView& view, double tauPixels, int step) {
            return itemsOf(&view == &request.view ? cutAt(step, request) : cutNow(view, tauPixels));
        },
        paging_->roomBytes());
    const double tauPixels = request.tauPixels * page::TauLadder::factor(choice.step);
    Prefetch& prefetch = prefetch_.of(request.turn);
    prefetch.follow(request.view.view(), worldFromObject_, Prefetch::Clock::now());
    MeshPaging::Progress progress;
    if (request.completeness == fabric::Completeness::Complete) {
        progress.hasUploaded = countMissing(cutAt(choice.step, request)) > 0;
        progress.loaded = reach(request, tauPixels);
    } else {
        progress = paging_->approach(cutAt(choice.step, request), request.turn, [&] {
            return prefetch.nodes(NodeTree{*file_, tauPixels, mayBePoints()}, tauPixels,
                                  paging_->latency());
        });
    }
    if (progress.hasUploaded)
        cuts_.erase(choice.step);
    const MeshCut& drawn = cutAt(choice.step, request);

    Cut cut;
    cut.pagesLoaded = progress.loaded.pages;
    cut.bytesLoaded = progress.loaded.bytes;
    cut.pagesMissing = countMissing(drawn);
    if (cut.pagesMissing > 0)
        cut.pagesFailed = static_cast<std::uint64_t>(
            std::ranges::count_if(drawn.wanted, [this](const CutNode& node) {
                return !paging_->isResident(node.node) && paging_->isFailing(node.node);
            }));
    cut.isComplete = cut.pagesMissing == 0 && choice.isLowest;
    errorPixels_ = drawn.errorPixels();
    const auto total = static_cast<double>(file_->triangleCount());
    for (const CutNode& one : drawn.drawn) {
        const mesh::Node& node = file_->nodes()[one.node];
        cut.pieces.push_back({one.node, static_cast<double>(node.triangleBegin) / total,
                              file_->bounds(one.node), true, costOf(one), hasBlended(one.node),
                              one.points, one.pointPixels});
    }
    return cut;
}

bool MeshDrawable::hasBlended(std::uint32_t node) const {
    return std::ranges::any_of(file_->ranges(node), [this](const mesh::MaterialRange& range) {
        return file_->materials()[range.material].isBlended();
    });
}

void MeshDrawable::source(const DeviceNode& node) const {
    Program::kPackedPosition.source(vertexArray_, node.buffer, 0);
    Program::kPackedNormal.source(vertexArray_, node.buffer, node.normalOffset);
    if (file_->hasColours())
        Program::kPackedColour.source(vertexArray_, node.buffer, node.colourOffset);
    if (file_->hasTextures())
        Program::kPackedPlace.source(vertexArray_, node.buffer, node.placeOffset);
    glVertexArrayElementBuffer(vertexArray_.id(), node.buffer.id());
}

/// Colours that stand in for the mesh's own do so by an array that is not enabled.
void MeshDrawable::bind(const FrameState& frame) const {
    glFrontFace(glm::determinant(fabric::Mat3(worldFromObject_)) < 0 ? GL_CW : GL_CCW);
    glBindVertexArray(vertexArray_.id());
    if (file_->hasColours() && !isTinted(frame))
        glEnableVertexArrayAttrib(vertexArray_.id(), Program::kPackedColour.location);
    else
        glDisableVertexArrayAttrib(vertexArray_.id(), Program::kPackedColour.location);
}

void MeshDrawable::use(const Program& program, const FrameState& frame) const {
    program.use();
    bind(frame);
}

/// From the root down.
int MeshDrawable::levelOf(std::uint32_t node) const {
    int level = 0;
    const std::span<const mesh::Node> nodes = file_->nodes();
    for (std::uint32_t at = 0; at != node; ++level) {
        const auto right = static_cast<std::uint32_t>(nodes[at].right);
        at = node < right ? at + 1 : right;
    }
    return level;
}

/// In place of the mesh's own.
std::uint32_t MeshDrawable::colourOf(const Piece& piece, const FrameState& frame) const {
    if (frame.look.levelTint)
        return packedSrgb(fabric::Vec3(levelColour(levelOf(piece.index))));
    if (frame.look.rangeTint)
        return packedSrgb(fabric::Vec3(rangeColour(frame.range)));
    return frame.colour ? packedSrgb(*frame.colour) : uniformColour_;
}

void MeshDrawable::colour(const Piece& piece, const FrameState& frame) const {
    glVertexAttribI4ui(Program::kPackedColour.location, colourOf(piece, frame), 0, 0, 0);
}

absl::Status MeshDrawable::drawPoints(const Piece& piece, const FrameState& frame,
                                      fabric::FrameStatistics& statistics) {
    RETURN_IF_ERROR(
        points_.draw(piece, *paging_->node(piece.index), colourOf(piece, frame), frame));
    statistics.points += piece.points;
    return absl::OkStatus();
}

absl::Status MeshDrawable::drawWhole(std::span<const Piece> pieces, const FrameState& frame,
                                     fabric::FrameStatistics& statistics) {
    Program::Variant variant{variantFor(frame, worldFromObject_), {}};
    variant.gouraud = frame.shading == fabric::Shading::Gouraud;
    ASSIGN_OR_RETURN(const Program* program, programs_.find(variant));
    points_.begin();
    if (frame.look.tileBounds)
        RETURN_IF_ERROR(boxLines_.begin(frame.view, worldFromObject_));
    use(*program, frame);
    setObject(*program, frame, worldFromObject_, objectFromLattice_);
    const lod::ObjectView view(frame.view, worldFromObject_);
    const HiddenBacks backs(mayHideBacks(bounds(), frame, worldFromObject_), lids_, view,
                            frame.part);
    for (const Piece& piece : pieces) {
        const DeviceNode* node = paging_->node(piece.index);
        const auto fronts = static_cast<GLsizei>(file_->nodes()[piece.index].frontIndexCount);
        if (piece.points > 0) {
            RETURN_IF_ERROR(drawPoints(piece, frame, statistics));
            use(*program, frame);
        } else {
            source(*node);
            colour(piece, frame);
            backs.draw(*node, piece, 0, node->indexCount, fronts, singleSided_);
            statistics.triangles += piece.triangles;
        }
        if (frame.look.tileBounds) {
            // At once, so that where depths tie the lower range wins as in compositing.
            boxLines_.draw(piece.bounds, levelColour(levelOf(piece.index)));
            use(*program, frame);
        }
    }
    return absl::OkStatus();
}

/// Of what is blended the far sides first: right by itself where a piece is convex.
void MeshDrawable::drawRange(const DeviceNode& node, GLsizei first,
                             const mesh::MaterialRange& range, const Piece& piece,
                             const HiddenBacks& backs) const {
    const mesh::Material& material = file_->materials()[range.material];
    const auto count = static_cast<GLsizei>(range.indexCount);
    if (material.isBlended() && !material.isOneSided()) {
        glCullFace(GL_FRONT);
        drawIndices(node, first, count, count);
        glCullFace(GL_BACK);
    }
    if (material.isBlended() || material.isOneSided()) {
        drawIndices(node, first, count, count);
        return;
    }
    const bool hasOneSide = singleSided_ && !material.isTwoSided() && !material.isSeeThrough();
    backs.draw(node, piece, first, count, static_cast<GLsizei>(range.frontIndexCount), hasOneSide);
}

/// Uses the program that draws a material.
absl::Status MeshDrawable::prepare(const mesh::Material& material, const FrameState& frame,
                                   Prepared& prepared) {
    Program::Variant variant{variantFor(frame, worldFromObject_), {}};
    variant.gouraud = frame.shading == fabric::Shading::Gouraud;
    variant.textured = !material.hasImage() ? 0 : frame.view.step == fabric::Vec2(1) ? 1 : 2;
    variant.seeThrough = material.isBlended() ? 2 : material.alphaCutoff > 0 ? 1 : 0;
    const auto [at, isNew] = prepared.try_emplace(variant, nullptr);
    const Program*& program = at->second;
    if (isNew) {
        ASSIGN_OR_RETURN(program, programs_.find(variant));
    }
    program->use();
    if (isNew)
        setObject(*program, frame, worldFromObject_, objectFromLattice_);
    if (material.hasImage())
        program->picture(textures_.texture(material.image));
    if (material.alphaCutoff > 0)
        program->alphaCutoff(material.alphaCutoff);
    return absl::OkStatus();
}

absl::Status MeshDrawable::drawByMaterial(std::span<const Piece> pieces, const FrameState& frame,
                                          fabric::FrameStatistics& statistics) {
    Prepared prepared;
    points_.begin();
    const lod::ObjectView view(frame.view, worldFromObject_);
    const HiddenBacks backs(mayHideBacks(bounds(), frame, worldFromObject_), lids_, view,
                            frame.part);
    const bool hasBoxes = frame.look.tileBounds && frame.layer == Layer::Opaque;
    if (hasBoxes)
        RETURN_IF_ERROR(boxLines_.begin(frame.view, worldFromObject_));
    bind(frame);
    glVertexAttribI4ui(Program::kPackedColour.location, uniformColour_, 0, 0, 0);
    for (const Piece& piece : pieces) {
        const DeviceNode& node = *paging_->node(piece.index);
        if (piece.points == 0) {
            source(node);
        } else if (frame.layer == Layer::Opaque) {
            RETURN_IF_ERROR(drawPoints(piece, frame, statistics));
            bind(frame);
            glVertexAttribI4ui(Program::kPackedColour.location, uniformColour_, 0, 0, 0);
        }
        GLsizei first = 0;
        for (const mesh::MaterialRange& range : file_->ranges(piece.index)) {
            const mesh::Material& material = file_->materials()[range.material];
            if (material.isBlended() == (frame.layer == Layer::Blended)) {
                RETURN_IF_ERROR(prepare(material, frame, prepared));
                drawRange(node, first, range, piece, backs);
                statistics.triangles += range.indexCount / 3;
            }
            first += static_cast<GLsizei>(range.indexCount);
        }
        if (hasBoxes) {
            boxLines_.draw(piece.bounds, levelColour(levelOf(piece.index)));
            bind(frame);
        }
    }
    return absl::OkStatus();
}

absl::Status MeshDrawable::draw(std::span<const Piece> pieces, const FrameState& frame,
                                fabric::FrameStatistics& statistics) {
    const bool isWhole = file_->materials().empty() ||
                         frame.shading == fabric::Shading::Wireframe || isTinted(frame);
    if (!isWhole)
        return drawByMaterial(pieces, frame, statistics);
    return frame.layer == Layer::Opaque ? drawWhole(pieces, frame, statistics) : absl::OkStatus();
}

}  // namespace

/// Textures may take half: where they have all of their levels, as much again is for the rest.
MemoryUse greatestUse(const mesh::EymFile& file, TextureFormat format) {
    MemoryUse use = MeshPaging::greatestUse(file);
    use.deviceBytes += 2 * MeshTextures::allBytes(file, format);
    return use;
}

absl::StatusOr<std::unique_ptr<Drawable>> openMesh(const fabric::SceneObject& object,
                                                   std::shared_ptr<const mesh::EymFile> file,
                                                   MeshPrograms& programs,
                                                   PointPrograms& pointPrograms,
                                                   page::Loader& loader, const MeshMemory& memory,
                                                   TextureFormat format) {
    MeshTextures textures(*file, memory.deviceBytes / 2, format);
    if (textures.bytes() > memory.deviceBytes)
        return absl::ResourceExhaustedError(fmt::format(
            "{}: its textures' coarsest levels need {} bytes, and its share of memory on the "
            "device is {}; raise the limit, or open fewer objects",
            object.path, textures.bytes(), memory.deviceBytes));
    ASSIGN_OR_RETURN(
        auto paging,
        MeshPaging::open(file, loader, {memory.deviceBytes - textures.bytes(), memory.hostBytes}));
    return std::make_unique<MeshDrawable>(object, programs, pointPrograms, std::move(file),
                                          std::move(textures), std::move(paging));
}

}  // namespace eyrie::draw
