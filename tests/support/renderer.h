// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <stdexcept>
#include <string>
#include <utility>

#include "renderer/gl/debug_output.h"
#include "renderer/renderer.h"

namespace eyrie::test {

/// With the options it has by itself; GL errors end the test. Throws what fails the test.
inline std::unique_ptr<Renderer> makeRenderer() {
    gl::setOnGlError(gl::OnGlError::Abort);
    auto renderer = Renderer::create({});
    if (!renderer.ok())
        throw std::runtime_error(renderer.status().ToString());
    return *std::move(renderer);
}

}  // namespace eyrie::test
