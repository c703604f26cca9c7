// SPDX-License-Identifier: Apache-2.0
#include "renderer/draw/mesh_draw.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/matrix.hpp>

#include "fabric/status.h"
#include "renderer/draw/mesh_paging.h"
#include "renderer/draw/object_program.h"
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

class MeshDrawable : public Drawable {
public:
    MeshDrawable(const fabric::SceneObject& object, MeshPrograms& programs, mesh::EymFile file,
                 std::uint64_t memoryBytes)
        : programs_(programs),
          worldFromObject_(object.worldFromObject),
          uniformColour_(packedSrgb(object.colour)),
          singleSided_(object.singleSided),
          file_(std::move(file)),
          paging_(file_, memoryBytes) {
        const mesh::Lattice& lattice = file_.lattice();
        objectFromLattice_ = glm::scale(glm::translate(fabric::Mat4(1.0), lattice.originMetres),
                                        fabric::Vec3(lattice.stepMetres));
        defineVertexFormat();
    }

    fabric::Box bounds() const override { return file_.bounds(); }
    std::uint64_t triangles() const override { return file_.triangleCount(); }
    std::uint64_t bytes() const override { return file_.fileBytes(); }

    Cut selectCut(const CutRequest& request) override;
    double errorPixels(const CutRequest&, occlusion::HiddenGround*) override {
        return errorPixels_;
    }
    absl::Status draw(std::span<const Piece> pieces, const FrameState& frame,
                      fabric::FrameStatistics& statistics) override;
    void trim() override { paging_.trim(); }
    MemoryUse memory() const override { return {paging_.bytes(), 0}; }

private:
    void defineVertexFormat();
    void visit(std::uint32_t index, bool errorKnown, const lod::ObjectView& view, double tauPixels,
               Cut& cut);
    bool mayHideBacks(const FrameState& frame) const;
    void drawNode(const DeviceNode& node, GLsizei fronts) const;

    MeshPrograms& programs_;
    fabric::Mat4 worldFromObject_;
    fabric::Mat4 objectFromLattice_;
    std::uint32_t uniformColour_;
    bool singleSided_;
    mesh::EymFile file_;
    double errorPixels_ = 0;  ///< of the last cut
    gl::VertexArray vertexArray_;
    MeshPaging paging_;
};

void MeshDrawable::defineVertexFormat() {
    Program::kPackedPosition.define(vertexArray_);
    Program::kPackedNormal.define(vertexArray_);
    Program::kPackedColour.define(vertexArray_, file_.hasColours());
}

Cut MeshDrawable::selectCut(const CutRequest& request) {
    Cut cut;
    errorPixels_ = 0;
    visit(0, false, request.view, request.tauPixels, cut);
    return cut;
}

/// Depth first, so pieces come in the order of the range. A node's error bound covers its whole
/// subtree: below a node that keeps tau and has nothing to be drawn itself it is not computed
/// again.
void MeshDrawable::visit(std::uint32_t index, bool errorKnown, const lod::ObjectView& view,
                         double tauPixels, Cut& cut) {
    const mesh::Node& node = file_.nodes()[index];
    const fabric::Box box = file_.bounds(index);
    if (!view.isVisible(box))
        return;
    if (!errorKnown) {
        const double error = view.screenSpaceErrorPixels(node.errorMetres, box);
        errorKnown = node.isLeaf() || error <= tauPixels;
        if (errorKnown)
            errorPixels_ = std::max(errorPixels_, error);
    }
    if (errorKnown && node.indexCount > 0) {
        const auto total = static_cast<double>(file_.triangleCount());
        cut.pieces.push_back({index, static_cast<double>(node.triangleBegin) / total, box, true,
                              node.indexCount / 3});
        return;
    }
    visit(static_cast<std::uint32_t>(node.left), errorKnown, view, tauPixels, cut);
    visit(static_cast<std::uint32_t>(node.right), errorKnown, view, tauPixels, cut);
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

/// Without the backs of its first `fronts` indices.
void MeshDrawable::drawNode(const DeviceNode& node, GLsizei fronts) const {
    Program::kPackedPosition.source(vertexArray_, node.buffer, 0);
    Program::kPackedNormal.source(vertexArray_, node.buffer, node.normalOffset);
    if (file_.hasColours())
        Program::kPackedColour.source(vertexArray_, node.buffer, node.colourOffset);
    glVertexArrayElementBuffer(vertexArray_.id(), node.buffer.id());
    const auto draw = [&node](GLsizei first, GLsizei count) {
        glDrawElements(GL_TRIANGLES, count, GL_UNSIGNED_SHORT,
                       reinterpret_cast<const void*>(
                           node.indexOffset + first * static_cast<GLsizei>(sizeof(std::uint16_t))));
    };
    if (fronts > 0) {
        glEnable(GL_CULL_FACE);
        draw(0, fronts);
        glDisable(GL_CULL_FACE);
    }
    if (fronts < node.indexCount)
        draw(fronts, node.indexCount - fronts);
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
    for (const Piece& piece : pieces) {
        ASSIGN_OR_RETURN(const DeviceNode* node, paging_.node(piece.index, statistics));
        const GLsizei fronts =
            singleSided_ ? node->indexCount
                         : static_cast<GLsizei>(file_.nodes()[piece.index].frontIndexCount);
        drawNode(*node, mayHideBacks ? fronts : 0);
        statistics.triangles += static_cast<std::uint64_t>(node->indexCount) / 3;
    }
    return absl::OkStatus();
}

}  // namespace

absl::StatusOr<std::unique_ptr<Drawable>> openMesh(const fabric::SceneObject& object,
                                                   MeshPrograms& programs,
                                                   const page::SourceOptions& sources,
                                                   std::uint64_t memoryBytes) {
    ASSIGN_OR_RETURN(mesh::EymFile file, mesh::EymFile::open(object.path, sources));
    return std::make_unique<MeshDrawable>(object, programs, std::move(file), memoryBytes);
}

}  // namespace eyrie::draw
