// SPDX-License-Identifier: Apache-2.0
#include "wire/grpc_runtime.h"

#include <mutex>

#include <grpc/grpc.h>
#include <grpc/support/log.h>

#include "fabric/log.h"

namespace eyrie::wire {

void startGrpc() {
    static std::once_flag once;
    std::call_once(once, [] {
        gpr_set_log_function([](gpr_log_func_args* entry) {
            spdlog::debug("grpc: {} ({}:{})", entry->message, entry->file, entry->line);
        });
        grpc_init();
    });
}

}  // namespace eyrie::wire
