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
constexpr GLint kBuffers = 4;

constexpr std::size_t kScratchBytes =
    2 * sizeof(std::uint32_t) * (terrain::kMaxTileCells + 1) * (terrain::kMaxTileCells + 1);
/// Two pages' tiles: more than a processor has cores, and few enough for the scratch they take.
constexpr std::size_t kSideBySide = 2 * terrain::kPageTiles * terrain::kPageTiles;

template <typename T>
void fill(const gl::Buffer& buffer, const std::vector<T>& values) {
    glNamedBufferStorage(buffer.id(), static_cast<GLsizeiptr>(values.size() * sizeof(T)),
                         values.data(), 0);
}

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
    glNamedBufferStorage(scratch_.id(), kSideBySide * kScratchBytes, nullptr, 0);
}

void TileDecoder::decode(std::span<const std::uint32_t> outline, const gl::Buffer& tile,
                         std::size_t bytes) {
    if (places_.size() == kSideBySide)
        publish();
    const std::size_t words = bytes / sizeof(std::uint32_t);
    places_.push_back({static_cast<std::uint32_t>(outlines_.size()),
                       static_cast<std::uint32_t>(madeWords_), static_cast<std::uint32_t>(words)});
    tiles_.push_back(tile.id());
    outlines_.insert(outlines_.end(), outline.begin(), outline.end());
    madeWords_ += words;
}

void TileDecoder::publish() {
    if (places_.empty())
        return;
    // The driver keeps buffers as long as the work needs them.
    const gl::Buffer places;
    const gl::Buffer outlines;
    const gl::Buffer made;
    fill(places, places_);
    fill(outlines, outlines_);
    glNamedBufferStorage(made.id(), static_cast<GLsizeiptr>(madeWords_ * sizeof(std::uint32_t)),
                         nullptr, 0);
    const std::array<GLuint, kBuffers> buffers = {places.id(), outlines.id(), made.id(),
                                                  scratch_.id()};
    glBindBuffersBase(GL_SHADER_STORAGE_BUFFER, 0, kBuffers, buffers.data());
    effect_.use();
    glDispatchCompute(static_cast<GLuint>(places_.size()), 1, 1);
    glBindBuffersBase(GL_SHADER_STORAGE_BUFFER, 0, kBuffers, nullptr);
    // For the copies, and for the tiles that take the same scratch next.
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT | GL_SHADER_STORAGE_BARRIER_BIT);
    for (std::size_t k = 0; k < places_.size(); ++k) {
        const auto bytes = [](std::uint32_t words) {
            return static_cast<GLsizeiptr>(words * sizeof(std::uint32_t));
        };
        glCopyNamedBufferSubData(made.id(), tiles_[k], bytes(places_[k].tile), 0,
                                 bytes(places_[k].tileWords));
    }
    places_.clear();
    tiles_.clear();
    outlines_.clear();
    madeWords_ = 0;
}

}  // namespace eyrie::draw
