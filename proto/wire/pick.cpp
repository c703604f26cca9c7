// SPDX-License-Identifier: Apache-2.0
#include "wire/pick.h"

#include <cmath>

#include <fmt/format.h>

#include "eyrie/v1/camera.pb.h"
#include "eyrie/v1/frame.pb.h"
#include "eyrie/v1/pick.pb.h"
#include "fabric/status.h"
#include "wire/camera.h"
#include "wire/hidden_objects.h"
#include "wire/sight.h"

namespace eyrie::wire {
namespace {

void setVector(const fabric::Vec3& value, v1::Vector3& message) {
    message.set_x(value.x);
    message.set_y(value.y);
    message.set_z(value.z);
}

fabric::Vec3 vectorOf(const v1::Vector3& message) {
    return {message.x(), message.y(), message.z()};
}

bool isFinite(const fabric::Vec3& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

absl::Status check(const fabric::PickedPoint& point) {
    if (point.object < 0)
        return absl::InvalidArgumentError(
            fmt::format("point.object is {}; it must be 0 or more", point.object));
    if (!isFinite(point.worldMetres) || !isFinite(point.normal))
        return absl::InvalidArgumentError("point.position or point.normal is not finite");
    const bool hasError =
        point.errorMetres >= 0 && std::isfinite(point.errorMetres) && point.pixelMetres >= 0 &&
        std::isfinite(point.pixelMetres) && std::isfinite(point.elevationMetres.value_or(0)) &&
        point.elevationErrorMetres >= 0 && std::isfinite(point.elevationErrorMetres);
    const bool isInOrder =
        std::isfinite(point.nearestMetres) && std::isfinite(point.distanceMetres) &&
        point.nearestMetres <= point.distanceMetres && point.distanceMetres <= point.farthestMetres;
    if (!hasError || !isInOrder)
        return absl::InvalidArgumentError(fmt::format(
            "point has an error of {} m, a pixel of {} m and distances {} <= {} <= {}; they must "
            "be finite and in order",
            point.errorMetres, point.pixelMetres, point.nearestMetres, point.distanceMetres,
            point.farthestMetres));
    return absl::OkStatus();
}

}  // namespace

v1::PickRequest toMessage(const fabric::PickRequest& request) {
    v1::PickRequest message;
    *message.mutable_camera() = toMessage(request.camera);
    message.set_view_width(request.viewWidth);
    message.set_view_height(request.viewHeight);
    message.set_x(request.place.x);
    message.set_y(request.place.y);
    message.set_exaggeration(request.exaggeration);
    if (request.sight)
        *message.mutable_sight() = toMessage(*request.sight);
    setHidden(request.hidden, *message.mutable_hidden_objects());
    return message;
}

absl::StatusOr<fabric::PickRequest> fromMessage(const v1::PickRequest& message) {
    fabric::PickRequest request;
    ASSIGN_OR_RETURN(request.camera, fromMessage(message.camera()));
    request.viewWidth = message.view_width();
    request.viewHeight = message.view_height();
    request.place = {message.x(), message.y()};
    if (message.has_exaggeration())
        request.exaggeration = message.exaggeration();
    if (message.has_sight()) {
        ASSIGN_OR_RETURN(request.sight, fromMessage(message.sight()));
    }
    ASSIGN_OR_RETURN(request.hidden, hiddenObjects(message.hidden_objects(), "hiddenObjects"));
    RETURN_IF_ERROR(fabric::validate(request));
    return request;
}

v1::PickedPoint toMessage(const fabric::PickedPoint& point) {
    v1::PickedPoint message;
    message.set_object(point.object);
    setVector(point.worldMetres, *message.mutable_position());
    setVector(point.normal, *message.mutable_normal());
    message.set_distance(point.distanceMetres);
    message.set_error(point.errorMetres);
    message.set_nearest(point.nearestMetres);
    message.set_farthest(point.farthestMetres);
    message.set_pixel(point.pixelMetres);
    if (point.elevationMetres)
        message.set_elevation(*point.elevationMetres);
    message.set_elevation_error(point.elevationErrorMetres);
    return message;
}

absl::StatusOr<fabric::PickedPoint> fromMessage(const v1::PickedPoint& message) {
    fabric::PickedPoint point;
    point.object = message.object();
    point.worldMetres = vectorOf(message.position());
    point.normal = vectorOf(message.normal());
    point.distanceMetres = message.distance();
    point.errorMetres = message.error();
    point.nearestMetres = message.nearest();
    point.farthestMetres = message.farthest();
    point.pixelMetres = message.pixel();
    if (message.has_elevation())
        point.elevationMetres = message.elevation();
    point.elevationErrorMetres = message.elevation_error();
    RETURN_IF_ERROR(check(point));
    return point;
}

}  // namespace eyrie::wire
