// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <utility>

#include <GL/glew.h>

namespace eyrie::gl {

/// A place among the commands given so far, which can be waited for. Lives on its context's thread.
class Fence {
public:
    Fence() : sync_(glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0)) {}
    ~Fence() {
        if (sync_ != nullptr)
            glDeleteSync(sync_);
    }
    Fence(Fence&& other) noexcept : sync_(std::exchange(other.sync_, nullptr)) {}
    Fence& operator=(Fence&& other) noexcept {
        std::swap(sync_, other.sync_);
        return *this;
    }
    Fence(const Fence&) = delete;
    Fence& operator=(const Fence&) = delete;

    /// Until the device has come there, or has been lost.
    void await() const {
        constexpr GLuint64 kLookAgainNanoseconds = 1'000'000'000;
        while (glClientWaitSync(sync_, GL_SYNC_FLUSH_COMMANDS_BIT, kLookAgainNanoseconds) ==
               GL_TIMEOUT_EXPIRED) {
        }
    }

private:
    GLsync sync_;
};

}  // namespace eyrie::gl
