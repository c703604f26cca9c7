// SPDX-License-Identifier: Apache-2.0
#include <memory>
#include <utility>

#include <fmt/format.h>

#include "coordinator/api/field_names.h"
#include "coordinator/api/handler_list.h"
#include "coordinator/api/handlers.h"
#include "coordinator/api/session_message.h"
#include "coordinator/frame/frame_source.h"
#include "coordinator/stream/session.h"
#include "coordinator/stream/session_book.h"
#include "coordinator/stream/viewer_messages.h"
#include "eyrie/v1/coordinator_service.pb.h"
#include "fabric/frame_data.h"
#include "fabric/status.h"
#include "wire/camera.h"
#include "wire/frame.h"

namespace eyrie::api {
namespace {

using SharedSession = std::shared_ptr<stream::Session>;

absl::StatusOr<SharedSession> sessionOf(const stream::SessionBook& sessions,
                                        const std::string& id) {
    if (SharedSession session = sessions.find(id))
        return session;
    return absl::NotFoundError(fmt::format("there is no session '{}', or nobody is in it any more",
                                           stream::sanitised(id.substr(0, 64))));
}

/// What of the change is given, checked as what viewers ask for is. Errors name its fields.
absl::StatusOr<stream::ViewChange> changeOf(const v1::SessionChange& message) {
    v1::FrameData data;
    data.set_version(1);
    // Of what is absent something that is right stands in; it is not used.
    *data.mutable_camera() =
        message.has_camera() ? message.camera() : wire::toMessage(fabric::Camera());
    data.set_tau_pixels(message.has_tau_pixels() ? message.tau_pixels() : 1);
    data.set_shading(message.shading());
    *data.mutable_look() = message.look();
    const absl::StatusOr<fabric::FrameData> checked = wire::fromMessage(data);
    if (!checked.ok())
        return checked.status();
    stream::ViewChange change;
    if (message.has_camera())
        change.camera = checked->camera;
    if (message.has_tau_pixels())
        change.tauPixels = checked->tauPixels;
    if (message.has_shading())
        change.shading = checked->shading;
    if (message.has_look())
        change.look = checked->look;
    if (message.has_underground())
        change.isUnderground = message.underground();
    if (message.has_shown()) {
        ASSIGN_OR_RETURN(change.shown, stream::shownFromMessage(message.shown()));
    }
    return change;
}

/// NotFound, naming what there is: a canvas or segment that the configuration has not. Viewers see
/// nothing by such names.
absl::Status checkNames(coordinator::FrameSource& frames, const coordinator::Shown& shown) {
    coordinator::FrameRequest request;
    request.shown = {shown};
    const absl::Status status = frames.seen(request).status();
    return absl::IsNotFound(status) ? status : absl::OkStatus();
}

}  // namespace

void addSessionHandlers(Handlers& handlers, coordinator::FrameSource& frames,
                        stream::SessionBook& sessions) {
    handlers.add<v1::ListSessionsRequest, v1::ListSessionsResponse>(
        "ListSessions",
        [&sessions](const v1::ListSessionsRequest&,
                    const Call&) -> absl::StatusOr<v1::ListSessionsResponse> {
            v1::ListSessionsResponse response;
            for (const SharedSession& session : sessions.all())
                *response.add_sessions() = sessionMessage(*session);
            return response;
        });
    handlers.add<v1::GetSessionRequest, v1::GetSessionResponse>(
        "GetSession",
        [&sessions](const v1::GetSessionRequest& request,
                    const Call&) -> absl::StatusOr<v1::GetSessionResponse> {
            ASSIGN_OR_RETURN(const SharedSession session, sessionOf(sessions, request.id()));
            v1::GetSessionResponse response;
            *response.mutable_session() = sessionMessage(*session);
            return response;
        });
    handlers.add<v1::ChangeSessionRequest, v1::ChangeSessionResponse>(
        "ChangeSession",
        [&frames, &sessions](const v1::ChangeSessionRequest& request,
                             const Call&) -> absl::StatusOr<v1::ChangeSessionResponse> {
            ASSIGN_OR_RETURN(const SharedSession session, sessionOf(sessions, request.id()));
            const absl::StatusOr<stream::ViewChange> change = changeOf(request.change());
            RETURN_IF_ERROR(
                inRequest(change.status(), "change.", *v1::SessionChange::descriptor()));
            if (change->shown)
                RETURN_IF_ERROR(checkNames(frames, *change->shown));
            RETURN_IF_ERROR(session->change(*change));
            v1::ChangeSessionResponse response;
            *response.mutable_session() = sessionMessage(*session);
            return response;
        });
    handlers.add<v1::CloseSessionRequest, v1::CloseSessionResponse>(
        "CloseSession",
        [&sessions](const v1::CloseSessionRequest& request,
                    const Call&) -> absl::StatusOr<v1::CloseSessionResponse> {
            ASSIGN_OR_RETURN(const SharedSession session, sessionOf(sessions, request.id()));
            session->close();
            return v1::CloseSessionResponse();
        });
}

}  // namespace eyrie::api
