// SPDX-License-Identifier: Apache-2.0
#include "service/registration.h"

#include <algorithm>
#include <condition_variable>
#include <cstdint>
#include <limits>
#include <mutex>
#include <string_view>
#include <thread>
#include <utility>

#include <fmt/format.h>
#include <grpcpp/client_context.h>
#include <grpcpp/create_channel.h>
#include <grpcpp/security/credentials.h>

#include "access/failed_handshakes.h"
#include "eyrie/v1/registry_service.grpc.pb.h"
#include "fabric/log.h"
#include "fabric/version.h"
#include "service/rejoin_pause.h"
#include "wire/deadline.h"
#include "wire/protocol.h"
#include "wire/statistics.h"
#include "wire/status.h"
#include "wire/transport.h"

namespace eyrie::service {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds kCallTimeout{3000};
constexpr std::chrono::milliseconds kDrainCallTimeout{1000};
constexpr std::chrono::milliseconds kDrainInterval{20};

/// What waiting does not mend.
bool isRefusal(const absl::Status& status) {
    switch (status.code()) {
        case absl::StatusCode::kInvalidArgument:
        case absl::StatusCode::kFailedPrecondition:
        case absl::StatusCode::kPermissionDenied:
        case absl::StatusCode::kUnauthenticated:
        case absl::StatusCode::kUnimplemented:
            return true;
        default:
            return false;
    }
}

void sleepFor(std::chrono::milliseconds time, const std::stop_token& stop) {
    std::mutex mutex;
    std::condition_variable_any wake;
    std::unique_lock lock(mutex);
    wake.wait_for(lock, stop, time, [] { return false; });
}

v1::PeersRefused since(const access::Refusals& before, const access::Refusals& now) {
    const auto more = [](std::uint64_t from, std::uint64_t to) {
        return static_cast<std::uint32_t>(
            std::min<std::uint64_t>(to - from, std::numeric_limits<std::uint32_t>::max()));
    };
    v1::PeersRefused refused;
    refused.set_no_token(more(before.missing, now.missing));
    refused.set_wrong_token(more(before.wrong - before.limited, now.wrong - now.limited));
    refused.set_too_many_wrong(more(before.limited, now.limited));
    refused.set_forbidden(more(before.forbidden, now.forbidden));
    refused.set_handshake(more(before.handshakes, now.handshakes));
    return refused;
}

class Registration {
public:
    explicit Registration(const RegistrationOptions& options)
        : options_(options),
          peer_(fmt::format("coordinator {}", options.coordinator)),
          stub_(v1::RegistryService::NewStub(grpc::CreateCustomChannel(
              options.coordinator, wire::channelCredentials(options.security, options.coordinator),
              wire::clientArguments(options.security)))) {}

    absl::Status run(const std::stop_token& stop) {
        while (!stop.stop_requested()) {
            absl::Status status = isRegistered() ? sendHeartbeat(stop) : sendRegistration();
            if (isRegistered() && absl::IsNotFound(status)) {
                spdlog::info("the {} does not know this renderer any more: registering again",
                             peer_);
                id_.clear();
                sleepFor(rejoin_.after(Clock::now() - registeredAt_), stop);
                notePresence();  // it has answered
                continue;
            }
            if (!status.ok() && !stop.stop_requested()) {
                if (isRefusal(status))
                    return status;
                status = noteAbsence(status);
                if (!status.ok())
                    return status;
            } else {
                notePresence();
            }
            sleepFor(away_ ? options_.retryInterval : heartbeat_, stop);
        }
        drain();
        return absl::OkStatus();
    }

private:
    bool isRegistered() const { return !id_.empty(); }

    template <typename Request, typename Response>
    absl::Status call(grpc::Status (v1::RegistryService::Stub::*method)(grpc::ClientContext*,
                                                                        const Request&, Response*),
                      const Request& request, Response& response, const std::stop_token& stop,
                      std::chrono::milliseconds timeout = kCallTimeout) {
        grpc::ClientContext context;
        wire::present(options_.security, context);
        context.set_deadline(wire::deadlineIn(timeout));
        const std::stop_callback cancel(stop, [&context] { context.TryCancel(); });
        return wire::fromGrpc(((*stub_).*method)(&context, request, &response), peer_);
    }

    /// Not ended by a stop: the coordinator would keep a renderer that does not know its id, and
    /// so cannot leave.
    absl::Status sendRegistration() {
        v1::RegisterRendererRequest request;
        request.set_address(options_.address);
        *request.mutable_device() = wire::toMessage(options_.device);
        request.set_node(options_.node);
        request.set_software_version(std::string(fabric::kVersion));
        request.set_protocol_checksum(wire::protocolChecksum());
        v1::RegisterRendererResponse response;
        const absl::Status status =
            call(&v1::RegistryService::Stub::RegisterRenderer, request, response, {});
        if (status.ok()) {
            id_ = response.renderer_id();
            registeredAt_ = Clock::now();
            heartbeat_ = std::chrono::milliseconds(
                std::clamp(response.heartbeat_milliseconds(), 10, 60'000));
            spdlog::info("registered with the {} as {}", peer_, id_);
        }
        return status;
    }

    absl::Status sendHeartbeat(const std::stop_token& stop) {
        v1::HeartbeatRequest request;
        request.set_renderer_id(id_);
        const access::Refusals now = turnedAway();
        *request.mutable_refused() = since(told_, now);
        v1::HeartbeatResponse response;
        absl::Status status = call(&v1::RegistryService::Stub::Heartbeat, request, response, stop);
        if (status.ok())
            told_ = now;
        return status;
    }

    /// At this process's own port, so far.
    access::Refusals turnedAway() const {
        access::Refusals refusals;
        if (options_.security.gate != nullptr)
            refusals = options_.security.gate->refusals(access::Door::Grpc);
        refusals.handshakes = access::FailedHandshakes::atGrpcPorts().soFar();
        return refusals;
    }

    /// Until the coordinator has forgotten it, which is when nothing is left to do for it.
    void drain() {
        const Clock::time_point limit = Clock::now() + options_.drainTime;
        v1::DrainRequest request;
        request.set_renderer_id(id_);
        v1::DrainResponse response;
        while (isRegistered() && Clock::now() < limit) {
            if (!call(&v1::RegistryService::Stub::Drain, request, response, {}, kDrainCallTimeout)
                     .ok())
                return;
            std::this_thread::sleep_for(kDrainInterval);
        }
    }

    void notePresence() {
        lastSeen_ = Clock::now();
        if (std::exchange(away_, false))
            spdlog::info("the {} answers again", peer_);
    }

    absl::Status noteAbsence(const absl::Status& status) {
        if (!std::exchange(away_, true))
            spdlog::warn("{}; trying again every {} ms",
                         std::string_view(status.message().data(), status.message().size()),
                         options_.retryInterval.count());
        if (options_.giveUpAfter && Clock::now() - lastSeen_ > *options_.giveUpAfter)
            return absl::UnavailableError(
                fmt::format("the {} has not answered for {} ms; is it running, and is that its "
                            "gRPC address?",
                            peer_, options_.giveUpAfter->count()));
        return absl::OkStatus();
    }

    const RegistrationOptions& options_;
    const std::string peer_;
    const std::unique_ptr<v1::RegistryService::Stub> stub_;
    std::string id_;
    std::chrono::milliseconds heartbeat_{1000};
    RejoinPause rejoin_;
    Clock::time_point registeredAt_{};
    Clock::time_point lastSeen_ = Clock::now();
    bool away_ = false;
    access::Refusals told_ = {};  ///< to the coordinator
};

}  // namespace

absl::Status keepRegistered(const RegistrationOptions& options, const std::stop_token& stop) {
    return Registration(options).run(stop);
}

}  // namespace eyrie::service
