// SPDX-License-Identifier: Apache-2.0
#include "renderer/gl/mapped_depth.h"

namespace eyrie::gl {

MappedDepth::MappedDepth(std::size_t pixels) : pixels_(pixels) {
    constexpr GLbitfield kUse = GL_MAP_READ_BIT | GL_MAP_PERSISTENT_BIT | GL_MAP_COHERENT_BIT;
    const auto bytes = static_cast<GLsizeiptr>(pixels * sizeof(float));
    glNamedBufferStorage(buffer_.id(), bytes, nullptr, kUse | GL_CLIENT_STORAGE_BIT);
    mapped_ = static_cast<const float*>(glMapNamedBufferRange(buffer_.id(), 0, bytes, kUse));
    if (mapped_ == nullptr)
        nothing_.resize(pixels);
}

std::span<const float> MappedDepth::first(std::size_t pixels) const {
    return {mapped_ == nullptr ? nothing_.data() : mapped_, pixels};
}

}  // namespace eyrie::gl
