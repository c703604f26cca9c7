// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "fabric/box.h"
#include "fabric/viewport.h"
#include "renderer/draw/drawable.h"
#include "renderer/draw/seen_lids.h"
#include "renderer/draw/seen_triangles.h"
#include "renderer/gl/object.h"
#include "renderer/lod/view.h"

/// Backs of a mesh's triangles that nobody sees (docs/errors.md, back faces).
namespace eyrie::draw {

/// Indices of a node.
struct IndexRun {
    GLsizei first = 0;
    GLsizei count = 0;
    GLsizei fronts = 0;  ///< the first of them, of whose triangles the culled side is not seen

    /// Those of them that belong to a piece that may be a part of the node.
    IndexRun within(const Piece& piece) const;
};

void drawIndices(const SeenTriangles& triangles, const IndexRun& run);

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

    /// The backs of the run's fronts are seen through lids only, or, where `isOneSided`, not even
    /// there.
    void draw(const SeenTriangles& triangles, const Piece& piece, const IndexRun& run,
              bool isOneSided) const;

private:
    bool areAny_;
    SeenLids lids_;
    fabric::PixelViewport part_;
};

}  // namespace eyrie::draw
