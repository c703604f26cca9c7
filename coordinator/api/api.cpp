// SPDX-License-Identifier: Apache-2.0
#include "coordinator/api/api.h"

#include <memory>
#include <utility>

#include "coordinator/api/data_desk.h"
#include "coordinator/api/handler_list.h"
#include "coordinator/api/handlers.h"
#include "coordinator/api/scene_desk.h"
#include "coordinator/stream/session_book.h"

namespace eyrie::api {

class Api::Impl {
public:
    explicit Impl(ApiParts parts)
        : folder(std::move(parts.dataFolder)),
          telemetry(parts.telemetry ? std::move(parts.telemetry)
                                    : std::make_shared<observe::Telemetry>()),
          quotas(parts.quotas, telemetry),
          sessions(std::make_shared<stream::SessionBook>(parts.quotas.readers)),
          data(folder, std::move(parts.programs), quotas, telemetry, parts.frames),
          scenes(folder, data, quotas, parts.frames, std::move(parts.setScene), parts.state) {
        addStatusHandlers(handlers, parts.frames);
        addSessionHandlers(handlers, parts.frames, *sessions);
        addStatisticsHandlers(handlers, sessions->statistics(), quotas);
        addTraceHandlers(handlers, telemetry, quotas);
        addImageHandlers(handlers, parts.frames, sessions->statistics(), quotas);
        addPlaceHandlers(handlers, parts.frames);
        addConfigurationHandlers(handlers, parts.configuration);
        addSceneHandlers(handlers, scenes);
        addFlightHandlers(handlers, folder);
        addDataHandlers(handlers, data);
        addBenchHandlers(handlers, data, scenes, folder, quotas);
        addOperationHandlers(handlers, data.operations());
    }

    const std::optional<access::DataFolder> folder;
    const observe::SharedTelemetry telemetry;
    QuotaKeeper quotas;
    const std::shared_ptr<stream::SessionBook> sessions;
    DataDesk data;
    SceneDesk scenes;
    Handlers handlers{quotas, telemetry};
    const RestDoor rest{handlers};
};

Api::Api(ApiParts parts) : impl_(std::make_unique<Impl>(std::move(parts))) {}
Api::~Api() = default;

const Handlers& Api::handlers() const { return impl_->handlers; }
const RestDoor& Api::rest() const { return impl_->rest; }
const std::shared_ptr<stream::SessionBook>& Api::sessions() const { return impl_->sessions; }
void Api::endStreams() { impl_->sessions->statistics().stop(); }
void Api::begin(fabric::Scene scene, fabric::Scene asNamed) {
    impl_->scenes.begin(std::move(scene), std::move(asNamed));
}

}  // namespace eyrie::api
