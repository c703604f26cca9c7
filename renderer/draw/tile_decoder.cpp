// SPDX-License-Identifier: Apache-2.0
#include "renderer/draw/tile_decoder.h"

#include <array>
#include <utility>

#include <fmt/format.h>

#include "fabric/status.h"
#include "renderer/terrain/quadtree.h"

namespace eyrie::draw {
namespace {

/// What renderer/effects/tile_decode.effect declares; OpenGL 4.5 promises all of it.
constexpr GLint kInvocations = 256;
constexpr GLint kBuffers = 3;

constexpr GLsizeiptr kScratchBytes =
    2 * sizeof(std::uint32_t) * (terrain::kMaxTileCells + 1) * (terrain::kMaxTileCells + 1);

absl::Status checkLimit(GLenum name, const char* text, GLint needed) {
    GLint limit = 0;
    glGetIntegerv(name, &limit);
    return limit >= needed
               ? absl::OkStatus()
               : absl::FailedPreconditionError(fmt::format(
                     "tile_decode.effect: this driver's {} is {}; decoding tiles on the device "
                     "takes {}; decode them on the processor",
                     text, limit, needed));
}

}  // namespace

absl::StatusOr<TileDecoder> TileDecoder::create() {
    RETURN_IF_ERROR(checkLimit(GL_MAX_COMPUTE_WORK_GROUP_INVOCATIONS,
                               "GL_MAX_COMPUTE_WORK_GROUP_INVOCATIONS", kInvocations));
    RETURN_IF_ERROR(checkLimit(GL_MAX_COMPUTE_SHADER_STORAGE_BLOCKS,
                               "GL_MAX_COMPUTE_SHADER_STORAGE_BLOCKS", kBuffers));
    ASSIGN_OR_RETURN(effects::TileDecodeEffect effect, effects::TileDecodeEffect::create({}));
    return TileDecoder(std::move(effect));
}

TileDecoder::TileDecoder(effects::TileDecodeEffect effect) : effect_(std::move(effect)) {
    glNamedBufferStorage(scratch_.id(), kScratchBytes, nullptr, 0);
}

void TileDecoder::decode(std::span<const std::uint32_t> outline, const gl::Buffer& tile) const {
    const gl::Buffer input;  // the driver keeps it as long as the work needs it
    glNamedBufferStorage(input.id(), static_cast<GLsizeiptr>(outline.size_bytes()), outline.data(),
                         0);
    const std::array<GLuint, kBuffers> buffers = {input.id(), tile.id(), scratch_.id()};
    glBindBuffersBase(GL_SHADER_STORAGE_BUFFER, 0, kBuffers, buffers.data());
    effect_.use();
    glDispatchCompute(1, 1, 1);
    // For the next tile, which takes the same scratch, and for what draws or reads this one.
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_VERTEX_ATTRIB_ARRAY_BARRIER_BIT |
                    GL_ELEMENT_ARRAY_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
    glBindBuffersBase(GL_SHADER_STORAGE_BUFFER, 0, kBuffers, nullptr);
}

}  // namespace eyrie::draw
