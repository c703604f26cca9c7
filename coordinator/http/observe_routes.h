// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string_view>

#include "coordinator/http/router.h"
#include "coordinator/observe/telemetry.h"

namespace eyrie::http {

/// Answers what operators ask: /metrics, for Prometheus, and /api/v1/trace?frames=N, the last 1 to
/// 1000 frames (10 when not said) as Chrome's trace viewer reads them. Nothing for other paths.
std::optional<Response> observationResponse(std::string_view method, std::string_view target,
                                            observe::Telemetry& telemetry,
                                            const coordinator::FrameSource& frames);

}  // namespace eyrie::http
