// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "renderer/gl/object.h"

namespace eyrie::gl {

/// An attribute of 32-bit words, as an effect file declares it: in a buffer of its own or its own
/// part of one, tightly packed, at the buffer binding numbered as its location.
struct VertexInput {
    GLuint location = 0;
    GLint words = 1;  ///< a vertex; components of the shader's input beyond these read as 0

    /// Once for each vertex array. An attribute that is not enabled has the value that
    /// glVertexAttribI* gave it.
    void define(const VertexArray& array, bool enabled = true) const {
        glVertexArrayAttribIFormat(array.id(), location, words, GL_UNSIGNED_INT, 0);
        glVertexArrayAttribBinding(array.id(), location, location);
        if (enabled)
            glEnableVertexArrayAttrib(array.id(), location);
    }

    /// Takes the words from `offset` bytes into `buffer` on.
    void source(const VertexArray& array, const Buffer& buffer, GLintptr offset) const {
        glVertexArrayVertexBuffer(array.id(), location, buffer.id(), offset, 4 * words);
    }
};

}  // namespace eyrie::gl
