// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace eyrie::http {

/// Whether a page from `origin` (the Origin header, empty when absent) may open a WebSocket to the
/// server it calls `host` (the Host header).
///
/// Browsers let any page open a WebSocket to any host, so the server has to refuse strangers: the
/// origin must be this very host. Programs other than browsers send no origin and are let in. Of a
/// server for this machine alone (`localNamesOnly`) the host must also be an IP address or
/// "localhost", because a stranger's DNS name may be made to point there.
bool isAllowedOrigin(std::string_view origin, std::string_view host, bool localNamesOnly);

}  // namespace eyrie::http
