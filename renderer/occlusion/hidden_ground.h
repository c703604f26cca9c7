// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <span>

#include "fabric/box.h"
#include "fabric/viewport.h"
#include "renderer/lod/view.h"

namespace eyrie::occlusion {

/// Reads the reversed depths (fabric::Frustum) of a rectangle of a finished picture: rows from the
/// bottom up, there until the next call.
using ReadDepth = std::function<std::span<const float>(const fabric::PixelViewport& part)>;

/// How depths are best read: of a GPU, which takes as long for some hundred pixels as for 150,000,
/// those of all the picture, once some are asked for.
enum class Reading { ByParts, AllAtOnce };

/// Which ground nobody sees, neither in a picture of a terrain nor in one of its source, because
/// nearer ground is in front of it in both.
///
/// What is drawn in front is off by its own error, up or down the vertical plane through the eye in
/// which it is seen. So it has to stand higher, by as many pixels as the picture promises, than
/// what it is to hide: then the source's ground at the same place is in front as well. Tells so for
/// the depths at pixels' centres; a gap between them is narrower than a pixel.
/// Proof: docs/errors.md#ground-that-hills-hide.
///
/// Preconditions: the picture shows one height field, nothing else, and the eye is above it and its
/// source; between the eye and what covers what is asked about, the source has no hole (see
/// reachOf()). Horizontal distance is that of the object's x and y, so its vertical may stand
/// anyhow in the world.
class HiddenGround {
public:
    /// `view` is the one that is drawn, `drawn` the part of it that the picture shows. Keeps a
    /// reference to `view`.
    HiddenGround(const lod::ObjectView& view, const fabric::PixelViewport& drawn, ReadDepth read,
                 Reading reading = Reading::ByParts);

    /// The pixels that cover what lies within `bounds` (object space) in a picture that promises
    /// `pixels` (lod::View::step) or less, so that nobody sees it, drawn or of the source. Nothing
    /// where somebody may; no pixels where it is all beside the picture.
    std::optional<fabric::PixelViewport> coverOf(const fabric::Box& bounds, double pixels);
    /// The same of a triangle and all that lies up to `pixels` from it in the picture.
    std::optional<fabric::PixelViewport> coverOf(std::span<const fabric::Vec3, 3> corners,
                                                 double pixels);

    /// No farther from the eye, horizontally and in metres, is what these pixels show: infinity
    /// where one shows nothing, 0 for no pixels.
    double reachOf(const fabric::PixelViewport& part);

private:
    /// A rectangle of the picture in pixels, corner to corner.
    struct Rect {
        fabric::Vec2 low;
        fabric::Vec2 high;

        void add(const fabric::Vec2& p);
        bool isEmpty() const { return !(low.x <= high.x && low.y <= high.y); }
        bool operator==(const Rect&) const = default;
    };

    bool project(const fabric::Vec3& point, Rect& rect) const;
    bool raise(Rect& rect, double pixels) const;
    Rect clipped(const Rect& rect, double inside) const;
    std::optional<fabric::PixelViewport> coverOf(const Rect& rect, double pixels, double nearest);
    /// Depths are looked at row by row: visit(depths, how many, where the row looks).
    template <typename Visit>
    void forEachRow(const fabric::PixelViewport& part, Visit visit) const;
    bool allNearer(const fabric::PixelViewport& part, double nearest);
    void look(const fabric::PixelViewport& part);

    const lod::ObjectView& view_;
    const fabric::PixelViewport drawn_;
    const ReadDepth read_;
    const Reading reading_;
    fabric::Vec2 eye_;        ///< object space
    fabric::Vec3 up_;         ///< the object's z axis in the view, (x, y, depth)
    fabric::Vec2 lowerLeft_;  ///< of the view: object x and y per metre of depth
    fabric::Vec2 perColumn_;  ///< the same from pixel to pixel
    fabric::Vec2 perRow_;
    fabric::Vec2 shape_;  ///< of the pixels that errors are counted in: the shorter side is 1
    std::int64_t pixelsRead_ = 0;
    fabric::PixelViewport seen_;  ///< whose depths are here
    std::span<const float> depth_;
};

}  // namespace eyrie::occlusion
