// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "fabric/box.h"
#include "fabric/viewport.h"
#include "renderer/draw/drawable.h"
#include "renderer/draw/mesh_paging.h"
#include "renderer/draw/seen_lids.h"
#include "renderer/gl/object.h"
#include "renderer/lod/view.h"

/// Backs of a mesh's triangles that nobody sees (docs/errors.md, back faces).
namespace eyrie::draw {

/// `count` indices from `first` on, the first `fronts` of them without the culled side.
void drawIndices(const DeviceNode& node, GLsizei first, GLsizei count, GLsizei fronts);

/// Whether a picture may go without them. From inside its bounds a surface may well be seen from
/// behind, as may what the near plane cuts open; and lines have no sides.
bool mayHideBacks(const fabric::Box& bounds, const FrameState& frame,
                  const fabric::Mat4& worldFromObject);

/// Draws the pieces of one frame so.
class HiddenBacks {
public:
    /// `part`: FrameState::part.
    HiddenBacks(bool areAny, std::span<const fabric::Box> lids, const lod::ObjectView& view,
                const fabric::PixelViewport& part)
        : areAny_(areAny), lids_(lids, view), part_(part) {}

    /// `count` indices of the piece from `first` on. The backs of the first `fronts` are seen
    /// through lids only, or, where `isOneSided`, not even there.
    void draw(const DeviceNode& node, const Piece& piece, GLsizei first, GLsizei count,
              GLsizei fronts, bool isOneSided) const;

private:
    bool areAny_;
    SeenLids lids_;
    fabric::PixelViewport part_;
};

}  // namespace eyrie::draw
