// SPDX-License-Identifier: Apache-2.0
#include "renderer/draw/prefetch.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

namespace eyrie::draw {
namespace {

using fabric::Vec3;
using std::chrono::duration;

/// Two frames further apart tell nothing of how the camera moves.
constexpr duration<double> kLongestStep{1.0};
constexpr duration<double> kFurthestAhead{1.0};

}  // namespace

void Prefetch::follow(const lod::View& view, const fabric::Mat4& worldFromObject,
                      Clock::time_point now) {
    const fabric::Mat4 objectFromWorld = glm::inverse(worldFromObject);
    const Vec3 eye(objectFromWorld * fabric::Vec4(view.eye, 1.0));
    const duration<double> step = now - time_;
    const bool tells = step < kLongestStep && step > duration<double>(0);
    metresASecond_ = tells ? (eye - eye_) / step.count() : Vec3(0);
    eye_ = eye;
    time_ = now;
    forward_ = glm::normalize(fabric::Mat3(objectFromWorld) * lod::middleDirection(view));
    focalPixels_ = view.greatestFocalPixels();
}

Vec3 Prefetch::eyeIn(duration<double> time) const {
    return eye_ + metresASecond_ * std::min(time, kFurthestAhead).count();
}

double Prefetch::alignment(const fabric::Box& bounds, const Vec3& eye) const {
    const Vec3 toCentre = bounds.centre() - eye;
    return glm::dot(forward_, toCentre) / std::max(glm::length(toCentre), 1e-9);
}

double distanceTo(const fabric::Box& bounds, const Vec3& eye) {
    return glm::length(eye - glm::clamp(eye, bounds.min, bounds.max));
}

}  // namespace eyrie::draw
