// SPDX-License-Identifier: Apache-2.0
#include "renderer/draw/mesh_points.h"

#include <algorithm>
#include <cmath>

#include "fabric/status.h"
#include "renderer/draw/object_program.h"
#include "renderer/draw/tint.h"

namespace eyrie::draw {
namespace {

using Program = effects::MeshPointsEffect;

/// Of a square that holds all pixels of a picture whose middles are within `radiusPixels` of a
/// point: where that is half a pixel at most, one pixel. The shader cuts it to size.
float sideOf(double radiusPixels, const fabric::Vec2& step) {
    const double view = radiusPixels <= 0.5 ? 1 : 2 * radiusPixels + 1;
    return static_cast<float>(std::ceil(view / std::min({step.x, step.y, 1.0})));
}

}  // namespace

MeshPoints::MeshPoints(PointPrograms& programs, const mesh::EymFile& file,
                       const fabric::SceneObject& object)
    : programs_(programs),
      worldFromObject_(object.worldFromObject),
      objectFromLattice_(file.lattice().objectFromLattice()),
      hasColours_(file.hasColours() || file.hasTextures()) {
    Program::kPackedPosition.define(vertexArray_);
    Program::kPackedNormal.define(vertexArray_);
    Program::kPackedColour.define(vertexArray_, hasColours_);
}

absl::Status MeshPoints::prepare(const FrameState& frame) {
    Program::Variant variant{variantFor(frame, worldFromObject_), {}};
    variant.flat = false;  // points have no faces
    ASSIGN_OR_RETURN(prepared_, programs_.find(variant));
    prepared_->use();
    setObject(*prepared_, frame, worldFromObject_, objectFromLattice_);
    return absl::OkStatus();
}

absl::Status MeshPoints::draw(const Piece& piece, const DeviceNode& node, std::uint32_t colour,
                              const FrameState& frame) {
    if (prepared_ == nullptr)
        RETURN_IF_ERROR(prepare(frame));
    prepared_->use();
    const float side = sideOf(piece.pointRadiusPixels, frame.view.step);
    glPointSize(side);
    prepared_->pointSide(side);
    prepared_->pointRadius(static_cast<float>(piece.pointRadiusPixels));
    glBindVertexArray(vertexArray_.id());
    Program::kPackedPosition.source(vertexArray_, node.buffer, 0);
    Program::kPackedNormal.source(vertexArray_, node.buffer, node.normalOffset);
    if (hasColours_)
        Program::kPackedColour.source(vertexArray_, node.buffer, node.colourOffset);
    if (hasColours_ && !isTinted(frame))
        glEnableVertexArrayAttrib(vertexArray_.id(), Program::kPackedColour.location);
    else
        glDisableVertexArrayAttrib(vertexArray_.id(), Program::kPackedColour.location);
    glVertexAttribI4ui(Program::kPackedColour.location, colour, 0, 0, 0);
    glDrawArrays(GL_POINTS, 0, static_cast<GLsizei>(piece.points));
    return absl::OkStatus();
}

}  // namespace eyrie::draw
