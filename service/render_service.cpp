// SPDX-License-Identifier: Apache-2.0
#include "service/render_service.h"

#include <algorithm>
#include <new>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "fabric/status.h"
#include "service/drawn_channel.h"
#include "service/frame_receiver.h"
#include "service/picture_reply.h"
#include "wire/channel_program.h"
#include "wire/deadline.h"
#include "wire/frame.h"
#include "wire/nearly_drawn.h"
#include "wire/pick.h"
#include "wire/picture_header.h"
#include "wire/scene.h"
#include "wire/scene_info.h"
#include "wire/status.h"

namespace eyrie::service {
namespace {

/// Opens a scene whatever its files say that they hold.
absl::StatusOr<fabric::SceneInfo> opened(ChannelDrawer& drawer, const fabric::Scene& scene) {
    try {
        return drawer.openScene(scene);
    } catch (const std::bad_alloc&) {
        return absl::ResourceExhaustedError(
            "the renderer has no memory for the scene; open fewer or smaller files");
    }
}

absl::Status openScene(ChannelDrawer& drawer, const fabric::Scene& scene, PickThread& picks,
                       v1::OpenSceneResponse& response) {
    const absl::StatusOr<fabric::SceneInfo> info = opened(drawer, scene);
    // That its data are unavailable is not to say that the renderer is.
    if (absl::IsUnavailable(info.status()))
        return absl::AbortedError(info.status().message());
    RETURN_IF_ERROR(info.status());
    picks.use(drawer.pickFunction());
    response = wire::toMessage(*info);
    return absl::OkStatus();
}

/// A channel that is to be drawn, and how its picture is to be handed over.
struct Asked {
    fabric::FrameData frameData;
    fabric::ChannelTask task;
    wire::PixelEncoding encoding;
    std::optional<wire::MemoryOffer> memory;
    ChannelStory::Clock::time_point received;
};

void draw(ChannelDrawer& drawer, const Asked& asked, PictureMemories& memories,
          fabric::Rgba background, ReplyStream<v1::RenderChannelResponse>& reply) {
    const auto begun = ChannelStory::Clock::now();
    if (reply.isCancelled())
        return reply.fail(absl::CancelledError("the coordinator no longer waits for this channel"));
    const bool asJpeg = asked.task.jpegQuality > 0;
    wire::PictureMemory* const memory =
        asked.memory && !asJpeg ? memories.find(*asked.memory) : nullptr;
    fabric::Delivery delivery{reply.cancellation(),
                              [&] { reply.sendEarly(wire::kNearlyDrawnKey); }};
    bool isInMemory = false;
    if (memory != nullptr)
        delivery.room = [&](const fabric::PixelViewport& area, bool withDepth) {
            const auto room = memory->room(area, withDepth);
            isInMemory = room.has_value();
            return room;
        };
    absl::StatusOr<fabric::ChannelResult> result =
        drawnChannel(drawer, asked.frameData, asked.task, delivery);
    if (!result.ok())
        return reply.fail(result.status());
    const ChannelStory story{asked.received, begun, ChannelStory::Clock::now(), drawer.memory()};
    if (isInMemory)
        return reply.send(
            replyInMemory(*result, asked.task.wantsDepth && !result->image.area.isEmpty(), story));
    if (memory != nullptr && memory->put(result->image))
        return reply.send(replyInMemory(*result, result->image.hasDepth(), story));
    reply.send(asJpeg ? jpegReply(*std::move(result), asked.task, background, story)
                      : channelReply(*std::move(result), asked.encoding, story));
}

/// Of a caller that may not send any.
class RefusedFrame final : public grpc::ServerReadReactor<v1::PutFrameRequest> {
public:
    explicit RefusedFrame(const absl::Status& why) { Finish(wire::toGrpc(why)); }
    void OnDone() override { delete this; }
};

/// A call without a deadline has this one.
constexpr std::chrono::seconds kLongest{60};

std::chrono::steady_clock::time_point deadlineOf(const grpc::CallbackServerContext& context) {
    return std::chrono::steady_clock::now() +
           std::min<std::chrono::nanoseconds>(wire::timeLeft(context.raw_deadline()), kLongest);
}

}  // namespace

grpc::ServerUnaryReactor* RenderService::OpenScene(grpc::CallbackServerContext* context,
                                                   const v1::OpenSceneRequest* request,
                                                   v1::OpenSceneResponse* response) {
    grpc::ServerUnaryReactor* reactor = context->DefaultReactor();
    absl::StatusOr<fabric::Scene> scene = wire::fromMessage(request->scene());
    absl::Status status = wire::admit(security_, *context);
    if (status.ok())
        status = scene.status();
    if (status.ok())
        status = thread_.post([this, scene = *std::move(scene), address = request->address(),
                               response, reactor, context](ChannelDrawer& drawer) {
            if (context->IsCancelled())
                return reactor->Finish(wire::toGrpc(
                    absl::CancelledError("the coordinator no longer waits for this scene")));
            const absl::Status opened = openScene(drawer, scene, picks_, *response);
            if (opened.ok()) {
                background_ = scene.background;
                exchange_.mailbox().setAddress(address);
            }
            reactor->Finish(wire::toGrpc(opened));
        });
    if (!status.ok())
        reactor->Finish(wire::toGrpc(status));
    return reactor;
}

grpc::ServerUnaryReactor* RenderService::SetFrameData(grpc::CallbackServerContext* context,
                                                      const v1::SetFrameDataRequest* request,
                                                      v1::SetFrameDataResponse* /*response*/) {
    grpc::ServerUnaryReactor* reactor = context->DefaultReactor();
    const absl::StatusOr<fabric::FrameData> frameData = wire::fromMessage(request->frame_data());
    absl::Status status = wire::admit(security_, *context);
    if (status.ok())
        status = frameData.status();
    if (status.ok())
        frameData_.store(*frameData);
    reactor->Finish(wire::toGrpc(status));
    return reactor;
}

grpc::ServerWriteReactor<v1::RenderChannelResponse>* RenderService::RenderChannel(
    grpc::CallbackServerContext* context, const v1::RenderChannelRequest* request) {
    auto* reply = new ChannelReplyStream(*context, slots_, patience_);
    absl::Status status = wire::admit(security_, *context);
    if (status.ok())
        status = startDrawing(*request, *reply);
    if (!status.ok())
        reply->fail(status);
    return reply;
}

grpc::ServerWriteReactor<v1::RunProgramResponse>* RenderService::RunProgram(
    grpc::CallbackServerContext* context, const v1::RunProgramRequest* request) {
    auto* reply = new ProgramReplyStream(*context, slots_, patience_);
    absl::Status status = wire::admit(security_, *context);
    if (status.ok())
        status = startProgram(*request, deadlineOf(*context), *reply);
    if (!status.ok())
        reply->fail(status);
    return reply;
}

grpc::ServerReadReactor<v1::PutFrameRequest>* RenderService::PutFrame(
    grpc::CallbackServerContext* context, v1::PutFrameResponse* /*response*/) {
    if (const absl::Status status = wire::admit(security_, *context); !status.ok())
        return new RefusedFrame(status);
    return new FrameReceiver(exchange_.mailbox(), *context);
}

grpc::ServerUnaryReactor* RenderService::Pick(grpc::CallbackServerContext* context,
                                              const v1::PickRequest* request,
                                              v1::PickResponse* response) {
    grpc::ServerUnaryReactor* reactor = context->DefaultReactor();
    const absl::StatusOr<fabric::PickRequest> asked = wire::fromMessage(*request);
    absl::Status status = wire::admit(security_, *context);
    if (status.ok())
        status = asked.status();
    if (!status.ok()) {
        reactor->Finish(wire::toGrpc(status));
        return reactor;
    }
    picks_.pick(*asked, deadlineOf(*context),
                [response, reactor](const absl::StatusOr<fabric::Picked>& picked) {
                    if (picked.ok() && picked->has_value())
                        *response->mutable_point() = wire::toMessage(**picked);
                    reactor->Finish(wire::toGrpc(picked.status()));
                });
    return reactor;
}

absl::Status RenderService::startDrawing(const v1::RenderChannelRequest& request,
                                         ChannelReplyStream& reply) {
    const auto received = ChannelStory::Clock::now();
    RETURN_IF_ERROR(slots_.check());
    ASSIGN_OR_RETURN(const fabric::ChannelTask task, wire::fromMessage(request.task()));
    if (request.has_frame_data()) {
        ASSIGN_OR_RETURN(const fabric::FrameData sent, wire::fromMessage(request.frame_data()));
        frameData_.store(sent);
    }
    ASSIGN_OR_RETURN(const fabric::FrameData frameData, frameData_.find(task.frameDataVersion));
    ASSIGN_OR_RETURN(const wire::PixelEncoding encoding, wire::fromMessage(request.encoding()));
    Asked asked{frameData, task, encoding, {}, received};
    if (request.has_memory())
        asked.memory = wire::fromMessage(request.memory());
    return thread_.post([this, asked = std::move(asked), &reply](ChannelDrawer& drawer) {
        draw(drawer, asked, memories_, background_, reply);
    });
}

absl::Status RenderService::startProgram(const v1::RunProgramRequest& request,
                                         Exchange::Clock::time_point deadline,
                                         ProgramReplyStream& reply) {
    RETURN_IF_ERROR(slots_.check());
    ASSIGN_OR_RETURN(fabric::ChannelProgram program, wire::fromMessage(request.program()));
    ASSIGN_OR_RETURN(const wire::PixelEncoding encoding, wire::fromMessage(request.encoding()));
    return exchange_.start(std::move(program), deadline, reply.cancellation(),
                           [encoding, &reply](absl::StatusOr<ProgramAnswer> answer) {
                               if (answer.ok())
                                   reply.send(programReply(*std::move(answer), encoding));
                               else
                                   reply.fail(answer.status());
                           });
}

}  // namespace eyrie::service
