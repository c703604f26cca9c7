// SPDX-License-Identifier: Apache-2.0
#include "coordinator/http/tls.h"

#include <string_view>
#include <system_error>
#include <utility>

#include <fmt/format.h>
#include <openssl/ssl.h>

#include "fabric/log.h"
#include "fabric/status.h"

namespace eyrie::http {
namespace {

namespace ssl = boost::asio::ssl;

constexpr std::chrono::seconds kLookInterval{1};

}  // namespace

absl::StatusOr<std::unique_ptr<Tls>> Tls::open(const access::TlsFiles& files) {
    std::unique_ptr<Tls> tls(new Tls(files));
    RETURN_IF_ERROR(tls->load());
    tls->lookAgain_ = Clock::now() + kLookInterval;
    return tls;
}

absl::Status Tls::load() {
    loaded_ = stamps();
    RETURN_IF_ERROR(access::checkTlsFiles(files_));
    auto context = std::make_unique<ssl::context>(ssl::context::tls_server);
    boost::system::error_code error;
    context->set_options(ssl::context::default_workarounds | ssl::context::no_tlsv1 |
                         ssl::context::no_tlsv1_1);
    SSL_CTX_set_options(context->native_handle(), SSL_OP_NO_RENEGOTIATION);
    context->use_certificate_chain_file(files_.certificate, error);
    if (!error)
        context->use_private_key_file(files_.key, ssl::context::pem, error);
    if (error)
        return absl::InvalidArgumentError(
            fmt::format("{}, {}: {}", files_.certificate, files_.key, error.message()));
    context_ = std::move(context);
    return absl::OkStatus();
}

ssl::context& Tls::current() {
    if (const Clock::time_point now = Clock::now(); now >= lookAgain_) {
        lookAgain_ = now + kLookInterval;
        if (stamps() != loaded_) {
            const absl::Status status = load();
            if (status.ok())
                spdlog::info("new connections have the certificate that is now in {}",
                             files_.certificate);
            else
                spdlog::warn("the certificate stays as it was: {}",
                             std::string_view(status.message().data(), status.message().size()));
        }
    }
    return *context_;
}

Tls::Stamps Tls::stamps() const {
    std::error_code ignored;
    return {std::filesystem::last_write_time(files_.certificate, ignored),
            std::filesystem::last_write_time(files_.key, ignored)};
}

}  // namespace eyrie::http
