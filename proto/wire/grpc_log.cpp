// SPDX-License-Identifier: Apache-2.0
#include "wire/grpc_log.h"

#include <mutex>

#include <grpc/support/log.h>
#include <spdlog/spdlog.h>

namespace eyrie::wire {

void adoptGrpcLog() {
    static std::once_flag once;
    std::call_once(once, [] {
        gpr_set_log_function([](gpr_log_func_args* entry) {
            spdlog::debug("grpc: {} ({}:{})", entry->message, entry->file, entry->line);
        });
    });
}

}  // namespace eyrie::wire
