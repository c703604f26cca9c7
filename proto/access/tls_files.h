// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <absl/status/status.h>

namespace eyrie::access {

/// PEM files that a process shows itself with, and by which it knows others.
struct TlsFiles {
    std::string certificate;  ///< its own, with what leads to the authority's behind it; empty: a
                              ///< client that shows none
    std::string key;          ///< of that
    std::string authority;    ///< whose certificates others must have; empty: they need none

    bool operator==(const TlsFiles&) const = default;
};

/// Whether the files can be used now: gRPC would only fail to connect, without a word. Errors:
/// NotFound, PermissionDenied (a key that everybody can read), InvalidArgument (no certificate or
/// key, one that does not go with the other, or one that has expired); all name the file.
absl::Status checkTlsFiles(const TlsFiles& files);

}  // namespace eyrie::access
