// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <string>

#include <absl/status/status.h>

#include "wire/security.h"

namespace eyrie::wire {

/// Asks the standard gRPC health service at "host:port" or "unix:/path", as coordinators and
/// renderers have it, whether the process as a whole serves. Of `security` nothing but what TLS
/// needs is used: everybody may ask. Errors: InvalidArgument (an address of another form),
/// Unavailable (nobody there), DeadlineExceeded (no answer within `limit`), FailedPrecondition
/// (there, but not serving), and whatever the other side answers.
absl::Status checkHealth(const std::string& address, std::chrono::milliseconds limit,
                         const Security& security = {});

}  // namespace eyrie::wire
