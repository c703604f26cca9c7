// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <optional>

#include "access/data_folder.h"
#include "coordinator/api/programs.h"
#include "coordinator/api/quotas.h"
#include "coordinator/api/rest_door.h"
#include "coordinator/frame/configuration_access.h"
#include "coordinator/frame/frame_source.h"

namespace eyrie::stream {
class SessionBook;
}

namespace eyrie::api {

class StateFile;

/// What the calls act upon; outlives the API.
struct ApiParts {
    coordinator::FrameSource& frames;
    coordinator::ConfigurationAccess& configuration;
    std::function<void(fabric::Scene)> setScene;  ///< of a scene that fabric::validate accepts
    std::optional<access::DataFolder> dataFolder = {};
    Programs programs = {};
    Quotas quotas = {};
    /// Counts what is beyond them, and has the traces; null: of its own.
    observe::SharedTelemetry telemetry = nullptr;
    /// Where scenes that are set are kept, outlives the API; null: nowhere.
    StateFile* state = nullptr;
};

/// What programs can ask of a coordinator: the handlers of CoordinatorService and what these need.
/// All functions may be called from any thread.
class Api {
public:
    explicit Api(ApiParts parts);
    ~Api();
    Api(const Api&) = delete;
    Api& operator=(const Api&) = delete;

    const Handlers& handlers() const;
    const RestDoor& rest() const;

    /// Where viewers' sessions are to be entered, for programs to see them.
    const std::shared_ptr<stream::SessionBook>& sessions() const;

    /// Ends the answers that go on; other calls are answered as before.
    void endStreams();

    /// Sets the scene that the server was started with or, where programs had set another in its
    /// place before, that. Programs may show its files, wherever they are. `asNamed`: as for
    /// Coordinator::setScene.
    void begin(fabric::Scene scene, fabric::Scene asNamed);

private:
    class Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace eyrie::api
