// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "fabric/camera.h"

/// The independent reference: double precision, the textbook's formulas and the full-resolution
/// source. Shares no code with what it judges. Tests and benchmarks only.
namespace eyrie::truth {

/// A half-line in world space; a point on it is origin + t * direction, t >= 0.
struct Ray {
    fabric::Vec3 origin;
    fabric::Vec3 direction;

    fabric::Vec3 at(double t) const { return origin + t * direction; }
};

/// A camera with a picture: pixels to rays and back. Pixel coordinates run from the picture's
/// lower left corner, x right, y up; the centre of the first pixel is (0.5, 0.5).
class Pinhole {
public:
    /// Precondition: fabric::validate(camera) is ok, sizes are positive.
    Pinhole(const fabric::Camera& camera, int width, int height);

    /// The ray through a picture point. Its parameter t is the view-space depth in metres.
    Ray rayThrough(double x, double y) const;
    /// Where a world point falls in the picture; nothing unless it lies before the eye.
    std::optional<fabric::Vec2> project(const fabric::Vec3& world) const;
    /// Distance along the viewing axis, metres.
    double depth(const fabric::Vec3& world) const;

    int width() const { return width_; }
    int height() const { return height_; }
    double focalPixels() const { return focal_; }

private:
    fabric::Vec3 eye_;
    fabric::Vec3 right_;
    fabric::Vec3 up_;
    fabric::Vec3 forward_;
    double focal_;
    int width_;
    int height_;
};

}  // namespace eyrie::truth
