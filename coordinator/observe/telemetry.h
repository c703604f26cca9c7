// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "coordinator/observe/metrics.h"
#include "coordinator/observe/trace_book.h"

namespace eyrie::observe {

/// What a coordinator tells of itself. Parts that are given none tell nothing.
struct Telemetry {
    Metrics metrics;
    TraceBook traces;
};

using SharedTelemetry = std::shared_ptr<Telemetry>;

}  // namespace eyrie::observe
