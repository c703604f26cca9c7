// SPDX-License-Identifier: Apache-2.0
#include "renderer/gl/framebuffer.h"

#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "fabric/status.h"
#include "renderer/gl/debug_output.h"

namespace eyrie::gl {

absl::Status Framebuffer::resize(int width, int height) {
    if (width <= width_ && height <= height_)
        return absl::OkStatus();
    GLint limit = 0;
    glGetIntegerv(GL_MAX_RENDERBUFFER_SIZE, &limit);
    const int newWidth = std::max(width, width_);
    const int newHeight = std::max(height, height_);
    if (newWidth > limit || newHeight > limit)
        return absl::ResourceExhaustedError(
            fmt::format("a view of {} x {} pixels exceeds this device's limit of {} x {}", width,
                        height, limit, limit));
    width_ = height_ = 0;
    glNamedRenderbufferStorage(colour_.id(), GL_RGBA8, newWidth, newHeight);
    glNamedRenderbufferStorage(depth_.id(), GL_DEPTH_COMPONENT32F, newWidth, newHeight);
    RETURN_IF_ERROR(takeGlError());
    glNamedFramebufferRenderbuffer(framebuffer_.id(), GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER,
                                   colour_.id());
    glNamedFramebufferRenderbuffer(framebuffer_.id(), GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER,
                                   depth_.id());
    const GLenum status = glCheckNamedFramebufferStatus(framebuffer_.id(), GL_DRAW_FRAMEBUFFER);
    if (status != GL_FRAMEBUFFER_COMPLETE)
        return absl::ResourceExhaustedError(
            fmt::format("the device refuses a framebuffer of {} x {} pixels (status 0x{:x})",
                        newWidth, newHeight, status));
    width_ = newWidth;
    height_ = newHeight;
    return absl::OkStatus();
}

void Framebuffer::begin(int viewWidth, int viewHeight, const fabric::PixelViewport& part,
                        fabric::Rgba background) {
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.id());
    glViewport(0, 0, viewWidth, viewHeight);
    glEnable(GL_SCISSOR_TEST);
    glScissor(part.x, part.y, part.width, part.height);
    glDepthMask(GL_TRUE);
    const auto unit = [](std::uint8_t value) { return static_cast<float>(value) / 255.0F; };
    const std::array<GLfloat, 4> colour = {unit(background.r), unit(background.g),
                                           unit(background.b), unit(background.a)};
    constexpr GLfloat kInfinitelyFar = 0;
    glClearNamedFramebufferfv(framebuffer_.id(), GL_COLOR, 0, colour.data());
    glClearNamedFramebufferfv(framebuffer_.id(), GL_DEPTH, 0, &kInfinitelyFar);
}

fabric::Image Framebuffer::read(const fabric::PixelViewport& part, bool withDepth) {
    fabric::Image image = fabric::makeImage(part, {}, withDepth);
    read(part, {image.colour.data(), withDepth ? image.depth.data() : nullptr});
    return image;
}

void Framebuffer::read(const fabric::PixelViewport& part, const fabric::PixelRoom& room) {
    if (part.isEmpty())
        return;
    glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer_.id());
    glReadPixels(part.x, part.y, part.width, part.height, GL_RGBA, GL_UNSIGNED_BYTE, room.colour);
    if (room.depth != nullptr)
        glReadPixels(part.x, part.y, part.width, part.height, GL_DEPTH_COMPONENT, GL_FLOAT,
                     room.depth);
}

std::span<const float> Framebuffer::depth(const fabric::PixelViewport& part) {
    if (part.isEmpty())
        return {};
    const auto pixels = static_cast<std::size_t>(part.area());
    if (!depths_ || depths_->size() < pixels || !depths_->isMapped())
        depths_.emplace(pixels);
    if (!depths_->isMapped())
        return depths_->first(pixels);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer_.id());
    glBindBuffer(GL_PIXEL_PACK_BUFFER, depths_->id());
    glReadPixels(part.x, part.y, part.width, part.height, GL_DEPTH_COMPONENT, GL_FLOAT, nullptr);
    glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
    glFinish();
    return depths_->first(pixels);
}

}  // namespace eyrie::gl
