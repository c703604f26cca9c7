// SPDX-License-Identifier: Apache-2.0
#include "renderer/draw/mesh_draw.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/matrix.hpp>

#include "fabric/status.h"
#include "renderer/draw/mesh_cut.h"
#include "renderer/draw/mesh_paging.h"
#include "renderer/draw/object_program.h"
#include "renderer/draw/seen_lids.h"
#include "renderer/draw/tau_choice.h"
#include "renderer/gl/object.h"
#include "renderer/mesh/eym_format.h"

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

/// For as long as it lives, only backs are drawn, and only on these pixels.
class BacksOnly {
public:
    BacksOnly(const fabric::PixelViewport& pixels, const fabric::PixelViewport& before)
        : before_(before) {
        glEnable(GL_CULL_FACE);
        glCullFace(GL_FRONT);
        glScissor(pixels.x, pixels.y, pixels.width, pixels.height);
    }
    BacksOnly(const BacksOnly&) = delete;
    BacksOnly& operator=(const BacksOnly&) = delete;
    ~BacksOnly() {
        glDisable(GL_CULL_FACE);
        glCullFace(GL_BACK);
        glScissor(before_.x, before_.y, before_.width, before_.height);
    }

private:
    fabric::PixelViewport before_;
};

class MeshDrawable : public Drawable {
public:
    MeshDrawable(const fabric::SceneObject& object, MeshPrograms& programs,
                 std::shared_ptr<const mesh::EymFile> file, std::unique_ptr<MeshPaging> paging)
        : programs_(programs),
          worldFromObject_(object.worldFromObject),
          uniformColour_(packedSrgb(object.colour)),
          singleSided_(object.singleSided),
          file_(std::move(file)),
          lids_(file_->lids()),
          paging_(std::move(paging)) {
        const mesh::Lattice& lattice = file_->lattice();
        objectFromLattice_ = glm::scale(glm::translate(fabric::Mat4(1.0), lattice.originMetres),
                                        fabric::Vec3(lattice.stepMetres));
        defineVertexFormat();
    }

    fabric::Box bounds() const override { return file_->bounds(); }
    std::uint64_t triangles() const override { return file_->triangleCount(); }
    std::uint64_t bytes() const override { return file_->fileBytes(); }

    Cut selectCut(const CutRequest& request) override;
    double errorPixels(const CutRequest&, occlusion::HiddenGround*) override {
        return errorPixels_;
    }
    absl::Status draw(std::span<const Piece> pieces, const FrameState& frame,
                      fabric::FrameStatistics& statistics) override;
    MemoryUse memory() const override { return paging_->memory(); }

private:
    void defineVertexFormat();
    const MeshCut& cutAt(int step, const CutRequest& request);
    std::uint64_t bytesOf(const MeshCut& cut) const;
    std::uint64_t countMissing(const MeshCut& cut) const;
    page::HostPages::Loads reach(const CutRequest& request, double tauPixels);
    bool mayHideBacks(const FrameState& frame) const;
    void source(const DeviceNode& node) const;
    void drawNode(const DeviceNode& node, GLsizei fronts) const;
    void drawPiece(const Piece& piece, const DeviceNode& node, const SeenLids& lids,
                   const FrameState& frame) const;

    MeshPrograms& programs_;
    fabric::Mat4 worldFromObject_;
    fabric::Mat4 objectFromLattice_;
    std::uint32_t uniformColour_;
    bool singleSided_;
    std::shared_ptr<const mesh::EymFile> file_;
    std::vector<fabric::Box> lids_;
    double errorPixels_ = 0;  ///< of the last cut
    gl::VertexArray vertexArray_;
    std::unique_ptr<MeshPaging> paging_;
    TauChoice tau_;
    std::map<int, MeshCut> cuts_;  ///< of this view and tau, by step
};

void MeshDrawable::defineVertexFormat() {
    Program::kPackedPosition.define(vertexArray_);
    Program::kPackedNormal.define(vertexArray_);
    Program::kPackedColour.define(vertexArray_, file_->hasColours());
}

const MeshCut& MeshDrawable::cutAt(int step, const CutRequest& request) {
    const auto known = cuts_.find(step);
    if (known != cuts_.end())
        return known->second;
    return cuts_
        .emplace(step,
                 cutOf(*file_, request.view, request.tauPixels * page::TauLadder::factor(step),
                       [this](std::uint32_t node) { return paging_->isResident(node); }))
        .first->second;
}

/// With what may stand in.
std::uint64_t MeshDrawable::bytesOf(const MeshCut& cut) const {
    std::uint64_t bytes = 0;
    for (const auto* nodes : {&cut.wanted, &cut.between, &cut.above})
        for (const CutNode& node : *nodes) bytes += paging_->bytesOf(node.node);
    return bytes;
}

std::uint64_t MeshDrawable::countMissing(const MeshCut& cut) const {
    return static_cast<std::uint64_t>(std::ranges::count_if(
        cut.wanted, [this](const CutNode& node) { return !paging_->isResident(node.node); }));
}

/// Waits for every page that can be read; what stands in for one that cannot is waited for, too.
page::HostPages::Loads MeshDrawable::reach(const CutRequest& request, double tauPixels) {
    const auto start = page::HostPages::Clock::now();
    const auto readable = [&] {
        return cutOf(*file_, request.view, tauPixels,
                     [&](std::uint32_t node) { return paging_->mayCome(node, start); })
            .drawn;
    };
    page::HostPages::Loads loaded;
    page::HostPages::Loads round;
    std::vector<CutNode> needed = readable();
    while (paging_->reach(needed, round)) {
        loaded.add(round);
        if (round.hasFailed)
            needed = readable();
        round = {};
    }
    loaded.add(round);
    return loaded;
}

Cut MeshDrawable::selectCut(const CutRequest& request) {
    cuts_.clear();
    const page::TauLadder::Choice choice = tau_.choose(
        request, [&](int step) { return bytesOf(cutAt(step, request)); }, paging_->roomBytes());
    MeshPaging::Progress progress;
    if (request.completeness == fabric::Completeness::Complete) {
        progress.hasUploaded = countMissing(cutAt(choice.step, request)) > 0;
        progress.loaded = reach(request, request.tauPixels * page::TauLadder::factor(choice.step));
    } else {
        progress = paging_->approach(cutAt(choice.step, request));
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
                              file_->bounds(one.node), true, node.indexCount / 3});
    }
    return cut;
}

/// From inside its bounds a surface may well be seen from behind, as may what the near plane cuts
/// open; and lines have no sides.
bool MeshDrawable::mayHideBacks(const FrameState& frame) const {
    if (frame.shading == fabric::Shading::Wireframe)
        return false;
    const fabric::Vec3 eye(glm::inverse(worldFromObject_) * fabric::Vec4(frame.view.eye, 1.0));
    if (bounds().grownBy(0.01 * glm::length(bounds().size())).contains(eye))
        return false;
    const fabric::Box box = fabric::transformed(
        bounds(), lod::ObjectView(frame.view, worldFromObject_).viewFromObject());
    const fabric::Vec3 nearest = glm::clamp(fabric::Vec3(0.0), box.min, box.max);
    const fabric::Frustum& frustum = frame.view.frustum;
    const double x = std::max(std::abs(frustum.left), std::abs(frustum.right));
    const double y = std::max(std::abs(frustum.bottom), std::abs(frustum.top));
    return glm::length(nearest) > fabric::kNearMetres * std::sqrt(1 + x * x + y * y);
}

void drawIndices(const DeviceNode& node, GLsizei first, GLsizei count) {
    glDrawElements(GL_TRIANGLES, count, GL_UNSIGNED_SHORT,
                   reinterpret_cast<const void*>(
                       node.indexOffset + first * static_cast<GLsizei>(sizeof(std::uint16_t))));
}

void MeshDrawable::source(const DeviceNode& node) const {
    Program::kPackedPosition.source(vertexArray_, node.buffer, 0);
    Program::kPackedNormal.source(vertexArray_, node.buffer, node.normalOffset);
    if (file_->hasColours())
        Program::kPackedColour.source(vertexArray_, node.buffer, node.colourOffset);
    glVertexArrayElementBuffer(vertexArray_.id(), node.buffer.id());
}

/// Without the backs of its first `fronts` indices.
void MeshDrawable::drawNode(const DeviceNode& node, GLsizei fronts) const {
    if (fronts > 0) {
        glEnable(GL_CULL_FACE);
        drawIndices(node, 0, fronts);
        glDisable(GL_CULL_FACE);
    }
    if (fronts < node.indexCount)
        drawIndices(node, fronts, node.indexCount - fronts);
}

/// Through lids its backs may be seen. Where these cover much of it, all is drawn at once: vertices
/// are a quarter of the time.
void MeshDrawable::drawPiece(const Piece& piece, const DeviceNode& node, const SeenLids& lids,
                             const FrameState& frame) const {
    if (singleSided_)
        return drawNode(node, node.indexCount);
    const fabric::PixelViewport pixels = lids.before(piece.bounds);
    if (pixels.area() > lids.pixelsOf(piece.bounds).area() / 2)
        return drawNode(node, 0);
    const auto fronts = static_cast<GLsizei>(file_->nodes()[piece.index].frontIndexCount);
    drawNode(node, fronts);
    const fabric::PixelViewport part = fabric::intersection(pixels, frame.part);
    if (fronts == 0 || part.isEmpty())
        return;
    const BacksOnly state(part, frame.part);
    drawIndices(node, 0, fronts);
}

absl::Status MeshDrawable::draw(std::span<const Piece> pieces, const FrameState& frame,
                                fabric::FrameStatistics& statistics) {
    Program::Variant variant{variantFor(frame, worldFromObject_)};
    variant.gouraud = frame.shading == fabric::Shading::Gouraud;
    ASSIGN_OR_RETURN(const Program* program, programs_.find(variant));
    program->use();
    setObject(*program, frame, worldFromObject_, objectFromLattice_);
    const bool mayHideBacks = this->mayHideBacks(frame);
    glFrontFace(glm::determinant(fabric::Mat3(worldFromObject_)) < 0 ? GL_CW : GL_CCW);
    glBindVertexArray(vertexArray_.id());
    glVertexAttribI4ui(Program::kPackedColour.location, uniformColour_, 0, 0, 0);
    const lod::ObjectView view(frame.view, worldFromObject_);
    const SeenLids lids(lids_, view);
    for (const Piece& piece : pieces) {
        const DeviceNode* node = paging_->node(piece.index);
        source(*node);
        if (mayHideBacks)
            drawPiece(piece, *node, lids, frame);
        else
            drawNode(*node, 0);
        statistics.triangles += static_cast<std::uint64_t>(node->indexCount) / 3;
    }
    return absl::OkStatus();
}

}  // namespace

absl::StatusOr<std::unique_ptr<Drawable>> openMesh(const fabric::SceneObject& object,
                                                   MeshPrograms& programs,
                                                   const page::SourceOptions& sources,
                                                   page::Loader& loader, const MeshMemory& memory) {
    ASSIGN_OR_RETURN(mesh::EymFile opened, mesh::EymFile::open(object.path, sources));
    auto file = std::make_shared<const mesh::EymFile>(std::move(opened));
    ASSIGN_OR_RETURN(auto paging, MeshPaging::open(file, loader, memory));
    return std::make_unique<MeshDrawable>(object, programs, std::move(file), std::move(paging));
}

}  // namespace eyrie::draw
