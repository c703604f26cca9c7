// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "access/tokens.h"

namespace google::protobuf {
class Message;
}

namespace eyrie::api {

class Handlers;
class MessageStream;
struct FoundRoute;

struct RestRequest {
    std::string method = {};
    std::string target = {};  ///< path and query, as sent; the path begins with /api
    std::string body = {};
    std::string contentType = {};
    std::string accept = {};
    std::string ifNoneMatch = {};
    std::string ifMatch = {};
    std::string idempotencyKey = {};         ///< the same as the request's field request_id
    std::stop_token stop = {};               ///< the client has gone
    access::Role role = access::Role::View;  ///< of who asks
};

struct RestAnswer {
    int status = 200;
    std::string contentType = "application/json";
    std::vector<std::pair<std::string, std::string>> headers = {};
    /// With it goes what the answer takes up of what there is for all (Call::room).
    std::shared_ptr<const std::string> body = std::make_shared<const std::string>();
    /// Not null: the answer goes on, with an eventOf() for each message.
    std::shared_ptr<MessageStream> events = {};
};

/// CoordinatorService over HTTP, without the network: the calls that gRPC makes, by method and path
/// as rest.proto says, in protobuf JSON. Errors are application/problem+json. Answers to GET have
/// an ETag, those to PUT and PATCH the one that GET has now, and If-Match holds changes to it: 412
/// where somebody else has made one by HTTP meanwhile. Any thread may call; calls take as long as
/// what they ask for.
class RestDoor {
public:
    /// `handlers` outlive the door.
    explicit RestDoor(const Handlers& handlers) : handlers_(handlers) {}

    RestAnswer answer(const RestRequest& request) const;

    /// To be asked before answer(), and quick: the answer to who makes too many calls from
    /// `address`, an IP address without a port; nothing: it is to be answered.
    std::optional<RestAnswer> refusal(std::string_view address) const;

private:
    /// What a call has made, and how it ended.
    struct Made {
        absl::Status status;
        RestAnswer answer;
    };
    Made make(const RestRequest& request, const FoundRoute& found) const;
    RestAnswer call(const RestRequest& request, const FoundRoute& found) const;
    RestAnswer change(const RestRequest& request, const FoundRoute& found) const;
    RestAnswer stream(const RestRequest& request, const FoundRoute& found,
                      google::protobuf::Message& asked) const;
    Made there(const RestRequest& change) const;

    const Handlers& handlers_;
    /// Held while what is at a path is looked at and changed; paths share them.
    mutable std::array<std::mutex, 16> changing_;
};

/// The answer to a request that is not taken at all.
RestAnswer busyAnswer();

/// A message as a server-sent event: "data: {…}" and an empty line.
std::string eventOf(const google::protobuf::Message& message);

}  // namespace eyrie::api
