// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "coordinator/frame/frame_source.h"

namespace eyrie::http {

/// "ready", "opening" and so on, as in statusJson.
std::string_view nameOf(coordinator::RendererCondition condition);

/// A renderer is alive, the scene is open and nothing stands in the way of a picture.
bool isReady(const coordinator::Status& status);

/// {"ready":true,"problem":"","renderers":[{"id":"…","address":"…","alive":true,"condition":"ready",
/// "why":"","sinceUnixMilliseconds":0,"device":"…","driver":"…","platform":"…","software":false}],"scene":{"objects":["…"],"triangles":0}}
std::string statusJson(const coordinator::Status& status);

}  // namespace eyrie::http
