// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>

#include <absl/status/statusor.h>
#include <glm/fwd.hpp>

#include "renderer/gl/object.h"

namespace eyrie::gl {

/// One GLSL source, with the name that compile errors report.
struct ShaderSource {
    std::string name;
    std::string text;
};

/// A linked program of a vertex and a fragment shader, or of a compute shader.
class Program {
public:
    /// Internal, with the driver's log, when the shaders do not compile or link: they are part of
    /// the program, so it is a bug or a driver's.
    static absl::StatusOr<Program> create(const ShaderSource& vertex, const ShaderSource& fragment);
    static absl::StatusOr<Program> create(const ShaderSource& compute);

    GLuint id() const { return object_.id(); }
    /// Location of a uniform; -1 (which GL ignores) when the compiler removed it.
    GLint uniform(const char* name) const { return glGetUniformLocation(id(), name); }
    void use() const { glUseProgram(id()); }

private:
    Program() = default;
    absl::Status link(const std::string& name) const;
    ProgramObject object_;
};

/// Set a uniform of `program`, which need not be in use. Generated code calls these with the type
/// that the effect file declares. There is at least one value; what is beyond the end of an array
/// is ignored.
void setUniform(GLuint program, GLint location, std::span<const float> values);
void setUniform(GLuint program, GLint location, std::span<const int> values);
void setUniform(GLuint program, GLint location, std::span<const glm::vec3> values);
void setUniform(GLuint program, GLint location, std::span<const glm::ivec2> values);
void setUniform(GLuint program, GLint location, std::span<const glm::ivec3> values);
void setUniform(GLuint program, GLint location, std::span<const glm::mat3> values);
void setUniform(GLuint program, GLint location, std::span<const glm::mat4> values);

template <typename T>
void setUniform(GLuint program, GLint location, const T& value) {
    setUniform(program, location, std::span<const T>(&value, 1));
}

}  // namespace eyrie::gl
