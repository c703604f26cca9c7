// SPDX-License-Identifier: Apache-2.0
#include "renderer/draw/hidden_backs.h"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace eyrie::draw {
namespace {

/// For as long as it lives, only backs are drawn, and only on these pixels.
class BacksOnly {
public:
    BacksOnly(const fabric::PixelViewport& pixels, const fabric::PixelViewport& before)
        : before_(before) {
        glEnable(GL_CULL_FACE);
        glCullFace(GL_FRONT);
        glScissor(pixels.x, pixels.y, pixels.width, pixels.height);
    }
    BacksOnly(const BacksOnly&) = delete;
    BacksOnly& operator=(const BacksOnly&) = delete;
    ~BacksOnly() {
        glDisable(GL_CULL_FACE);
        glCullFace(GL_BACK);
        glScissor(before_.x, before_.y, before_.width, before_.height);
    }

private:
    fabric::PixelViewport before_;
};

}  // namespace

IndexRun IndexRun::within(const Piece& piece) const {
    const auto begin = static_cast<GLsizei>(3 * piece.firstTriangle);
    const auto end = begin + static_cast<GLsizei>(3 * piece.triangles);
    IndexRun part;
    part.first = std::max(first, begin);
    part.count = std::max(std::min(first + count, end) - part.first, 0);
    part.fronts = std::clamp(first + fronts - part.first, 0, part.count);
    return part;
}

void drawIndices(const SeenTriangles& triangles, const IndexRun& run) {
    if (run.fronts > 0) {
        glEnable(GL_CULL_FACE);
        triangles.draw(run.first, run.fronts);
        glDisable(GL_CULL_FACE);
    }
    if (run.fronts < run.count)
        triangles.draw(run.first + run.fronts, run.count - run.fronts);
}

bool mayHideBacks(const fabric::Box& bounds, const FrameState& frame,
                  const fabric::Mat4& worldFromObject) {
    if (frame.shading == fabric::Shading::Wireframe)
        return false;
    const lod::ObjectView view(frame.view, worldFromObject);
    const fabric::Vec3 eye(view.objectFromView()[3]);
    if (bounds.grownBy(0.01 * glm::length(bounds.size())).contains(eye))
        return false;
    const fabric::Box box = fabric::transformed(bounds, view.viewFromObject());
    const fabric::Vec3 nearest = glm::clamp(fabric::Vec3(0.0), box.min, box.max);
    const fabric::Frustum& frustum = frame.view.frustum;
    const double x = std::max(std::abs(frustum.left), std::abs(frustum.right));
    const double y = std::max(std::abs(frustum.bottom), std::abs(frustum.top));
    return glm::length(nearest) > fabric::kNearMetres * std::sqrt(1 + x * x + y * y);
}

/// Where lids cover much of a piece, all of it is drawn at once: vertices are a quarter of the
/// time.
void HiddenBacks::draw(const SeenTriangles& triangles, const Piece& piece, const IndexRun& run,
                       bool isOneSided) const {
    const IndexRun bothSides{run.first, run.count, 0};
    if (!areAny_)
        return drawIndices(triangles, bothSides);
    if (isOneSided)
        return drawIndices(triangles, {run.first, run.count, run.count});
    const fabric::PixelViewport pixels = lids_.before(piece.bounds);
    if (pixels.area() > lids_.pixelsOf(piece.bounds).area() / 2)
        return drawIndices(triangles, bothSides);
    drawIndices(triangles, run);
    const fabric::PixelViewport seen = fabric::intersection(pixels, part_);
    if (run.fronts == 0 || seen.isEmpty())
        return;
    const BacksOnly state(seen, part_);
    drawIndices(triangles, {run.first, run.fronts, 0});
}

}  // namespace eyrie::draw
