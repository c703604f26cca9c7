// SPDX-License-Identifier: Apache-2.0
#include "renderer/gl/debug_output.h"

#include <atomic>
#include <cstdlib>

#include <GL/glew.h>

#include "fabric/log.h"

namespace eyrie::gl {
namespace {

std::atomic<OnGlError> onGlError{OnGlError::Log};

void GLAPIENTRY onMessage(GLenum source, GLenum type, GLuint, GLenum severity, GLsizei,
                          const GLchar* message, const void*) {
    if (source == GL_DEBUG_SOURCE_SHADER_COMPILER)
        return;  // Program reports compile errors, with the shader's name
    if (type == GL_DEBUG_TYPE_ERROR) {
        spdlog::error("OpenGL: {}", message);
        if (onGlError == OnGlError::Abort)
            std::abort();
    } else if (severity == GL_DEBUG_SEVERITY_HIGH) {
        spdlog::warn("OpenGL: {}", message);
    }
}

}  // namespace

void setOnGlError(OnGlError action) { onGlError = action; }

void installDebugOutput() {
    glEnable(GL_DEBUG_OUTPUT);
    if (onGlError == OnGlError::Abort)
        glEnable(GL_DEBUG_OUTPUT_SYNCHRONOUS);
    glDebugMessageCallback(onMessage, nullptr);
}

}  // namespace eyrie::gl
