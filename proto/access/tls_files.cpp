// SPDX-License-Identifier: Apache-2.0
#include "access/tls_files.h"

#include <cerrno>
#include <memory>
#include <system_error>

#include <fmt/format.h>
#include <openssl/ssl.h>
#include <openssl/x509.h>
#include <sys/stat.h>
#include <unistd.h>

#include "fabric/status.h"

namespace eyrie::access {
namespace {

absl::Status checkReadable(const std::string& file, bool isSecret) {
    struct stat facts {};
    if (::stat(file.c_str(), &facts) != 0 || ::access(file.c_str(), R_OK) != 0) {
        const std::string text =
            fmt::format("{}: {}", file, std::generic_category().message(errno));
        return errno == ENOENT ? absl::NotFoundError(text) : absl::PermissionDeniedError(text);
    }
    if (!S_ISREG(facts.st_mode))
        return absl::InvalidArgumentError(fmt::format("{}: not a file", file));
    if (isSecret && (facts.st_mode & S_IRWXO) != 0)
        return absl::PermissionDeniedError(
            fmt::format("{}: everybody can read this key; chmod 600 it", file));
    return absl::OkStatus();
}

absl::Status checkDates(SSL_CTX* context, const std::string& file) {
    const X509* certificate = SSL_CTX_get0_certificate(context);
    if (X509_cmp_current_time(X509_get0_notAfter(certificate)) < 0)
        return absl::InvalidArgumentError(fmt::format("{}: the certificate has expired", file));
    if (X509_cmp_current_time(X509_get0_notBefore(certificate)) > 0)
        return absl::InvalidArgumentError(
            fmt::format("{}: the certificate is not valid yet; is the clock right?", file));
    return absl::OkStatus();
}

absl::Status checkOwn(SSL_CTX* context, const TlsFiles& files) {
    if (SSL_CTX_use_certificate_chain_file(context, files.certificate.c_str()) != 1)
        return absl::InvalidArgumentError(
            fmt::format("{}: no certificate in PEM form", files.certificate));
    if (SSL_CTX_use_PrivateKey_file(context, files.key.c_str(), SSL_FILETYPE_PEM) != 1)
        return absl::InvalidArgumentError(
            fmt::format("{}: no private key in PEM form that goes with the certificate in {}",
                        files.key, files.certificate));
    return checkDates(context, files.certificate);
}

}  // namespace

absl::Status checkTlsFiles(const TlsFiles& files) {
    if (!files.certificate.empty()) {
        RETURN_IF_ERROR(checkReadable(files.certificate, false));
        RETURN_IF_ERROR(checkReadable(files.key, true));
    }
    if (!files.authority.empty())
        RETURN_IF_ERROR(checkReadable(files.authority, false));
    const std::unique_ptr<SSL_CTX, void (*)(SSL_CTX*)> context(SSL_CTX_new(TLS_method()),
                                                               SSL_CTX_free);
    if (!files.authority.empty() &&
        SSL_CTX_load_verify_locations(context.get(), files.authority.c_str(), nullptr) != 1)
        return absl::InvalidArgumentError(
            fmt::format("{}: no certificates in PEM form", files.authority));
    return files.certificate.empty() ? absl::OkStatus() : checkOwn(context.get(), files);
}

}  // namespace eyrie::access
