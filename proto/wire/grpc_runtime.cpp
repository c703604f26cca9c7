// SPDX-License-Identifier: Apache-2.0
#include "wire/grpc_runtime.h"

#include <memory>
#include <mutex>

#include <grpc/grpc.h>
#include <grpc/support/log.h>
#include <openssl/crypto.h>

#include "access/failed_handshakes.h"
#include "fabric/log.h"
#include "wire/handshake_log.h"

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

/// Less severe lines are HandshakeLog's alone. Written before there are any.
gpr_log_severity least = GPR_LOG_SEVERITY_ERROR;

/// The least severe line that GRPC_VERBOSITY, or gRPC where it says nothing, would have printed.
gpr_log_severity leastPrinted() {
    for (const auto severity : {GPR_LOG_SEVERITY_DEBUG, GPR_LOG_SEVERITY_INFO})
        if (gpr_should_log(severity) != 0)
            return severity;
    return GPR_LOG_SEVERITY_ERROR;
}

void takeLine(gpr_log_func_args* entry) {
    if (const auto warning = handshakeLog().note(entry->file, entry->message))
        lastingLog().warn("{}", *warning);
    if (entry->severity >= least)
        lastingLog().debug("grpc: {} ({}:{})", entry->message, entry->file, entry->line);
}

}  // namespace

HandshakeLog& handshakeLog() {
    static HandshakeLog& log = *new HandshakeLog(access::FailedHandshakes::atGrpcPorts());
    return log;
}

void startGrpc() {
    static std::once_flag once;
    std::call_once(once, [] {
        lastingLog();  // while there is one
        handshakeLog();
        gpr_log_verbosity_init();
        least = leastPrinted();
        gpr_set_log_function(takeLine);
        gpr_set_log_verbosity(GPR_LOG_SEVERITY_DEBUG);  // what HandshakeLog reads; it is rare
        grpc_init();
    });
}

}  // namespace eyrie::wire
