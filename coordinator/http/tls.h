// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <chrono>
#include <filesystem>
#include <memory>

#include <absl/status/statusor.h>
#include <boost/asio/ssl/context.hpp>

#include "access/tls_files.h"

namespace eyrie::http {

/// What new connections are encrypted with. When the files change, connections from then on have
/// the new certificate, and those that are open keep the old one. Files that cannot be used, as
/// while they are being replaced, change nothing. Used on the server's thread only.
class Tls {
public:
    /// Errors: those of checkTlsFiles. The authority is not used: browsers show themselves by
    /// tokens.
    static absl::StatusOr<std::unique_ptr<Tls>> open(const access::TlsFiles& files);

    /// Looks at the files at most once a second.
    boost::asio::ssl::context& current();

private:
    using Clock = std::chrono::steady_clock;
    using Stamps = std::array<std::filesystem::file_time_type, 2>;

    explicit Tls(access::TlsFiles files) : files_(std::move(files)) {}
    absl::Status load();
    Stamps stamps() const;

    const access::TlsFiles files_;
    std::unique_ptr<boost::asio::ssl::context> context_;
    Stamps loaded_{};
    Clock::time_point lookAgain_{};
};

}  // namespace eyrie::http
