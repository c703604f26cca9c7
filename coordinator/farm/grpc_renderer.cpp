// SPDX-License-Identifier: Apache-2.0
#include "coordinator/farm/grpc_renderer.h"

#include <atomic>
#include <functional>
#include <mutex>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <grpcpp/client_context.h>
#include <grpcpp/create_channel.h>
#include <grpcpp/security/credentials.h>

#include "coordinator/farm/channel_report.h"
#include "coordinator/farm/picture_assembly.h"
#include "coordinator/farm/picture_slots.h"
#include "coordinator/farm/program_assembly.h"
#include "eyrie/v1/render_service.grpc.pb.h"
#include "fabric/status.h"
#include "wire/channel_program.h"
#include "wire/deadline.h"
#include "wire/frame.h"
#include "wire/nearly_drawn.h"
#include "wire/pick.h"
#include "wire/picture_header.h"
#include "wire/scene.h"
#include "wire/scene_info.h"
#include "wire/status.h"
#include "wire/transport.h"

namespace eyrie::coordinator {
namespace {

/// The contexts of the calls in progress, so that another thread can end them.
class Calls {
public:
    /// One call, from its start to its end.
    class Call {
    public:
        Call(Calls& calls, ChannelRenderer::Clock::time_point deadline) : calls_(calls) {
            wire::present(calls.security_, context_);
            context_.set_deadline(wire::deadlineIn(deadline - ChannelRenderer::Clock::now()));
            const std::lock_guard lock(calls_.mutex_);
            calls_.current_.push_back(&context_);
            if (calls_.cancelled_)
                context_.TryCancel();
        }
        ~Call() {
            const std::lock_guard lock(calls_.mutex_);
            std::erase(calls_.current_, &context_);
        }
        Call(const Call&) = delete;
        Call& operator=(const Call&) = delete;

        grpc::ClientContext* context() { return &context_; }

    private:
        Calls& calls_;
        grpc::ClientContext context_;
    };

    explicit Calls(const wire::Security& security) : security_(security) {}

    void cancel() {
        const std::lock_guard lock(mutex_);
        cancelled_ = true;
        for (grpc::ClientContext* context : current_) context->TryCancel();
    }

private:
    const wire::Security security_;
    std::mutex mutex_;  ///< guards current_ and cancelled_
    std::vector<grpc::ClientContext*> current_;
    bool cancelled_ = false;
};

bool answersWithDepth(const fabric::ChannelProgram& program) {
    for (const fabric::ProgramStage& stage : program.stages)
        for (const fabric::ProgramOutput& output : stage.outputs)
            if (output.to.empty() && output.withDepth)
                return true;
    return false;
}

std::chrono::nanoseconds waitedBy(const v1::ChannelTimes& times) {
    const bool isBelievable = 0 <= times.received() && times.received() <= times.begun();
    return std::chrono::nanoseconds(isBelievable ? times.begun() - times.received() : 0);
}

class GrpcRenderer final : public ChannelRenderer {
public:
    GrpcRenderer(const std::string& address, const wire::Security& security,
                 observe::SharedTelemetry telemetry, bool offersMemory)
        : peer_(fmt::format("renderer at {}", address)),
          address_(address),
          channel_(grpc::CreateCustomChannel(address, wire::channelCredentials(security, address),
                                             wire::clientArguments(security))),
          stub_(v1::RenderService::NewStub(channel_)),
          calls_(security),
          offersMemory_(offersMemory),
          slots_(std::make_shared<PictureSlots>(peer_)),
          reported_(address, std::move(telemetry)) {}

    absl::StatusOr<fabric::SceneInfo> openScene(const fabric::Scene& scene,
                                                Clock::time_point deadline) override {
        v1::OpenSceneRequest request;
        *request.mutable_scene() = wire::toMessage(scene);
        request.set_address(address_);
        v1::OpenSceneResponse response;
        Calls::Call call(calls_, deadline);
        RETURN_IF_ERROR(
            wire::fromGrpc(stub_->OpenScene(call.context(), request, &response), peer_));
        absl::StatusOr<fabric::SceneInfo> info = wire::fromMessage(response);
        if (!info.ok())
            return absl::InternalError(fmt::format("{}: OpenScene answered {}", peer_,
                                                   std::string(info.status().message())));
        return info;
    }

    absl::Status setFrameData(const fabric::FrameData& frameData,
                              Clock::time_point deadline) override {
        v1::SetFrameDataRequest request;
        *request.mutable_frame_data() = wire::toMessage(frameData);
        v1::SetFrameDataResponse response;
        Calls::Call call(calls_, deadline);
        return wire::fromGrpc(stub_->SetFrameData(call.context(), request, &response), peer_);
    }

    /// Its header comes when the picture has been drawn; metadata may come when most of it has.
    absl::StatusOr<fabric::ChannelResult> render(const fabric::ChannelTask& task,
                                                 Clock::time_point deadline,
                                                 const ChannelNews& news,
                                                 const fabric::FrameData* frameData,
                                                 const std::stop_token& stop) override {
        v1::RenderChannelRequest request;
        *request.mutable_task() = wire::toMessage(task);
        if (frameData != nullptr)
            *request.mutable_frame_data() = wire::toMessage(*frameData);
        request.set_encoding(wire::toMessage(wire::encodingFor(address_, task.wantsDepth)));
        std::unique_ptr<wire::PictureMemory> memory;
        if (offersMemory_ && task.jpegQuality == 0)
            memory = slots_->lend(wire::pixelBytes(task.pixelViewport, task.wantsDepth));
        if (memory != nullptr)
            *request.mutable_memory() = wire::toMessage(memory->offer());
        Calls::Call call(calls_, deadline);
        const std::stop_callback cancel(stop, [&] { call.context()->TryCancel(); });
        ChannelReport report(reported_, task.frameNumber);
        const auto reader = stub_->RenderChannel(call.context(), request);
        bool isDrawn = !news.drawn;
        const auto noteDrawn = [&] {
            if (!std::exchange(isDrawn, true))
                news.drawn();
        };
        reader->WaitForInitialMetadata();
        if (call.context()->GetServerInitialMetadata().contains(wire::kNearlyDrawnKey))
            noteDrawn();
        PictureAssembly assembly(task, memory.get());
        auto result = receive(call, *reader, assembly, [&](const v1::RenderChannelResponse& part) {
            noteDrawn();
            if (part.has_header()) {
                report.headerCame(part.header());
                if (news.waited)
                    news.waited(waitedBy(part.header().times()));
                return assembly.takeHeader(part.header());
            }
            report.chunkCame(part.chunk().size());
            return assembly.takeChunk(part.chunk());
        });
        report.ended(result.status());
        if (result.ok() && memory != nullptr) {
            if (const auto picture = assembly.inMemory())
                result->lent.emplace(*picture, slots_->giveBackLater(std::move(memory)));
            else
                slots_->giveBack(std::move(memory), false);
        }
        return result;
    }

    absl::StatusOr<fabric::ProgramResult> runProgram(const fabric::ChannelProgram& program,
                                                     Clock::time_point deadline,
                                                     const std::stop_token& stop) override {
        v1::RunProgramRequest request;
        *request.mutable_program() = wire::toMessage(program);
        request.set_encoding(
            wire::toMessage(wire::encodingFor(address_, answersWithDepth(program))));
        Calls::Call call(calls_, deadline);
        const std::stop_callback cancel(stop, [&] { call.context()->TryCancel(); });
        ProgramReport report(reported_);
        const auto reader = stub_->RunProgram(call.context(), request);
        ProgramAssembly assembly(program);
        auto result = receive(call, *reader, assembly, [&](const v1::RunProgramResponse& part) {
            if (part.has_statistics()) {
                report.statisticsCame(part.statistics());
                return assembly.takeStatistics(part.statistics());
            }
            if (part.has_header()) {
                report.pictureCame();
                return assembly.takeHeader(part.header());
            }
            report.chunkCame(part.chunk().size());
            return assembly.takeChunk(part.chunk());
        });
        report.ended();
        return result;
    }

    absl::StatusOr<fabric::Picked> pick(const fabric::PickRequest& request,
                                        Clock::time_point deadline) override {
        const v1::PickRequest message = wire::toMessage(request);
        v1::PickResponse response;
        Calls::Call call(calls_, deadline);
        RETURN_IF_ERROR(wire::fromGrpc(stub_->Pick(call.context(), message, &response), peer_));
        if (!response.has_point())
            return fabric::Picked();
        const absl::StatusOr<fabric::PickedPoint> point = wire::fromMessage(response.point());
        if (!point.ok())
            return absl::InternalError(
                fmt::format("{}: Pick answered {}", peer_, std::string(point.status().message())));
        return fabric::Picked(*point);
    }

    bool hasLostConnection() override {
        const bool isConnected = channel_->GetState(false) == GRPC_CHANNEL_READY;
        if (isConnected)
            wasConnected_ = true;
        return wasConnected_ && !isConnected;
    }

    void cancel() override { calls_.cancel(); }

private:
    /// Reads a call to its end; what `take` says of a part ends it.
    template <typename Part, typename Assembly, typename Take>
    auto receive(Calls::Call& call, grpc::ClientReader<Part>& reader, Assembly& assembly,
                 Take&& take) const -> decltype(assembly.finish()) {
        Part part;
        absl::Status received;
        while (received.ok() && reader.Read(&part)) received = take(part);
        if (!received.ok())
            call.context()->TryCancel();  // or Finish would wait for the rest
        const absl::Status finished = wire::fromGrpc(reader.Finish(), peer_);
        if (!received.ok())
            return fabric::withContext(received, peer_);
        RETURN_IF_ERROR(finished);
        auto result = assembly.finish();
        if (!result.ok())
            return fabric::withContext(result.status(), peer_);
        return result;
    }

    const std::string peer_;
    const std::string address_;
    const std::shared_ptr<grpc::Channel> channel_;
    const std::unique_ptr<v1::RenderService::Stub> stub_;
    std::atomic<bool> wasConnected_{false};
    Calls calls_;
    const bool offersMemory_;
    const std::shared_ptr<PictureSlots> slots_;
    ReportedRenderer reported_;
};

}  // namespace

std::shared_ptr<ChannelRenderer> connectRenderer(const std::string& address,
                                                 const wire::Security& security,
                                                 observe::SharedTelemetry telemetry,
                                                 bool offersMemory) {
    return std::make_shared<GrpcRenderer>(address, security, std::move(telemetry), offersMemory);
}

}  // namespace eyrie::coordinator
