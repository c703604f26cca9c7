// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include <absl/status/status.h>

#include "effects/lines_effect.h"
#include "fabric/box.h"
#include "renderer/gl/object.h"
#include "renderer/lod/view.h"

namespace eyrie::draw {

/// Draws boxes as twelve lines each, hidden by what is in front of them, with the depth state that
/// objects are drawn with. GL thread.
class BoxLines {
public:
    /// For boxes in the space of `worldFromObject`. Valid for one frame.
    absl::Status begin(const lod::View& view, const fabric::Mat4& worldFromObject);
    /// `colour` is linear.
    void draw(const fabric::Box& box, const glm::vec3& colour) const;

private:
    std::optional<effects::LinesEffect> program_;  ///< compiled when first needed
    gl::VertexArray noVertices_;
    fabric::Mat4 clipFromWorldAxes_{1.0};  ///< of metres from the eye
    fabric::Mat4 eyeFromObject_{1.0};      ///< metres from the eye, world axes
};

}  // namespace eyrie::draw
