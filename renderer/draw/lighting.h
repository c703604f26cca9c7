// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "renderer/draw/drawable.h"
#include "renderer/gl/program.h"

namespace eyrie::draw {

/// A fragment shader's whole source: the GLSL version, effects/lighting.glsl, then `fragment`.
std::string fragmentSource(std::string_view fragment);

/// The uniforms of effects/lighting.glsl in one program.
class LightingUniforms {
public:
    explicit LightingUniforms(const gl::Program& program);

    /// Sets them in the program in use. Without lights in the scene one shines from the camera.
    void set(const FrameState& frame) const;

private:
    GLint lightDirections_;
    GLint lightColours_;
    GLint ambient_;
};

}  // namespace eyrie::draw
