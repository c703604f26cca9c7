// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "fabric/box.h"
#include "fabric/viewport.h"
#include "renderer/lod/view.h"

namespace eyrie::occlusion {

/// The farthest depth of each block of a picture's pixels, and of blocks of blocks up to one:
/// answers at once whether all that is drawn on a rectangle is nearer than something behind it.
///
/// After N. Greene, M. Kass, G. Miller, "Hierarchical Z-Buffer Visibility", 1993. Depth is reversed
/// (fabric::Frustum): 0 is infinitely far, so where nothing is drawn nothing is hidden. Plain
/// values, no GL.
class DepthPyramid {
public:
    static constexpr int kBlockPixels = 8;  ///< a side of the smallest blocks

    /// Of nothing: hides nothing but what has no pixels.
    DepthPyramid() = default;

    /// Replaces what was there. `area` is any rectangle of a view; `depth` its pixels as
    /// fabric::Image has them: rows from the bottom up, area.width each, no NaN.
    void build(const fabric::PixelViewport& area, std::span<const float> depth);

    const fabric::PixelViewport& area() const { return area_; }

    /// True only if every pixel of `rect` (of the view) that lies in area() is strictly nearer than
    /// `reversedDepth`, by which an object with no pixel outside `rect` and none nearer than that
    /// changes no pixel of area(). Never true by error; false where a block that `rect` touches
    /// holds a pixel too far.
    bool hides(const fabric::PixelViewport& rect, float reversedDepth) const;

private:
    struct Level {
        int width = 0;
        int height = 0;
        std::vector<float> farthest;  ///< row by row

        float at(int x, int y) const {
            return farthest[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                            static_cast<std::size_t>(x)];
        }
    };
    /// Smallest blocks, from the first to the last.
    struct Blocks {
        int x0, y0, x1, y1;
    };

    static Level smallestBlocks(int width, int height, std::span<const float> depth);
    static Level blocksOf(const Level& finer);
    bool hides(std::size_t level, int x, int y, const Blocks& blocks, float reversedDepth) const;

    fabric::PixelViewport area_;
    std::vector<Level> levels_;  ///< smallest blocks first; the last is one block
};

/// The reversed depth that nothing drawn of what lies in `bounds` (object space) exceeds; infinite
/// when `bounds` reaches the near plane.
///
/// Larger than that of the nearest corner by a part in 512. A pixel's depth is interpolated in
/// single precision and, vertices being snapped to 1/256 pixel, may lie beyond the triangle's own:
/// meshes are held to this depth (draw/depth_limit.h); of terrain 3.4e-5 of the distance was seen,
/// on a comb of 4,000 m walls (docs/errors.md#rasterisation).
float nearestReversedDepth(const lod::ObjectView& view, const fabric::Box& bounds);

/// True only if nothing within `bounds` (object space) changes a pixel of the pyramid's area, in
/// the view whose depth it holds.
bool isHidden(const DepthPyramid& pyramid, const lod::ObjectView& view, const fabric::Box& bounds);

}  // namespace eyrie::occlusion
