// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <stop_token>
#include <string>
#include <utility>
#include <vector>

namespace eyrie::api {

class Handlers;

struct RestRequest {
    std::string method = {};
    std::string target = {};  ///< path and query, as sent; the path begins with /api
    std::string body = {};
    std::string contentType = {};
    std::string accept = {};
    std::string ifNoneMatch = {};
    std::string idempotencyKey = {};  ///< the same as the request's field request_id
    std::stop_token stop = {};        ///< the client has gone
};

struct RestAnswer {
    int status = 200;
    std::string contentType = "application/json";
    std::vector<std::pair<std::string, std::string>> headers = {};
    std::shared_ptr<const std::string> body = std::make_shared<const std::string>();
};

/// CoordinatorService over HTTP, without the network: the calls that gRPC makes, by method and path
/// as rest.proto says, in protobuf JSON. Errors are application/problem+json. Answers to GET have
/// an ETag. Any thread may call; calls take as long as what they ask for.
class RestDoor {
public:
    /// `handlers` outlive the door.
    explicit RestDoor(const Handlers& handlers) : handlers_(handlers) {}

    RestAnswer answer(const RestRequest& request) const;

private:
    const Handlers& handlers_;
};

/// The answer to a request that is not taken at all.
RestAnswer busyAnswer();

}  // namespace eyrie::api
