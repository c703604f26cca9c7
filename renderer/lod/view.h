// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>

#include "fabric/box.h"
#include "fabric/camera.h"
#include "fabric/channel_task.h"
#include "fabric/frustum.h"
#include "fabric/raster.h"
#include "fabric/sight.h"
#include "fabric/viewport.h"

namespace eyrie::lod {

/// An eye with a picture: what is seen through which pixels.
///
/// What level of detail is decided for is the whole view, so that every channel of it chooses the
/// same LOD nodes. Where a task has a raster, what is drawn is another one of the same eye and axes
/// (rasterView). docs/decisions/0037-two-views.md
struct View {
    /// Straight ahead from the camera.
    View(const fabric::Camera& camera, int widthPixels, int heightPixels);
    /// Through `sight` where there is one. Precondition: fabric::validate() of both is ok.
    View(const fabric::Camera& camera, const std::optional<fabric::Sight>& sight, int widthPixels,
         int heightPixels);

    double greatestFocalPixels() const;

    fabric::Vec3 eye;  ///< world metres
    fabric::Mat3 viewFromWorldRotation;
    fabric::Mat3 cameraFromWorldRotation;  ///< of what the camera carries: its light
    fabric::Frustum frustum;               ///< against the view's own axis
    int width;
    int height;
    /// Pixels per unit of tangent, across and up. Straight ahead both are height / (2 tan(fovY /
    /// 2)).
    fabric::Vec2 focalPixels;
    /// From one pixel to the next in the pixels that errors are counted in: those of the view that
    /// a raster samples.
    fabric::Vec2 step{1, 1};
};

/// What of `view` a raster shows: `view` itself where there is none, and, to the bit, where it is
/// the view's own pixels. Precondition: fabric::validate(raster) is ok.
View rasterView(const View& view, const std::optional<fabric::Raster>& raster);

/// The two views of a task.
struct TaskViews {
    TaskViews(const fabric::Camera& camera, const fabric::ChannelTask& task)
        : whole(camera, task.sight, task.viewWidth, task.viewHeight),
          drawn(rasterView(whole, task.raster)) {}

    View whole;  ///< for level of detail and errors
    View drawn;  ///< for culling, drawing and occlusion: its pixels are the image's
};

/// The direction through the middle of the picture, world axes; unit length.
fabric::Vec3 middleDirection(const View& view);

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
    /// holds the 1/cos of the widest angle off axis besides the nearest depth, and the greater of
    /// the focal lengths where pixels are not square. `bounds` covers the drawn surface; it is
    /// grown here by `errorMetres` to cover the source's. Infinite when the grown bounds reach the
    /// eye; 0 when nothing of them can be seen. For errors along z, such as terrain's,
    /// VerticalError is narrower. Proof: docs/errors.md#projection.
    double screenSpaceErrorPixels(double errorMetres, const fabric::Box& bounds) const;
    /// No less than that, at a fraction of the time: from the box's distance alone, as if it were
    /// at the picture's corner. Infinite where it would be above 16 pixels.
    double looseErrorPixels(double errorMetres, const fabric::Box& bounds) const;

    /// What single precision makes of a surface, in pixels: an upper bound on how far what is seen
    /// of it in `bounds` is from where its corners say. `reach` holds all corners of the triangles
    /// that are drawn there: from near by, the rounding of one far away is many pixels. 0 where it
    /// is less than OpenGL snaps corners to; infinite when the surface may come to the eye by it.
    /// Proof: docs/errors.md#corners-far-away.
    double roundingPixels(const fabric::Box& reach, const fabric::Box& bounds) const;
    /// The same of one triangle.
    double roundingPixels(std::span<const fabric::Vec3, 3> triangle) const;

    /// Both of one triangle that is drawn with `errorMetres` of geometric error: how far what is
    /// within that of it may be from where it is seen, in pixels. Where that is no more than
    /// `enoughPixels`, any number up to that. Infinite only when the eye is as near to it as the
    /// error, but for the secant of the picture's corner. Proof: docs/errors.md#corners-far-away.
    double displacedPixels(double errorMetres, std::span<const fabric::Vec3, 3> triangle,
                           double enoughPixels) const;

    const View& view() const { return view_; }
    const fabric::Mat4& viewFromObject() const { return viewFromObject_; }
    const fabric::Mat4& objectFromView() const { return objectFromView_; }

private:
    bool isRoundedUnseen(const fabric::Box& reach, const fabric::Box& bounds) const;

    View view_;
    fabric::Mat4 viewFromObject_;
    fabric::Mat4 objectFromView_;
    double metresPerObjectUnit_;       ///< the largest stretch of worldFromObject
    double leastMetresPerObjectUnit_;  ///< the smallest
    /// How far a corner is drawn from where it is, of its distance to the eye.
    double rounding_;
};

}  // namespace eyrie::lod
