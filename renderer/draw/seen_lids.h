// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "fabric/box.h"
#include "fabric/viewport.h"
#include "renderer/lod/view.h"

namespace eyrie::draw {

/// Where in a view an eye outside a mesh may look through its lids (mesh/lids.h).
class SeenLids {
public:
    /// `lids`: object space, metres.
    SeenLids(std::span<const fabric::Box> lids, const lod::ObjectView& view);

    /// Pixels of the view outside which no ray from the eye meets a lid before what lies in
    /// `bounds` (conservative).
    fabric::PixelViewport before(const fabric::Box& bounds) const;

    fabric::PixelViewport pixelsOf(const fabric::Box& bounds) const {
        return view_.coveredPixels(bounds);
    }

private:
    struct Seen {
        fabric::PixelViewport pixels;
        double nearest;  ///< along the view, metres
    };

    const lod::ObjectView& view_;
    std::vector<Seen> lids_;
};

}  // namespace eyrie::draw
