// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "renderer/gl/object.h"

namespace eyrie::gl {

/// All the state of a pass over opaque surfaces, as an effect file declares it. Depth runs from 0
/// to 1 in clip space and is written; nothing blends and nothing is dithered.
struct PassState {
    GLenum depthFunction = GL_LESS;
    GLenum culledFace = GL_NONE;  ///< GL_NONE, GL_BACK or GL_FRONT
    GLenum polygonMode = GL_FILL;

    void apply() const;
    bool operator==(const PassState&) const = default;
};

}  // namespace eyrie::gl
