// SPDX-License-Identifier: Apache-2.0
#include "coordinator/observe/stage_timer.h"

#include <utility>

namespace eyrie::observe {

void StageTimer::stop() {
    Telemetry* const telemetry = std::exchange(telemetry_, nullptr);
    if (telemetry == nullptr)
        return;
    const Clock::time_point end = Clock::now();
    telemetry->metrics.took(stage_, end - begin_);
    const std::string name = stage_ == Stage::Total ? "frame" : std::string(nameOf(stage_));
    telemetry->traces.add({"coordinator", thread_, name, frame_, begin_, end});
}

}  // namespace eyrie::observe
