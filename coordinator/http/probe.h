// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <string>

#include <absl/status/status.h>

namespace eyrie::http {

/// What is asked whether it serves.
struct Probed {
    bool isEncrypted = false;  ///< https
    std::string host;
    std::uint16_t port = 0;
    std::string path = "/healthz";
};

/// Which certificates are believed, where a server shows one.
struct Trust {
    std::string authority = {};  ///< PEM file; empty: the system's authorities
    std::string name = {};       ///< that they are to be for; empty: the host that is asked
};

/// GET of what is probed: OK when that is answered with a status of 200 to 299 within `limit`.
/// Errors: Unavailable (nobody there, or what is there does not speak HTTP), DeadlineExceeded,
/// FailedPrecondition (another status, which the message has; no TLS where it is to be, or a
/// certificate that is not believed), InvalidArgument (`trust`).
absl::Status probe(const Probed& probed, std::chrono::milliseconds limit, const Trust& trust = {});

}  // namespace eyrie::http
