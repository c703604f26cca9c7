// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <string>

#include <absl/status/status.h>

namespace eyrie::http {

/// GET http://host:port/path: OK when that is answered with a status of 200 to 299 within `limit`.
/// Errors: Unavailable (nobody there, or what is there does not speak HTTP), DeadlineExceeded,
/// FailedPrecondition (another status; the message has it).
absl::Status probe(const std::string& host, std::uint16_t port, const std::string& path,
                   std::chrono::milliseconds limit);

}  // namespace eyrie::http
