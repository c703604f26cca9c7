// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <map>
#include <stop_token>
#include <string>
#include <string_view>

#include <absl/status/statusor.h>
#include <google/protobuf/message.h>

namespace eyrie::api {

/// What a call comes with beside its message.
struct Call {
    std::stop_token stop = {};  ///< the caller has gone
};

/// What the calls of CoordinatorService do, by their names; the doors, gRPC and REST, have nothing
/// of their own but how messages come and go. Filled once, then called from any thread.
class Handlers {
public:
    using Message = google::protobuf::Message;
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

    /// Unimplemented: there is no such call here. Cancelled: the caller has gone. What a handler
    /// throws, for want of memory, is ResourceExhausted.
    absl::Status handle(std::string_view name, const Message& request, Message& response,
                        const Call& call) const;

private:
    std::map<std::string, Handler, std::less<>> table_;
};

}  // namespace eyrie::api
