// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "coordinator/farm/channel_renderer.h"
#include "coordinator/observe/telemetry.h"
#include "wire/security.h"

namespace eyrie::coordinator {

/// The renderer that serves RenderService at `address`, "host:port" or "unix:/path". Does not wait
/// for the connection: the first call fails with Unavailable when nobody listens.
///
/// Nothing it answers is believed unchecked: what does not fit the task is an Internal error that
/// names the field. Tells `telemetry` of what it draws. Pictures come in memory where the renderer
/// can open that of this process, unless `offersMemory` is false; else in messages.
std::shared_ptr<ChannelRenderer> connectRenderer(const std::string& address,
                                                 const wire::Security& security = {},
                                                 observe::SharedTelemetry telemetry = nullptr,
                                                 bool offersMemory = true);

}  // namespace eyrie::coordinator
