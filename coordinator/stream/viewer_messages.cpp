// SPDX-License-Identifier: Apache-2.0
#include "coordinator/stream/viewer_messages.h"

#include <algorithm>

#include "coordinator/stream/home_camera.h"
#include "eyrie/v1/frame.pb.h"
#include "eyrie/v1/look.pb.h"
#include "eyrie/v1/viewer.pb.h"
#include "fabric/status.h"
#include "wire/camera.h"
#include "wire/frame.h"
#include "wire/pick.h"
#include "wire/scene_info.h"
#include "wire/statistics.h"

namespace eyrie::stream {
namespace {

constexpr std::size_t kMaxProblemBytes = 400;

absl::StatusOr<ViewRequest> viewFromMessage(const v1::ViewRequest& message) {
    v1::FrameData data;
    data.set_version(1);
    *data.mutable_camera() = message.camera();
    data.set_tau_pixels(message.tau_pixels());
    data.set_shading(message.shading());
    *data.mutable_look() = message.look();
    ASSIGN_OR_RETURN(const fabric::FrameData frameData, wire::fromMessage(data));
    ViewRequest view;
    view.sequence = message.sequence();
    view.frame.camera = frameData.camera;
    view.frame.tauPixels = frameData.tauPixels;
    view.frame.shading = frameData.shading;
    view.frame.look = frameData.look;
    view.isUnderground = message.underground();
    if (message.has_budget_milliseconds()) {
        RETURN_IF_ERROR(fabric::validateBudgetMilliseconds(message.budget_milliseconds()));
        view.frame.budgetMilliseconds = message.budget_milliseconds();
    }
    view.frame.completeness = fabric::Completeness::Interactive;
    view.frame.width = std::clamp(message.width(), kMinPictureSide, kMaxPictureSide);
    view.frame.height = std::clamp(message.height(), kMinPictureSide, kMaxPictureSide);
    return view;
}

/// Bytes of the UTF-8 character at the start of `text`; 0 when there is none.
std::size_t utf8Length(std::string_view text) {
    const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
    const unsigned char lead = byte(0);
    const std::size_t length = lead < 0x80                    ? 1
                               : lead >= 0xC2 && lead <= 0xDF ? 2
                               : lead >= 0xE0 && lead <= 0xEF ? 3
                               : lead >= 0xF0 && lead <= 0xF4 ? 4
                                                              : 0;
    if (length == 0 || length > text.size())
        return 0;
    for (std::size_t i = 1; i < length; ++i)
        if ((byte(i) & 0xC0) != 0x80)
            return 0;
    // Overlong forms, surrogates and what lies above U+10FFFF are no characters either.
    const bool isOutside = (lead == 0xE0 && byte(1) < 0xA0) || (lead == 0xED && byte(1) > 0x9F) ||
                           (lead == 0xF0 && byte(1) < 0x90) || (lead == 0xF4 && byte(1) > 0x8F);
    return isOutside ? 0 : length;
}

}  // namespace

absl::StatusOr<std::variant<ViewRequest, FrameAck, ViewerPick>> parseRequest(
    std::span<const std::byte> bytes) {
    v1::ViewerRequest message;
    if (!message.ParseFromArray(bytes.data(), static_cast<int>(bytes.size())))
        return absl::DataLossError("not an eyrie.v1.ViewerRequest");
    switch (message.request_case()) {
        case v1::ViewerRequest::kView: {
            ASSIGN_OR_RETURN(ViewRequest view, viewFromMessage(message.view()));
            return view;
        }
        case v1::ViewerRequest::kFrameAck:
            return FrameAck{message.frame_ack().frame_number()};
        case v1::ViewerRequest::kPick:
            return ViewerPick{message.pick().sequence(),
                              wire::fromMessage(message.pick().request())};
        case v1::ViewerRequest::REQUEST_NOT_SET:
            break;
    }
    return absl::DataLossError("an eyrie.v1.ViewerRequest without a request");
}

std::string stateMessage(const coordinator::Status& status, std::string_view problem) {
    v1::ViewerResponse response;
    v1::SessionState& state = *response.mutable_state();
    for (const coordinator::RendererStatus& renderer : status.renderers) {
        v1::RendererState& message = *state.add_renderers();
        message.set_id(sanitised(renderer.id));
        *message.mutable_device() = wire::toMessage(renderer.device);
        message.set_alive(renderer.alive);
    }
    if (!status.sceneInfo.bounds.isEmpty()) {
        *state.mutable_scene_bounds() = wire::toMessage(status.sceneInfo.bounds);
        *state.mutable_home() = wire::toMessage(homeCamera(status.sceneInfo.bounds));
    }
    for (const fabric::SceneObject& object : status.scene.objects)
        state.add_object_names(sanitised(object.name));
    state.set_scene_triangles(status.sceneInfo.triangles);
    state.set_problem(sanitised(problem.empty() ? status.problem : problem));
    return response.SerializeAsString();
}

std::string frameMessage(const EncodedFrame& encoded, const coordinator::RenderedFrame& rendered) {
    v1::ViewerResponse response;
    v1::Frame& frame = *response.mutable_frame();
    frame.set_frame_number(encoded.frameNumber);
    frame.set_view_sequence(encoded.viewSequence);
    frame.set_still(encoded.isStill);
    frame.set_width(rendered.image.area.width);
    frame.set_height(rendered.image.area.height);
    frame.set_jpeg(encoded.jpeg.data(), encoded.jpeg.size());
    *frame.mutable_statistics() = wire::toMessage(rendered.statistics);
    frame.mutable_statistics()->set_width(rendered.image.area.width);
    frame.mutable_statistics()->set_height(rendered.image.area.height);
    *frame.mutable_statistics()->mutable_renderer() = wire::toMessage(rendered.device);
    if (encoded.liftedCamera)
        *frame.mutable_lifted_camera() = wire::toMessage(*encoded.liftedCamera);
    return response.SerializeAsString();
}

std::string pickedMessage(std::uint64_t sequence, const absl::StatusOr<fabric::Picked>& picked) {
    v1::ViewerResponse response;
    v1::ViewerPicked& message = *response.mutable_picked();
    message.set_sequence(sequence);
    if (!picked.ok())
        message.set_problem(
            sanitised({picked.status().message().data(), picked.status().message().size()}));
    else if (picked->has_value())
        *message.mutable_point() = wire::toMessage(**picked);
    return response.SerializeAsString();
}

std::string sanitised(std::string_view text) {
    std::string result;
    while (!text.empty()) {
        const std::size_t length = utf8Length(text);
        const bool isControl =
            length == 1 && (static_cast<unsigned char>(text[0]) < 0x20 || text[0] == 0x7F);
        const std::string_view shown = length == 0 ? "?" : isControl ? " " : text.substr(0, length);
        if (result.size() + shown.size() + 3 > kMaxProblemBytes)
            return result + "…";
        result += shown;
        text.remove_prefix(std::max<std::size_t>(length, 1));
    }
    return result;
}

}  // namespace eyrie::stream
