// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include <absl/status/statusor.h>

#include "renderer/gl/object.h"

namespace eyrie::gl {

/// One GLSL source, with the name that compile errors report.
struct ShaderSource {
    std::string_view name;
    std::string_view text;
};

/// A linked program of a vertex and a fragment shader.
class Program {
public:
    /// Internal, with the driver's log, when the shaders do not compile or link: they are part of
    /// the program, so it is a bug or a driver's.
    static absl::StatusOr<Program> create(const ShaderSource& vertex, const ShaderSource& fragment);

    GLuint id() const { return object_.id(); }
    /// Location of a uniform; -1 (which GL ignores) when the compiler removed it.
    GLint uniform(const char* name) const { return glGetUniformLocation(id(), name); }

private:
    Program() = default;
    ProgramObject object_;
};

}  // namespace eyrie::gl
