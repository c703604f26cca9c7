// SPDX-License-Identifier: Apache-2.0
#include "coordinator/stream/viewer_messages.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include "coordinator/stream/home_camera.h"
#include "coordinator/stream/statistics_message.h"
#include "eyrie/v1/viewer.pb.h"
#include "fabric/status.h"
#include "fabric/utf8.h"
#include "wire/camera.h"
#include "wire/hidden_objects.h"
#include "wire/pick.h"
#include "wire/scene_info.h"
#include "wire/sight.h"
#include "wire/statistics.h"

namespace eyrie::stream {
namespace {

constexpr std::size_t kMaxProblemBytes = 400;

v1::RendererCondition toMessage(coordinator::RendererCondition condition) {
    using enum coordinator::RendererCondition;
    switch (condition) {
        case Ready:
            return v1::RENDERER_CONDITION_READY;
        case Opening:
            return v1::RENDERER_CONDITION_OPENING;
        case Late:
            return v1::RENDERER_CONDITION_LATE;
        case Draining:
            return v1::RENDERER_CONDITION_DRAINING;
        case Dead:
            return v1::RENDERER_CONDITION_DEAD;
        case Refused:
            break;
    }
    return v1::RENDERER_CONDITION_REFUSED;
}

void setVector(const fabric::Vec3& value, v1::Vector3& message) {
    message.set_x(value.x);
    message.set_y(value.y);
    message.set_z(value.z);
}

void setSeen(const fabric::SeenAreas& areas, v1::Frame& frame) {
    if (!areas)
        return;
    frame.set_through_wall(true);
    for (const fabric::SeenArea& area : *areas) {
        v1::SeenArea& message = *frame.add_seen();
        message.set_x(area.corner.x);
        message.set_y(area.corner.y);
        message.set_width(area.size.x);
        message.set_height(area.size.y);
        *message.mutable_sight() = wire::toMessage(area.sight);
    }
}

v1::ObjectState toMessage(fabric::ObjectKind kind, const fabric::ObjectInfo& info) {
    v1::ObjectState state;
    state.set_kind(kind == fabric::ObjectKind::Terrain ? v1::OBJECT_KIND_TERRAIN
                                                       : v1::OBJECT_KIND_MESH);
    *state.mutable_bounds() = wire::toMessage(info.bounds);
    state.set_triangles(info.triangles);
    return state;
}

/// From the terrain's height 0 to its lowest and highest ground.
fabric::Box heightsOf(const fabric::GroundGrid& grid) {
    const fabric::Vec3 up(grid.worldFromGrid[2]);
    fabric::Box heights;
    heights.grow(up * static_cast<double>(*std::ranges::min_element(grid.lowest)));
    heights.grow(up * static_cast<double>(*std::ranges::max_element(grid.highest)));
    return heights;
}

FrameAck ackFromMessage(const v1::FrameAck& message) {
    FrameAck ack{message.frame_number()};
    if (message.has_received_bytes())
        ack.receivedBytes = message.received_bytes();
    // Who claims more than a minute, or what is no number, is not believed.
    constexpr double kMostMilliseconds = 60'000;
    const double milliseconds = message.decode_milliseconds();
    if (milliseconds > 0 && milliseconds <= kMostMilliseconds)
        ack.decoding = std::chrono::duration<double, std::milli>(milliseconds);
    return ack;
}

absl::StatusOr<ProfileLine> lineFromMessage(const v1::ViewerProfile& message) {
    ASSIGN_OR_RETURN(fabric::HiddenObjects hidden,
                     wire::hiddenObjects(message.hidden_objects(), "hiddenObjects"));
    ProfileLine line{{message.from().x(), message.from().y()},
                     {message.to().x(), message.to().y()},
                     message.samples(),
                     std::move(hidden)};
    RETURN_IF_ERROR(validate(line));
    return line;
}

}  // namespace

absl::StatusOr<Request> parseRequest(std::span<const std::byte> bytes) {
    v1::ViewerRequest message;
    if (!message.ParseFromArray(bytes.data(), static_cast<int>(bytes.size())))
        return absl::DataLossError("not an eyrie.v1.ViewerRequest");
    switch (message.request_case()) {
        case v1::ViewerRequest::kView: {
            absl::StatusOr<ViewRequest> view = viewFromMessage(message.view());
            RETURN_IF_ERROR(view.status());
            return absl::StatusOr<Request>(absl::in_place, *std::move(view));
        }
        case v1::ViewerRequest::kFrameAck:
            return ackFromMessage(message.frame_ack());
        case v1::ViewerRequest::kScreen: {
            OwnScreen screen;
            if (message.screen().has_shown()) {
                ASSIGN_OR_RETURN(screen.shown, shownFromMessage(message.screen().shown()));
            }
            return screen;
        }
        case v1::ViewerRequest::kReady:
            return SwapReady{message.ready().swap()};
        case v1::ViewerRequest::kPick:
            return ViewerPick{message.pick().sequence(),
                              wire::fromMessage(message.pick().request())};
        case v1::ViewerRequest::kProfile:
            return ViewerProfile{message.profile().sequence(), lineFromMessage(message.profile())};
        case v1::ViewerRequest::kSwitchLayout:
            return coordinator::SwitchLayout{message.switch_layout().canvas(),
                                             message.switch_layout().layout()};
        case v1::ViewerRequest::kLead:
            return TakeLead{};
        case v1::ViewerRequest::kAbilities:
            return Abilities{message.abilities().h264(), message.abilities().tiles()};
        case v1::ViewerRequest::REQUEST_NOT_SET:
            break;
    }
    return absl::DataLossError("an eyrie.v1.ViewerRequest without a request");
}

std::string stateMessage(const coordinator::Status& status, std::string_view problem,
                         std::string_view refusal, std::string_view note, const Place& place) {
    v1::ViewerResponse response;
    v1::SessionState& state = *response.mutable_state();
    state = sessionState(status, problem);
    if (!refusal.empty())
        state.set_note(sanitised(refusal));
    else if (state.note().empty())
        state.set_note(sanitised(note));
    state.mutable_place()->set_session(place.session);
    state.mutable_place()->set_viewers(place.viewers);
    state.mutable_place()->set_leads(place.leads);
    state.mutable_place()->set_led(place.isLed);
    state.mutable_place()->set_may_control(place.mayControl);
    state.mutable_place()->set_barrier(sanitised(place.barrier));
    state.mutable_place()->set_together(place.together);
    state.mutable_place()->set_behind(place.behind);
    return response.SerializeAsString();
}

v1::SessionState sessionState(const coordinator::Status& status, std::string_view problem) {
    v1::SessionState state;
    for (const coordinator::RendererStatus& renderer : status.renderers) {
        v1::RendererState& message = *state.add_renderers();
        message.set_id(sanitised(renderer.id));
        *message.mutable_device() = wire::toMessage(renderer.device);
        message.set_alive(renderer.isAlive());
        message.set_condition(toMessage(renderer.condition));
        message.set_why(sanitised(renderer.why));
        message.set_since_unix_milliseconds(
            std::chrono::duration_cast<std::chrono::milliseconds>(renderer.since.time_since_epoch())
                .count());
    }
    if (!status.sceneInfo.bounds.isEmpty()) {
        *state.mutable_scene_bounds() = wire::toMessage(status.sceneInfo.bounds);
        *state.mutable_home() = wire::toMessage(homeCamera(status.sceneInfo.bounds));
    }
    for (const fabric::SceneObject& object : status.scene.objects)
        state.add_object_names(sanitised(object.name));
    // Of the scene that is open, which is the one that is to be shown but while it is replaced.
    if (status.sceneInfo.objects.size() == status.scene.objects.size())
        for (std::size_t i = 0; i < status.scene.objects.size(); ++i)
            *state.add_objects() =
                toMessage(status.scene.objects[i].kind, status.sceneInfo.objects[i]);
    if (status.sceneInfo.ground)
        for (const fabric::GroundGrid& grid : *status.sceneInfo.ground)
            if (grid.object < state.objects_size() && !grid.highest.empty())
                *state.mutable_objects(grid.object)->mutable_heights() =
                    wire::toMessage(heightsOf(grid));
    for (const coordinator::CanvasStatus& canvas : status.canvases) {
        v1::CanvasState& message = *state.add_canvases();
        message.set_name(sanitised(canvas.name));
        for (const std::string& segment : canvas.segments) message.add_segments(sanitised(segment));
        for (const std::string& layout : canvas.layouts) message.add_layouts(sanitised(layout));
        message.set_layout(sanitised(canvas.layout));
    }
    state.set_scene_triangles(status.sceneInfo.triangles);
    state.set_problem(sanitised(problem.empty() ? status.problem : problem));
    state.set_note(sanitised(status.note));
    return state;
}

std::string frameMessage(const EncodedFrame& encoded, const coordinator::RenderedFrame& rendered,
                         std::size_t bytes) {
    v1::ViewerResponse response;
    v1::Frame& frame = *response.mutable_frame();
    frame.set_frame_number(encoded.frameNumber);
    frame.set_view_sequence(encoded.viewSequence);
    const EncodedPicture& picture = *encoded.picture;
    frame.set_still(picture.fineness != Fineness::Moving);
    frame.set_width(picture.width);
    frame.set_height(picture.height);
    if (picture.fineness == Fineness::Exact)
        frame.set_png(picture.bytes.data(), bytes);
    else if (picture.video)
        frame.set_h264(picture.bytes.data(), bytes);
    else
        frame.set_jpeg(picture.bytes.data(), bytes);
    frame.set_picture_bytes(picture.bytes.size());
    frame.set_pixel_hash(picture.pixelHash);
    frame.set_quality(picture.quality);
    for (const JpegTile& each : picture.tiles) {
        v1::JpegTile& tile = *frame.add_tiles();
        tile.set_x(each.x);
        tile.set_y(each.y);
        tile.set_bytes(each.bytes);
    }
    if (picture.video) {
        frame.mutable_video()->set_stream(picture.video->stream);
        frame.mutable_video()->set_picture(picture.video->picture);
        frame.mutable_video()->set_key(picture.video->isKey);
    }
    frame.set_link_bytes_per_second(encoded.linkBytesPerSecond);
    frame.set_swap(encoded.swap);
    frame.set_revision(rendered.revision);
    if (encoded.output < rendered.pictures.size())
        setSeen(rendered.pictures[encoded.output].seen, frame);
    *frame.mutable_statistics() = statisticsMessage(rendered, picture.width, picture.height);
    if (encoded.liftedCamera)
        *frame.mutable_lifted_camera() = wire::toMessage(*encoded.liftedCamera);
    if (encoded.lift)
        setVector(*encoded.lift, *frame.mutable_lift());
    if (encoded.ledView)
        *frame.mutable_led_view() = toMessage(*encoded.ledView);
    return response.SerializeAsString();
}

std::string framePartMessage(std::uint64_t frameNumber, std::size_t offset,
                             std::span<const std::byte> bytes) {
    v1::ViewerResponse response;
    v1::FramePart& part = *response.mutable_frame_part();
    part.set_frame_number(frameNumber);
    part.set_offset(offset);
    part.set_bytes(bytes.data(), bytes.size());
    return response.SerializeAsString();
}

std::string swapMessage(std::uint64_t swap) {
    v1::ViewerResponse response;
    response.mutable_swap()->set_swap(swap);
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

std::string profiledMessage(std::uint64_t sequence,
                            const absl::StatusOr<std::vector<fabric::Picked>>& samples) {
    v1::ViewerResponse response;
    v1::ViewerProfiled& message = *response.mutable_profiled();
    message.set_sequence(sequence);
    if (!samples.ok()) {
        message.set_problem(
            sanitised({samples.status().message().data(), samples.status().message().size()}));
        return response.SerializeAsString();
    }
    for (const fabric::Picked& picked : *samples) {
        v1::ProfileSample& sample = *message.add_samples();
        if (picked)
            *sample.mutable_point() = wire::toMessage(*picked);
    }
    return response.SerializeAsString();
}

std::string sanitised(std::string_view text) {
    std::string result;
    while (!text.empty()) {
        const std::size_t length = fabric::utf8Length(text);
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
