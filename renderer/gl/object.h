// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <utility>

#include <GL/glew.h>

namespace eyrie::gl {

/// Owns one GL name. Nothing else calls glCreate* or glDelete*. Lives on its context's thread.
template <GLuint (*Create)(), void (*Delete)(GLuint)>
class Object {
public:
    Object() : id_(Create()) {}
    ~Object() {
        if (id_ != 0)
            Delete(id_);
    }
    Object(Object&& other) noexcept : id_(std::exchange(other.id_, 0)) {}
    Object& operator=(Object&& other) noexcept {
        std::swap(id_, other.id_);
        return *this;
    }
    Object(const Object&) = delete;
    Object& operator=(const Object&) = delete;
    GLuint id() const { return id_; }

private:
    GLuint id_;
};

namespace detail {
inline GLuint createBuffer() {
    GLuint id = 0;
    glCreateBuffers(1, &id);
    return id;
}
inline void deleteBuffer(GLuint id) { glDeleteBuffers(1, &id); }
inline GLuint createTexture2D() {
    GLuint id = 0;
    glCreateTextures(GL_TEXTURE_2D, 1, &id);
    return id;
}
inline void deleteTexture(GLuint id) { glDeleteTextures(1, &id); }
inline GLuint createVertexArray() {
    GLuint id = 0;
    glCreateVertexArrays(1, &id);
    return id;
}
inline void deleteVertexArray(GLuint id) { glDeleteVertexArrays(1, &id); }
inline GLuint createFramebuffer() {
    GLuint id = 0;
    glCreateFramebuffers(1, &id);
    return id;
}
inline void deleteFramebuffer(GLuint id) { glDeleteFramebuffers(1, &id); }
inline GLuint createRenderbuffer() {
    GLuint id = 0;
    glCreateRenderbuffers(1, &id);
    return id;
}
inline void deleteRenderbuffer(GLuint id) { glDeleteRenderbuffers(1, &id); }
inline GLuint createAnySampleQuery() {
    GLuint id = 0;
    glCreateQueries(GL_ANY_SAMPLES_PASSED, 1, &id);
    return id;
}
inline void deleteQuery(GLuint id) { glDeleteQueries(1, &id); }
inline GLuint createProgram() { return glCreateProgram(); }
inline void deleteProgram(GLuint id) { glDeleteProgram(id); }
}  // namespace detail

using Buffer = Object<detail::createBuffer, detail::deleteBuffer>;
using Texture2D = Object<detail::createTexture2D, detail::deleteTexture>;
using VertexArray = Object<detail::createVertexArray, detail::deleteVertexArray>;
using FramebufferObject = Object<detail::createFramebuffer, detail::deleteFramebuffer>;
using Renderbuffer = Object<detail::createRenderbuffer, detail::deleteRenderbuffer>;
using AnySampleQuery = Object<detail::createAnySampleQuery, detail::deleteQuery>;
using ProgramObject = Object<detail::createProgram, detail::deleteProgram>;

}  // namespace eyrie::gl
