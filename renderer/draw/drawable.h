// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <absl/status/status.h>

#include "fabric/box.h"
#include "fabric/frame_data.h"
#include "fabric/scene.h"
#include "fabric/statistics.h"
#include "renderer/lod/view.h"

namespace eyrie::draw {

/// One LOD node of a frame's cut.
struct Piece {
    std::uint32_t index = 0;   ///< the drawable's own name for it, valid until the next cut
    double rangePosition = 0;  ///< where it starts in the drawable's share [0, 1) of the data
    fabric::Box bounds;        ///< object space, metres
};

/// What a drawable shows of itself in one view.
struct Cut {
    std::vector<Piece> pieces;     ///< ascending by rangePosition
    double tauAchievedPixels = 0;  ///< bound over all pieces
};

/// What is the same for every piece of a frame.
struct FrameState {
    const lod::View& view;
    const fabric::Scene& scene;
    fabric::Shading shading;
};

/// One object of the scene, on the GL thread.
class Drawable {
public:
    virtual ~Drawable() = default;

    /// Object space, metres.
    virtual fabric::Box bounds() const = 0;
    virtual std::uint64_t triangles() const = 0;
    virtual std::uint64_t bytes() const = 0;

    /// Chooses what stands for the object in a whole view. Depends on the view alone.
    virtual Cut selectCut(const lod::ObjectView& view, double tauPixels) = 0;

    /// Draws pieces of the last cut, in order, into the bound framebuffer. Loads what is missing;
    /// counts triangles and loaded pages in `statistics`. DataLoss when a page is corrupt.
    virtual absl::Status draw(std::span<const Piece> pieces, const FrameState& frame,
                              fabric::FrameStatistics& statistics) = 0;

    /// Ends a frame: what has not been drawn longest leaves the device when memory is short.
    virtual void trim() = 0;
};

}  // namespace eyrie::draw
