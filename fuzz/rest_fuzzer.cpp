// SPDX-License-Identifier: Apache-2.0
// What programs send by HTTP, of any bytes: the first line is a method and a target, lines of
// headers follow, and after an empty one the body. Every call is answered as HTTP has it, errors
// and facts in JSON, and none of them by "internal error".
#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include <google/protobuf/struct.pb.h>
#include <google/protobuf/util/json_util.h>
#include <spdlog/spdlog.h>

#include "access/data_folder.h"
#include "coordinator/api/api.h"
#include "coordinator/api/rest_door.h"
#include "coordinator/config/default_config.h"
#include "coordinator/frame/active_configuration.h"
#include "tests/coordinator/fake_frame_source.h"
#include "tests/support/temporary_folder.h"

namespace {

using namespace eyrie;

/// Draws nothing large: what drawing takes is for others to limit.
class Frames : public coordinator::FrameSource {
public:
    absl::StatusOr<coordinator::RenderedFrame> renderFrame(
        const coordinator::FrameRequest& request) override {
        const fabric::PixelViewport part = request.drawnPart();
        if (part.width > 64 || part.height > 64)
            return absl::UnavailableError("too large for here");
        return coordinator::plainFrame(request, {90, 120, 60, 255});
    }
    absl::StatusOr<fabric::SeenAreas> seen(const coordinator::FrameRequest&) override {
        return fabric::SeenAreas();
    }
    absl::StatusOr<fabric::Picked> pick(const fabric::PickRequest&) override {
        return fabric::Picked();
    }
    absl::Status configure(const coordinator::SwitchLayout& change) override {
        return absl::NotFoundError("there is no layout " + change.layout);
    }
    coordinator::Status status() const override { return coordinator::readyStatus(); }
    int subscribe(std::function<void()>) override { return 1; }
    void unsubscribe(int) override {}
};

class Configuration : public coordinator::ConfigurationAccess {
public:
    absl::Status withConfiguration(
        const std::function<absl::Status(coordinator::ActiveConfiguration&)>& use) override {
        return use(active_);
    }

private:
    coordinator::ActiveConfiguration active_{config::defaultConfiguration(
        std::vector<config::RendererFacts>{{"a", "", "fake"}, {"b", "", "fake"}})};
};

/// A coordinator's API over a folder with a file and a flight in it, and programs that do nothing.
class Server {
public:
    Server() {
        // Quiet, and made before the server, whose last operation may end, and be told, after main.
        spdlog::set_level(spdlog::level::off);
        folder_.write("hill.ply", "ply\n");
    }

    api::RestAnswer answer(const api::RestRequest& request) const {
        return api_.rest().answer(request);
    }

private:
    static absl::StatusOr<api::ProgramEnd> run(const std::vector<std::string>&,
                                               const std::filesystem::path&,
                                               const std::function<void(std::string_view)>& heard,
                                               const std::stop_token&) {
        heard("reading 10 %");
        return api::ProgramEnd{.crashed = false, .code = 2, .output = "{}"};
    }

    test::TemporaryFolder folder_;
    Frames frames_;
    Configuration configuration_;
    api::Api api_{{frames_,
                   configuration_,
                   [](fabric::Scene) {},
                   access::DataFolder::open(folder_.path()).value(),
                   {.run = run, .importsAtOnce = 1}}};
};

std::string_view takeLine(std::string_view& text) {
    const std::string_view line = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(text.size(), line.size() + 1));
    return line;
}

/// As the server hands it on: of paths below /api only.
api::RestRequest requestOf(std::string_view text) {
    api::RestRequest request;
    const std::string_view first = takeLine(text);
    const std::size_t blank = std::min(first.find(' '), first.size());
    request.method = first.substr(0, blank);
    request.target = "/api";
    request.target += first.substr(std::min(blank + 1, first.size()));
    for (std::string_view line = takeLine(text); !line.empty(); line = takeLine(text)) {
        const auto valueOf = [&line](std::string_view name, std::string& value) {
            if (line.starts_with(name))
                value = line.substr(name.size());
        };
        valueOf("Content-Type: ", request.contentType);
        valueOf("Accept: ", request.accept);
        valueOf("If-None-Match: ", request.ifNoneMatch);
        valueOf("Idempotency-Key: ", request.idempotencyKey);
    }
    request.body = text;
    return request;
}

bool isJson(const std::string& text) {
    google::protobuf::Value value;
    return google::protobuf::util::JsonStringToMessage(text, &value).ok();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const Server server;
    const api::RestRequest request = requestOf({reinterpret_cast<const char*>(data), size});
    const api::RestAnswer answer = server.answer(request);
    if (answer.status < 200 || answer.status > 503 || answer.status == 500)
        std::abort();
    const bool isProblem = answer.contentType == "application/problem+json";
    if (isProblem != (answer.status >= 400))
        std::abort();
    if ((isProblem || answer.contentType == "application/json") && !answer.body->empty() &&
        !isJson(*answer.body))
        std::abort();
    return 0;
}
