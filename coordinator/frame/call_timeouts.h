// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>

#include "fabric/channel_task.h"

namespace eyrie::coordinator {

/// How long a renderer may take for a channel before it is given up.
struct CallTimeouts {
    std::chrono::milliseconds interactive{30'000};
    /// Loading takes as long as it takes. Heartbeats tell who is gone, and patience who is late.
    std::chrono::milliseconds complete{600'000};

    std::chrono::milliseconds of(fabric::Completeness completeness) const {
        return completeness == fabric::Completeness::Complete ? complete : interactive;
    }
};

}  // namespace eyrie::coordinator
