// SPDX-License-Identifier: Apache-2.0
#include "service/reply_slots.h"

#include <fmt/format.h>

namespace eyrie::service {

void ReplySlots::open() {
    const std::lock_guard lock(mutex_);
    ++open_;
}

void ReplySlots::leave(std::size_t bytes) {
    const std::lock_guard lock(mutex_);
    --open_;
    leavingBytes_ += bytes;
}

void ReplySlots::close(std::size_t bytes) {
    const std::lock_guard lock(mutex_);
    leavingBytes_ -= bytes;
}

absl::Status ReplySlots::check() const {
    const std::lock_guard lock(mutex_);
    if (open_ > kMaxOpen)
        return absl::ResourceExhaustedError(
            fmt::format("{} channels are being drawn or sent already; read those first", kMaxOpen));
    if (leavingBytes_ > kMaxLeavingBytes)
        return absl::ResourceExhaustedError(
            fmt::format("the ends of channels sent before, {} bytes, have not been read; at most "
                        "{} may wait",
                        leavingBytes_, kMaxLeavingBytes));
    return absl::OkStatus();
}

}  // namespace eyrie::service
