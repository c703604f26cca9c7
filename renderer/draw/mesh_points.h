// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include <absl/status/status.h>

#include "effects/mesh_points_effect.h"
#include "renderer/draw/drawable.h"
#include "renderer/draw/mesh_paging.h"
#include "renderer/effects/effect_variants.h"
#include "renderer/gl/object.h"
#include "renderer/mesh/eym_format.h"

namespace eyrie::draw {

using PointPrograms = effects::EffectVariants<effects::MeshPointsEffect>;

/// Draws nodes of points of one mesh: each point as the pixel of the view that it lies in.
class MeshPoints {
public:
    /// `programs` outlives this.
    MeshPoints(PointPrograms& programs, const mesh::EymFile& file,
               const fabric::SceneObject& object);

    /// To be called when a frame begins: object and lights are set with the first piece.
    void begin() { prepared_ = nullptr; }

    /// The first Piece::points points. `colour` is for what has no colours, or where the frame has
    /// colours of its own. Binds a program and a vertex array.
    absl::Status draw(const Piece& piece, const DeviceNode& node, std::uint32_t colour,
                      const FrameState& frame);

private:
    absl::Status prepare(const FrameState& frame);

    PointPrograms& programs_;
    fabric::Mat4 worldFromObject_;
    fabric::Mat4 objectFromLattice_;
    bool hasColours_;
    gl::VertexArray vertexArray_;
    const effects::MeshPointsEffect* prepared_ = nullptr;  ///< of this frame
};

}  // namespace eyrie::draw
