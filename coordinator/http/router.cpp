// SPDX-License-Identifier: Apache-2.0
#include "coordinator/http/router.h"

#include <utility>

#include "coordinator/http/status_json.h"

namespace eyrie::http {
namespace {

constexpr std::string_view kNoUserInterface =
    "<!doctype html><html lang=\"en\"><meta charset=\"utf-8\"><title>Eyrie</title>"
    "<h1>Eyrie is running, but its browser page was not built</h1>"
    "<p>Build it with <code>cmake -DEYRIE_BUILD_WEB=ON</code> and <code>ninja eyrie_web</code> "
    "(this needs npm), then start Eyrie again.</p>"
    "<p>The state of the renderers is at <a href=\"/readyz\">/readyz</a>.</p></html>\n";

std::shared_ptr<const std::string> shared(std::string text) {
    return std::make_shared<const std::string>(std::move(text));
}

Response statusResponse(int httpStatus, const coordinator::Status& status) {
    Response response;
    response.status = httpStatus;
    response.contentType = "application/json";
    response.body = shared(statusJson(status));
    return response;
}

Response fileResponse(const StaticFile& file) {
    Response response;
    response.contentType = file.contentType;
    response.cacheControl = file.isImmutable ? "public, max-age=31536000, immutable" : "no-cache";
    response.body = file.content;
    return response;
}

Response notBuiltResponse() {
    Response response;
    response.status = 503;
    response.contentType = "text/html; charset=utf-8";
    response.body = shared(std::string(kNoUserInterface));
    return response;
}

}  // namespace

Response textResponse(int status, std::string_view text) {
    Response response;
    response.status = status;
    response.body = shared(std::string(text) + "\n");
    return response;
}

std::string_view pathOf(std::string_view target) { return target.substr(0, target.find('?')); }

Response route(std::string_view method, std::string_view target, const StaticFiles& files,
               const coordinator::FrameSource& frames) {
    if (method != "GET" && method != "HEAD")
        return textResponse(405, "Only GET and HEAD are answered here.");
    const std::string_view path = pathOf(target);
    if (path == "/healthz")
        return textResponse(200, "ok");
    if (path == "/readyz") {
        const coordinator::Status status = frames.status();
        return statusResponse(isReady(status) ? 200 : 503, status);
    }
    if (const StaticFile* file = files.find(path); file != nullptr)
        return fileResponse(*file);
    if (path == "/")
        return notBuiltResponse();
    return textResponse(404, "There is nothing here.");
}

}  // namespace eyrie::http
