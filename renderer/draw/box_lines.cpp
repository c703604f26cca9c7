// SPDX-License-Identifier: Apache-2.0
#include "renderer/draw/box_lines.h"

#include "fabric/frustum.h"
#include "fabric/status.h"

namespace eyrie::draw {

absl::Status BoxLines::begin(const lod::View& view, const fabric::Mat4& worldFromObject) {
    if (!program_) {
        ASSIGN_OR_RETURN(program_, effects::LinesEffect::create({}));
    }
    clipFromWorldAxes_ = fabric::clipFromView(view.frustum, fabric::kNearMetres) *
                         fabric::Mat4(view.viewFromWorldRotation);
    eyeFromObject_ = worldFromObject;
    eyeFromObject_[3] -= fabric::Vec4(view.eye, 0.0);
    return absl::OkStatus();
}

void BoxLines::draw(const fabric::Box& box, const glm::vec3& colour) const {
    program_->use();
    glBindVertexArray(noVertices_.id());
    fabric::Mat4 objectFromBox(1.0);  // of the unit cube
    for (int axis = 0; axis < 3; ++axis) objectFromBox[axis][axis] = box.size()[axis];
    objectFromBox[3] = fabric::Vec4(box.min, 1.0);
    program_->clipFromBox(glm::mat4(clipFromWorldAxes_ * (eyeFromObject_ * objectFromBox)));
    program_->lineColour(colour);
    glDrawArrays(GL_LINES, 0, 24);
}

}  // namespace eyrie::draw
