// SPDX-License-Identifier: Apache-2.0
#include "coordinator/api/grpc_service.h"

#include <mutex>
#include <random>
#include <utility>

#include <fmt/format.h>
#include <grpcpp/ext/health_check_service_server_builder_option.h>
#include <grpcpp/ext/proto_server_reflection_plugin.h>
#include <grpcpp/health_check_service_interface.h>
#include <grpcpp/server.h>

#include "coordinator/api/coordinator_service.h"
#include "coordinator/api/quotas.h"
#include "coordinator/api/reachable_address.h"
#include "coordinator/farm/grpc_renderer.h"
#include "coordinator/stream/viewer_messages.h"
#include "eyrie/v1/registry_service.grpc.pb.h"
#include "fabric/log.h"
#include "fabric/status.h"
#include "fabric/version.h"
#include "wire/deadline.h"
#include "wire/listen.h"
#include "wire/protocol.h"
#include "wire/statistics.h"
#include "wire/status.h"

namespace eyrie::coordinator {
namespace {

constexpr std::size_t kMaxNodeBytes = 256;

/// "0.1" of "0.1.9".
std::string_view withoutPatch(std::string_view version) {
    return version.substr(0, version.rfind('.'));
}

/// Patches of one version work together, so that machines can be brought up to date one by one.
absl::Status checkVersion(const v1::RegisterRendererRequest& request) {
    const std::string version = stream::sanitised(request.software_version().substr(0, 64));
    if (withoutPatch(version) != withoutPatch(fabric::kVersion))
        return absl::FailedPreconditionError(
            fmt::format("software_version is '{}', the coordinator's is '{}'; install an Eyrie {} "
                        "on both",
                        version, fabric::kVersion, withoutPatch(fabric::kVersion)));
    if (request.protocol_checksum() != wire::protocolChecksum())
        return absl::FailedPreconditionError(fmt::format(
            "protocol_checksum is {:016x} in version '{}', the coordinator's is {:016x} in version "
            "{}: one says or draws what the other does not; install the same build of Eyrie on "
            "both",
            request.protocol_checksum(), version, wire::protocolChecksum(), fabric::kVersion));
    return absl::OkStatus();
}

access::Refusals refusalsOf(const v1::PeersRefused& refused) {
    access::Refusals refusals;
    refusals.missing = refused.no_token();
    refusals.limited = refused.too_many_wrong();
    refusals.wrong = refusals.limited + refused.wrong_token();
    refusals.forbidden = refused.forbidden();
    refusals.handshakes = refused.handshake();
    return refusals;
}

class RegistryService final : public v1::RegistryService::CallbackService {
public:
    RegistryService(Registry& registry, const GrpcOptions& options)
        : registry_(registry), security_(options.security), telemetry_(options.telemetry) {}

    grpc::ServerUnaryReactor* RegisterRenderer(grpc::CallbackServerContext* context,
                                               const v1::RegisterRendererRequest* request,
                                               v1::RegisterRendererResponse* response) override {
        grpc::ServerUnaryReactor* reactor = context->DefaultReactor();
        absl::Status status = wire::admit(security_, *context);
        if (status.ok())
            status = add(*request, context->peer(), *response);
        reactor->Finish(wire::toGrpc(status));
        return reactor;
    }

    grpc::ServerUnaryReactor* Heartbeat(grpc::CallbackServerContext* context,
                                        const v1::HeartbeatRequest* request,
                                        v1::HeartbeatResponse* /*response*/) override {
        grpc::ServerUnaryReactor* reactor = context->DefaultReactor();
        absl::Status status = wire::admit(security_, *context);
        if (status.ok())
            status = heartbeat(request->renderer_id());
        if (status.ok() && telemetry_)
            telemetry_->metrics.turnedAwayByRenderer(refusalsOf(request->refused()));
        reactor->Finish(wire::toGrpc(status));
        return reactor;
    }

    grpc::ServerUnaryReactor* Drain(grpc::CallbackServerContext* context,
                                    const v1::DrainRequest* request,
                                    v1::DrainResponse* /*response*/) override {
        grpc::ServerUnaryReactor* reactor = context->DefaultReactor();
        absl::Status status = wire::admit(security_, *context);
        if (status.ok())
            status = drain(request->renderer_id());
        reactor->Finish(wire::toGrpc(status));
        return reactor;
    }

private:
    absl::Status add(const v1::RegisterRendererRequest& request, const std::string& peer,
                     v1::RegisterRendererResponse& response) {
        const std::string address = reachableAddress(request.address(), peer);
        RETURN_IF_ERROR(wire::checkAddress(address));
        ASSIGN_OR_RETURN(const fabric::DeviceInfo device, wire::fromMessage(request.device()));
        if (absl::Status status = checkVersion(request); !status.ok()) {
            registry_.refuse(address, device, {status.message().data(), status.message().size()},
                             Registry::Clock::now());
            return status;
        }
        if (request.node().size() > kMaxNodeBytes)
            return absl::InvalidArgumentError(
                fmt::format("node has {} bytes; it may have {}: shorten --node",
                            request.node().size(), kMaxNodeBytes));
        ASSIGN_OR_RETURN(
            const std::string id,
            registry_.add(address, device, connectRenderer(address, security_, telemetry_),
                          Registry::Clock::now(), request.node()));
        if (request.software_version() != fabric::kVersion)
            spdlog::info("{} is of version {}, the coordinator of {}: they work together", id,
                         stream::sanitised(request.software_version().substr(0, 64)),
                         fabric::kVersion);
        response.set_renderer_id(id + run_);
        response.set_heartbeat_milliseconds(
            static_cast<std::int32_t>(registry_.options().heartbeatInterval.count()));
        return absl::OkStatus();
    }

    absl::Status heartbeat(const std::string& rendererId) {
        ASSIGN_OR_RETURN(const std::string id, registeredId(rendererId));
        return registry_.heartbeat(id, Registry::Clock::now());
    }

    absl::Status drain(const std::string& rendererId) {
        ASSIGN_OR_RETURN(const std::string id, registeredId(rendererId));
        return registry_.drain(id, Registry::Clock::now());
    }

    /// The registry's; NotFound when an earlier run gave `rendererId` out.
    absl::StatusOr<std::string> registeredId(const std::string& rendererId) const {
        const std::string id = rendererId.substr(0, 64);
        if (!id.ends_with(run_))
            return absl::NotFoundError(
                fmt::format("'{}' is of another run of the coordinator; register again", id));
        return id.substr(0, id.size() - run_.size());
    }

    Registry& registry_;
    const wire::Security security_;
    const observe::SharedTelemetry telemetry_;
    /// Ends the ids that renderers are given: the registry's begin anew with each process.
    const std::string run_ = fmt::format("@{:08x}", std::random_device()());
};

}  // namespace

class GrpcService::Impl {
public:
    Impl(Registry& registry, const GrpcOptions& options)
        : service_(registry, options), calls_(options.security), security_(options.security) {}

    absl::Status listen(const std::vector<std::string>& addresses, bool withReflection) {
        if (withReflection)
            grpc::reflection::InitProtoReflectionServerBuilderPlugin();
        grpc::EnableDefaultHealthCheckService(true);
        ASSIGN_OR_RETURN(listening_, wire::listen(addresses, {&service_, &calls_}, security_,
                                                  api::Quotas::kMostAnswerBytes, withReflection));
        return absl::OkStatus();
    }

    const std::vector<std::string>& addresses() const { return listening_.addresses; }

    void use(const api::Handlers& handlers) { calls_.use(handlers); }

    void drain() {
        std::call_once(drained_, [this] {
            calls_.drain();
            listening_.server->GetHealthCheckService()->SetServingStatus(false);
            deadline_ = wire::deadlineIn(kDrainTimeout);
        });
    }

    void stop() {
        drain();
        const std::lock_guard lock(stopMutex_);
        listening_.server->Shutdown(deadline_);
        calls_.stop();
    }

private:
    RegistryService service_;
    api::CoordinatorService calls_;
    const wire::Security security_;
    wire::Listening listening_;
    std::mutex stopMutex_;
    std::once_flag drained_;
    gpr_timespec deadline_{};  ///< of calls in progress; from drain() on
};

absl::StatusOr<std::unique_ptr<GrpcService>> GrpcService::start(
    const std::vector<std::string>& addresses, Registry& registry, const GrpcOptions& options) {
    auto impl = std::make_unique<Impl>(registry, options);
    RETURN_IF_ERROR(impl->listen(addresses, options.withReflection));
    return std::unique_ptr<GrpcService>(new GrpcService(std::move(impl)));
}

GrpcService::GrpcService(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
GrpcService::~GrpcService() { stop(); }

const std::vector<std::string>& GrpcService::addresses() const { return impl_->addresses(); }
void GrpcService::use(const api::Handlers& handlers) { impl_->use(handlers); }
void GrpcService::drain() { impl_->drain(); }
void GrpcService::stop() { impl_->stop(); }

}  // namespace eyrie::coordinator
