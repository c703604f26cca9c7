// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "coordinator/frame/frame_source.h"
#include "coordinator/http/static_files.h"

namespace eyrie::http {

struct Response {
    int status = 200;
    std::string contentType = "text/plain; charset=utf-8";
    std::string cacheControl = "no-store";
    std::vector<std::pair<std::string, std::string>> headers = {};  ///< beside these
    std::shared_ptr<const std::string> body = std::make_shared<const std::string>();
};

/// One line of text for a person.
Response textResponse(int status, std::string_view text);

/// Answers everything but the WebSocket. `target` is the request's, with its query.
Response route(std::string_view method, std::string_view target, const StaticFiles& files,
               const coordinator::FrameSource& frames);

/// `target` without its query.
std::string_view pathOf(std::string_view target);

}  // namespace eyrie::http
