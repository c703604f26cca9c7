// SPDX-License-Identifier: Apache-2.0
#include "renderer/gl/pass_state.h"

namespace eyrie::gl {

void PassState::apply() const {
    glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(depthFunction);
    glDepthMask(GL_TRUE);
    glDisable(GL_BLEND);
    glDisable(GL_DITHER);
    if (culledFace == GL_NONE) {
        glDisable(GL_CULL_FACE);
    } else {
        glEnable(GL_CULL_FACE);
        glCullFace(culledFace);
    }
    glPolygonMode(GL_FRONT_AND_BACK, polygonMode);
}

}  // namespace eyrie::gl
