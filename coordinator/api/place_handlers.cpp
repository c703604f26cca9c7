// SPDX-License-Identifier: Apache-2.0
#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "coordinator/api/asked_view.h"
#include "coordinator/api/handler_list.h"
#include "coordinator/api/handlers.h"
#include "coordinator/stream/profile.h"
#include "coordinator/stream/viewer_messages.h"
#include "eyrie/v1/coordinator_service.pb.h"
#include "fabric/channel_task.h"
#include "fabric/pick.h"
#include "fabric/seen_area.h"
#include "fabric/status.h"
#include "wire/hidden_objects.h"
#include "wire/pick.h"

namespace eyrie::api {
namespace {

/// In the request's own words, whose rows count from the top; fabric's count from below.
absl::Status checkPlace(const v1::PickPointRequest& message, int width, int height) {
    const auto outside = [](const char* field, auto value, auto least, int most) {
        return absl::InvalidArgumentError(
            fmt::format("{} is {}; it must be from {} to {}", field, value, least, most));
    };
    for (const auto& [field, side] : {std::pair("width", width), std::pair("height", height)})
        if (side < 1 || side > fabric::kMaxViewPixels)
            return outside(field, side, 1, fabric::kMaxViewPixels);
    if (!(message.x() >= 0 && message.x() <= width))
        return outside("x", message.x(), 0, width);
    if (!(message.y() >= 0 && message.y() <= height))
        return outside("y", message.y(), 0, height);
    return absl::OkStatus();
}

/// What was found may be of another scene than `before` has.
absl::Status checkScene(const coordinator::FrameSource& frames, const coordinator::Status& before) {
    if (frames.status().sceneRevision == before.sceneRevision)
        return absl::OkStatus();
    return absl::AbortedError("the scene was replaced meanwhile; ask again");
}

absl::StatusOr<v1::PickPointResponse> pickPoint(coordinator::FrameSource& frames,
                                                const v1::PickPointRequest& message) {
    fabric::PickRequest request;
    if (message.has_exaggeration())
        request.exaggeration = message.exaggeration();
    ASSIGN_OR_RETURN(request.camera, cameraOf(message.camera(), frames, request.exaggeration));
    request.viewWidth = message.has_width() ? message.width() : kUsualWidth;
    request.viewHeight = message.has_height() ? message.height() : kUsualHeight;
    RETURN_IF_ERROR(checkPlace(message, request.viewWidth, request.viewHeight));
    request.place = {message.x(), request.viewHeight - message.y()};  // rows count from the top
    ASSIGN_OR_RETURN(request.hidden,
                     wire::hiddenObjects(message.hidden_objects(), "hiddenObjects"));
    RETURN_IF_ERROR(fabric::validate(request));
    coordinator::FrameRequest picture;
    picture.camera = request.camera;
    picture.width = request.viewWidth;
    picture.height = request.viewHeight;
    ASSIGN_OR_RETURN(coordinator::Shown shown, stream::shownFromMessage(message.shown()));
    picture.shown = {std::move(shown)};
    using compound::Stereo;
    const coordinator::Shown& seenBy = picture.shown.front();
    if (!seenBy.eye && (seenBy.stereo == Stereo::SideBySide || seenBy.stereo == Stereo::TopBottom))
        return absl::InvalidArgumentError(
            "shown.stereo puts two pictures into one of another size; name the eye, and pick in "
            "its picture");
    ASSIGN_OR_RETURN(const fabric::SeenAreas areas, frames.seen(picture));
    ASSIGN_OR_RETURN(const std::optional<fabric::PickRequest> seen, fabric::pickIn(areas, request));
    v1::PickPointResponse response;
    if (!seen)
        return response;
    const coordinator::Status status = frames.status();
    ASSIGN_OR_RETURN(const fabric::Picked picked, frames.pick(*seen));
    RETURN_IF_ERROR(checkScene(frames, status));
    if (!picked)
        return response;
    *response.mutable_point() = wire::toMessage(*picked);
    const std::vector<fabric::SceneObject>& objects = status.scene.objects;
    if (const auto object = static_cast<std::size_t>(picked->object); object < objects.size())
        response.set_object_name(stream::sanitised(objects[object].name));
    return response;
}

absl::StatusOr<v1::MeasureProfileResponse> measureProfile(coordinator::FrameSource& frames,
                                                          const v1::MeasureProfileRequest& message,
                                                          const Call& call) {
    ASSIGN_OR_RETURN(fabric::HiddenObjects hidden,
                     wire::hiddenObjects(message.hidden_objects(), "hiddenObjects"));
    const stream::ProfileLine line{{message.from().x(), message.from().y()},
                                   {message.to().x(), message.to().y()},
                                   message.samples(),
                                   std::move(hidden)};
    RETURN_IF_ERROR(stream::validate(line));
    const coordinator::Status status = frames.status();
    ASSIGN_OR_RETURN(const fabric::Box bounds, stream::profiledBounds(status));
    v1::MeasureProfileResponse response;
    for (int i = 0; i < line.samples; ++i) {
        if (call.stop.stop_requested())
            return absl::CancelledError("the caller has gone");
        ASSIGN_OR_RETURN(const fabric::Picked picked,
                         frames.pick(stream::pickFromAbove(line, i, bounds)));
        v1::ProfileSample& sample = *response.add_samples();
        if (picked)
            *sample.mutable_point() = wire::toMessage(*picked);
    }
    RETURN_IF_ERROR(checkScene(frames, status));
    return response;
}

}  // namespace

void addPlaceHandlers(Handlers& handlers, coordinator::FrameSource& frames) {
    handlers.add<v1::PickPointRequest, v1::PickPointResponse>(
        "PickPoint", [&frames](const v1::PickPointRequest& request, const Call&) {
            return pickPoint(frames, request);
        });
    handlers.add<v1::MeasureProfileRequest, v1::MeasureProfileResponse>(
        "MeasureProfile", [&frames](const v1::MeasureProfileRequest& request, const Call& call) {
            return measureProfile(frames, request, call);
        });
}

}  // namespace eyrie::api
