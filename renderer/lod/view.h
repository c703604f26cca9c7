// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "fabric/box.h"
#include "fabric/camera.h"
#include "fabric/frustum.h"
#include "fabric/viewport.h"

namespace eyrie::lod {

/// A camera with a picture size: what level of detail and culling are decided for.
/// Always the whole view, so that every channel of it chooses the same LOD nodes.
struct View {
    View(const fabric::Camera& camera, int widthPixels, int heightPixels);

    fabric::Vec3 eye;  ///< world metres
    fabric::Mat3 viewFromWorldRotation;
    fabric::Frustum frustum;
    int width;
    int height;
    double focalPixels;  ///< height / (2 tan(fovY / 2)): pixels per unit of tangent
};

/// Largest singular value of a linear map.
double largestStretch(const fabric::Mat3& m);

/// The part of `view`'s frustum that `part` of its pixels looks through.
fabric::Frustum subFrustum(const View& view, const fabric::PixelViewport& part);

/// A view as one object of the scene sees it: boxes and errors are in object space.
class ObjectView {
public:
    ObjectView(const View& view, const fabric::Mat4& worldFromObject);

    /// False only if no point of `bounds` can be seen through `frustum` (conservative).
    bool isVisible(const fabric::Box& bounds, const fabric::Frustum& frustum) const;
    /// The same for the whole view.
    bool isVisible(const fabric::Box& bounds) const { return isVisible(bounds, view_.frustum); }

    /// Pixels of the whole view outside which no point of `bounds` is drawn (conservative); all of
    /// the view when part of `bounds` is beside or behind the eye.
    fabric::PixelViewport coveredPixels(const fabric::Box& bounds) const;

    /// Screen-space error, in pixels, of an LOD node drawn with `errorMetres` of geometric error.
    ///
    /// An upper bound for every visible point in `bounds` and every direction of the error: it
    /// holds the 1/cos of the widest angle off axis besides the nearest depth. `bounds` covers the
    /// drawn surface; it is grown here by `errorMetres` to cover the source's. Infinite when the
    /// grown bounds reach the eye; 0 when nothing of them can be seen. For errors along z, such as
    /// terrain's, VerticalError is narrower.
    /// Proof: docs/errors.md#projection.
    double screenSpaceErrorPixels(double errorMetres, const fabric::Box& bounds) const;

    const View& view() const { return view_; }
    const fabric::Mat4& viewFromObject() const { return viewFromObject_; }
    const fabric::Mat4& objectFromView() const { return objectFromView_; }

private:
    View view_;
    fabric::Mat4 viewFromObject_;
    fabric::Mat4 objectFromView_;
    double metresPerObjectUnit_;  ///< the largest stretch of worldFromObject
};

}  // namespace eyrie::lod
