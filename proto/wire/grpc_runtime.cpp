// SPDX-License-Identifier: Apache-2.0
#include "wire/grpc_runtime.h"

#include <memory>
#include <mutex>

#include <grpc/grpc.h>
#include <grpc/support/log.h>
#include <openssl/crypto.h>

#include "fabric/log.h"

namespace eyrie::wire {
namespace {

/// Before anything else of OpenSSL, which hears only the first who says whether it tidies up when
/// the process ends: threads of gRPC may still be shaking hands then.
[[maybe_unused]] const int kOpenSslStays = OPENSSL_init_crypto(OPENSSL_INIT_NO_ATEXIT, nullptr);

/// The log, never freed: those threads still write to it when what is static is destroyed.
spdlog::logger& lastingLog() {
    static const auto& log = *new std::shared_ptr<spdlog::logger>(spdlog::default_logger());
    return *log;
}

}  // namespace

void startGrpc() {
    static std::once_flag once;
    std::call_once(once, [] {
        lastingLog();  // while there is one
        gpr_set_log_function([](gpr_log_func_args* entry) {
            lastingLog().debug("grpc: {} ({}:{})", entry->message, entry->file, entry->line);
        });
        grpc_init();
    });
}

}  // namespace eyrie::wire
