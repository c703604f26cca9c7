// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "eyrie/v1/render_service.grpc.pb.h"
#include "service/exchange.h"
#include "service/frame_data_history.h"
#include "service/gl_thread.h"
#include "service/pick_thread.h"
#include "service/picture_memories.h"
#include "service/reply_stream.h"

namespace eyrie::service {

/// The RPCs of render_service.proto: each becomes a value and a job for the GL thread, or, to pick
/// and to run programs, for threads of their own.
class RenderService final : public v1::RenderService::CallbackService {
public:
    /// `thread` outlives the service. `patience`: wire::AnswerLimit's.
    explicit RenderService(GlThread& thread, const wire::Security& security = {},
                           std::chrono::milliseconds patience = wire::AnswerLimit::kPatience)
        : thread_(thread),
          security_(security),
          patience_(patience),
          exchange_(thread, frameData_, security) {}

    grpc::ServerUnaryReactor* OpenScene(grpc::CallbackServerContext* context,
                                        const v1::OpenSceneRequest* request,
                                        v1::OpenSceneResponse* response) override;
    grpc::ServerUnaryReactor* SetFrameData(grpc::CallbackServerContext* context,
                                           const v1::SetFrameDataRequest* request,
                                           v1::SetFrameDataResponse* response) override;
    grpc::ServerWriteReactor<v1::RenderChannelResponse>* RenderChannel(
        grpc::CallbackServerContext* context, const v1::RenderChannelRequest* request) override;
    grpc::ServerWriteReactor<v1::RunProgramResponse>* RunProgram(
        grpc::CallbackServerContext* context, const v1::RunProgramRequest* request) override;
    grpc::ServerReadReactor<v1::PutFrameRequest>* PutFrame(grpc::CallbackServerContext* context,
                                                           v1::PutFrameResponse* response) override;
    grpc::ServerUnaryReactor* Pick(grpc::CallbackServerContext* context,
                                   const v1::PickRequest* request,
                                   v1::PickResponse* response) override;

private:
    using ChannelReplyStream = ReplyStream<v1::RenderChannelResponse>;
    using ProgramReplyStream = ReplyStream<v1::RunProgramResponse>;

    absl::Status startDrawing(const v1::RenderChannelRequest& request, ChannelReplyStream& reply);
    absl::Status startProgram(const v1::RunProgramRequest& request,
                              Exchange::Clock::time_point deadline, ProgramReplyStream& reply);

    GlThread& thread_;
    const wire::Security security_;
    const std::chrono::milliseconds patience_;
    PickThread picks_;
    PictureMemories memories_;  ///< the GL thread's
    fabric::Rgba background_;   ///< of the scene that is open; the GL thread's
    FrameDataHistory frameData_;
    Exchange exchange_;
    ReplySlots slots_;
};

}  // namespace eyrie::service
