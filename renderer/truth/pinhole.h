// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "fabric/camera.h"

/// The independent reference: double precision, the textbook's formulas and the full-resolution
/// source. Shares no code with what it judges, but for which triangles a picture is made of
/// (drawn_terrain.h, drawn_mesh.h). Tests and benchmarks only.
namespace eyrie::truth {

/// A half-line in world space; a point on it is origin + t * direction, t >= 0.
struct Ray {
    fabric::Vec3 origin;
    fabric::Vec3 direction;

    fabric::Vec3 at(double t) const { return origin + t * direction; }
};

/// A rectangle that is looked through, by three corners in world space.
struct Screen {
    fabric::Vec3 lowerLeft;
    fabric::Vec3 lowerRight;
    fabric::Vec3 upperLeft;
};

/// An eye with a picture: pixels to rays and back. Pixel coordinates run from the picture's
/// lower left corner, x right, y up; the centre of the first pixel is (0.5, 0.5).
class Pinhole {
public:
    /// Precondition: fabric::validate(camera) is ok, sizes are positive.
    Pinhole(const fabric::Camera& camera, int width, int height);
    /// The picture fills the screen. Precondition: the eye is on the side from which the corners
    /// are where their names say.
    Pinhole(const fabric::Vec3& eye, const Screen& screen, int width, int height);

    /// Other points of the same picture: pixel (i, j) is that at origin + (i + 1/2, j + 1/2) *
    /// step.
    Pinhole sampled(const fabric::Vec2& origin, const fabric::Vec2& step, int width,
                    int height) const;

    /// The ray through a picture point. Its parameter t is the view-space depth in metres.
    Ray rayThrough(double x, double y) const;
    /// Where a world point falls in the picture; nothing unless it lies before the eye.
    std::optional<fabric::Vec2> project(const fabric::Vec3& world) const;
    /// Distance along the viewing axis, which is at right angles to the screen, metres.
    double depth(const fabric::Vec3& world) const;
    /// Between two picture points, in pixels of the picture that was sampled, if one was.
    double pixelsBetween(const fabric::Vec2& a, const fabric::Vec2& b) const;

    int width() const { return width_; }
    int height() const { return height_; }
    /// Of its own pixels, per unit of tangent; the lesser where they are not square.
    double focalPixels() const;

private:
    fabric::Vec3 eye_;
    fabric::Vec3 forward_;      ///< unit length
    fabric::Vec3 lowerLeft_;    ///< the picture's, from the eye, at unit depth
    fabric::Vec3 toNextPixel_;  ///< at unit depth
    fabric::Vec3 toNextRow_;
    fabric::Vec2 step_{1, 1};
    int width_;
    int height_;
};

}  // namespace eyrie::truth
