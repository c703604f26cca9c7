// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string_view>

#include "access/gate.h"
#include "coordinator/http/router.h"
#include "coordinator/observe/telemetry.h"

namespace eyrie::http {

/// Answers /metrics, for Prometheus. Nothing for other paths.
/// `gate`: whose refusals count; null: none.
std::optional<Response> observationResponse(std::string_view method, std::string_view target,
                                            observe::Telemetry& telemetry, const access::Gate* gate,
                                            const coordinator::FrameSource& frames);

}  // namespace eyrie::http
