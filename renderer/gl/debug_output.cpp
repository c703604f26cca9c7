// SPDX-License-Identifier: Apache-2.0
#include "renderer/gl/debug_output.h"

#include <atomic>
#include <cstdlib>

#include <GL/glew.h>
#include <fmt/format.h>

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

absl::Status takeGlError() {
    const GLenum first = glGetError();
    if (first == GL_NO_ERROR)
        return absl::OkStatus();
    constexpr int kMost = 16;  // a context that is lost reports one for ever
    GLenum error = first;
    for (int i = 0; i < kMost && error != GL_NO_ERROR && error != GL_OUT_OF_MEMORY; ++i)
        error = glGetError();
    if (error == GL_OUT_OF_MEMORY)
        return absl::ResourceExhaustedError(
            "the device has no memory left for this picture; allow less (--memory of eyrie "
            "renderer), or draw a smaller one");
    return absl::InternalError(
        fmt::format("OpenGL reports error 0x{:x} while a picture was drawn; it may be wrong, and "
                    "is not shown; the log may say more",
                    first));
}

bool wantsDebugContext() { return onGlError == OnGlError::Abort; }

void installDebugOutput() {
    glEnable(GL_DEBUG_OUTPUT);
    if (onGlError == OnGlError::Abort)
        glEnable(GL_DEBUG_OUTPUT_SYNCHRONOUS);
    glDebugMessageCallback(onMessage, nullptr);
}

}  // namespace eyrie::gl
