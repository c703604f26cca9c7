// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <string>

#include <absl/status/statusor.h>

namespace eyrie::test {

struct HttpAnswer {
    int status = 0;
    std::string headers;  ///< as they came
    std::string body;
};

/// GET http://127.0.0.1:port/target, on a connection of its own. Blocks for `limit` at most.
/// Errors: Unavailable (nobody answers), DeadlineExceeded.
absl::StatusOr<HttpAnswer> httpGet(std::uint16_t port, const std::string& target,
                                   std::chrono::milliseconds limit = std::chrono::seconds(10));

/// The same with PATCH and a body of JSON.
absl::StatusOr<HttpAnswer> httpPatch(std::uint16_t port, const std::string& target,
                                     const std::string& json,
                                     std::chrono::milliseconds limit = std::chrono::seconds(10));

/// The same with POST.
absl::StatusOr<HttpAnswer> httpPost(std::uint16_t port, const std::string& target,
                                    const std::string& json,
                                    std::chrono::milliseconds limit = std::chrono::seconds(10));

/// The same with PUT.
absl::StatusOr<HttpAnswer> httpPut(std::uint16_t port, const std::string& target,
                                   const std::string& json,
                                   std::chrono::milliseconds limit = std::chrono::seconds(10));

}  // namespace eyrie::test
