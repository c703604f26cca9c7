// SPDX-License-Identifier: Apache-2.0
#include "renderer/gl/program.h"

#include <string>

#include <fmt/format.h>
#include <glm/gtc/type_ptr.hpp>

#include "fabric/status.h"

namespace eyrie::gl {
namespace {

template <typename T>
GLsizei count(std::span<const T> values) {
    return static_cast<GLsizei>(values.size());
}

/// A shader object that lives until its program is linked.
class Shader {
public:
    explicit Shader(GLenum stage) : id_(glCreateShader(stage)) {}
    ~Shader() { glDeleteShader(id_); }
    Shader(const Shader&) = delete;
    Shader& operator=(const Shader&) = delete;
    GLuint id() const { return id_; }

private:
    GLuint id_;
};

absl::Status compile(const Shader& shader, const ShaderSource& source) {
    const GLchar* text = source.text.data();
    const auto length = static_cast<GLint>(source.text.size());
    glShaderSource(shader.id(), 1, &text, &length);
    glCompileShader(shader.id());
    GLint ok = GL_FALSE;
    glGetShaderiv(shader.id(), GL_COMPILE_STATUS, &ok);
    if (ok == GL_TRUE)
        return absl::OkStatus();
    std::string log(4096, '\0');
    GLsizei written = 0;
    glGetShaderInfoLog(shader.id(), static_cast<GLsizei>(log.size()), &written, log.data());
    log.resize(static_cast<std::size_t>(written));
    return absl::InternalError(fmt::format("{}:\n{}", source.name, log));
}

/// A shader as long as it is part of a program.
class Attached {
public:
    Attached(GLuint program, GLuint shader) : program_(program), shader_(shader) {
        glAttachShader(program, shader);
    }
    ~Attached() { glDetachShader(program_, shader_); }
    Attached(const Attached&) = delete;
    Attached& operator=(const Attached&) = delete;

private:
    GLuint program_;
    GLuint shader_;
};

}  // namespace

absl::StatusOr<Program> Program::create(const ShaderSource& vertex, const ShaderSource& fragment) {
    const Shader vertexShader(GL_VERTEX_SHADER);
    const Shader fragmentShader(GL_FRAGMENT_SHADER);
    RETURN_IF_ERROR(compile(vertexShader, vertex));
    RETURN_IF_ERROR(compile(fragmentShader, fragment));
    Program program;
    const Attached vertexStage(program.id(), vertexShader.id());
    const Attached fragmentStage(program.id(), fragmentShader.id());
    RETURN_IF_ERROR(program.link(fmt::format("{} + {}", vertex.name, fragment.name)));
    return program;
}

absl::StatusOr<Program> Program::create(const ShaderSource& compute) {
    const Shader shader(GL_COMPUTE_SHADER);
    RETURN_IF_ERROR(compile(shader, compute));
    Program program;
    const Attached stage(program.id(), shader.id());
    RETURN_IF_ERROR(program.link(compute.name));
    return program;
}

absl::Status Program::link(const std::string& name) const {
    glLinkProgram(id());
    GLint ok = GL_FALSE;
    glGetProgramiv(id(), GL_LINK_STATUS, &ok);
    if (ok == GL_TRUE)
        return absl::OkStatus();
    std::string log(4096, '\0');
    GLsizei written = 0;
    glGetProgramInfoLog(id(), static_cast<GLsizei>(log.size()), &written, log.data());
    log.resize(static_cast<std::size_t>(written));
    return absl::InternalError(fmt::format("{}:\n{}", name, log));
}

void setUniform(GLuint program, GLint location, std::span<const float> values) {
    glProgramUniform1fv(program, location, count(values), values.data());
}

void setUniform(GLuint program, GLint location, std::span<const int> values) {
    glProgramUniform1iv(program, location, count(values), values.data());
}

void setUniform(GLuint program, GLint location, std::span<const glm::vec3> values) {
    glProgramUniform3fv(program, location, count(values), glm::value_ptr(values.front()));
}

void setUniform(GLuint program, GLint location, std::span<const glm::ivec2> values) {
    glProgramUniform2iv(program, location, count(values), glm::value_ptr(values.front()));
}

void setUniform(GLuint program, GLint location, std::span<const glm::ivec3> values) {
    glProgramUniform3iv(program, location, count(values), glm::value_ptr(values.front()));
}

void setUniform(GLuint program, GLint location, std::span<const glm::mat3> values) {
    glProgramUniformMatrix3fv(program, location, count(values), GL_FALSE,
                              glm::value_ptr(values.front()));
}

void setUniform(GLuint program, GLint location, std::span<const glm::mat4> values) {
    glProgramUniformMatrix4fv(program, location, count(values), GL_FALSE,
                              glm::value_ptr(values.front()));
}

}  // namespace eyrie::gl
