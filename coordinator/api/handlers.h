// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <stop_token>
#include <string>
#include <string_view>
#include <utility>

#include <absl/status/statusor.h>
#include <google/protobuf/message.h>

#include "access/rare_warnings.h"
#include "access/tokens.h"
#include "coordinator/api/message_stream.h"
#include "coordinator/api/quotas.h"

namespace eyrie::api {

/// What a call comes with beside its message.
struct Call {
    std::stop_token stop = {};               ///< the caller has gone
    access::Role role = access::Role::View;  ///< of who calls
    bool asText = false;  ///< the answer's bytes become text, which takes several times as much
    /// Where a handler leaves what its answer takes up of what there is for all, to be given back
    /// when the answer has been sent. Null: it ends with the call.
    std::shared_ptr<void>* room = nullptr;

    void keep(std::shared_ptr<void> share) const {
        if (room != nullptr)
            *room = std::move(share);
    }
    /// What an answer of that size takes up.
    std::int64_t taking(std::int64_t size) const { return asText ? 4 * size : size; }
};

/// What the calls of CoordinatorService do, by their names; the doors, gRPC and REST, have nothing
/// of their own but how messages come and go. Filled once, then called from any thread.
class Handlers {
public:
    using Message = google::protobuf::Message;

    /// `quotas` outlives the handlers; `telemetry` counts what fails.
    Handlers(QuotaKeeper& quotas, observe::SharedTelemetry telemetry)
        : quotas_(quotas), telemetry_(std::move(telemetry)) {}

    /// Before a call from an address, an IP address without a port, is made. ResourceExhausted: it
    /// makes too many.
    absl::Status admit(std::string_view address) const { return quotas_.admit(address); }

    /// `request` and `response` are those of the call.
    using Handler =
        std::function<absl::Status(const Message& request, Message& response, const Call& call)>;

    /// `handler` makes a Response from a Request and a Call.
    template <typename Request, typename Response, typename Function>
    void add(std::string name, Function handler) {
        table_[std::move(name)] = [handler = std::move(handler)](
                                      const Message& request, Message& response, const Call& call) {
            absl::StatusOr<Response> made = handler(static_cast<const Request&>(request), call);
            if (made.ok())
                static_cast<Response&>(response) = *std::move(made);
            return made.status();
        };
    }

    /// `handler` makes a MessageStream from a Request.
    template <typename Request, typename Function>
    void addStream(std::string name, Function handler) {
        streams_[std::move(name)] = [handler = std::move(handler)](const Message& request) {
            return handler(static_cast<const Request&>(request));
        };
    }

    /// The answer of a call that goes on. Does not block. Errors: Unimplemented, and the handler's.
    absl::StatusOr<std::unique_ptr<MessageStream>> open(std::string_view name,
                                                        const Message& request) const;

    /// Unimplemented: there is no such call here. Cancelled: the caller has gone. What a handler
    /// throws, for want of memory, is ResourceExhausted.
    absl::Status handle(std::string_view name, const Message& request, Message& response,
                        const Call& call) const;

    /// For doors to say how a call that somebody made has ended. An error is counted, and where the
    /// fault is this server's (its folder has gone, its disk is full) told to the log, of each call
    /// and kind once a minute.
    void note(std::string_view name, const absl::Status& status) const;

private:
    using Opener =
        std::function<absl::StatusOr<std::unique_ptr<MessageStream>>(const Message& request)>;

    QuotaKeeper& quotas_;
    const observe::SharedTelemetry telemetry_;
    mutable access::RareWarnings told_;
    std::map<std::string, Handler, std::less<>> table_;
    std::map<std::string, Opener, std::less<>> streams_;
};

}  // namespace eyrie::api
