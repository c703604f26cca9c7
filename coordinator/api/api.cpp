// SPDX-License-Identifier: Apache-2.0
#include "coordinator/api/api.h"

#include <utility>

#include "coordinator/api/data_desk.h"
#include "coordinator/api/handler_list.h"
#include "coordinator/api/handlers.h"
#include "coordinator/api/scene_desk.h"

namespace eyrie::api {

class Api::Impl {
public:
    explicit Impl(ApiParts parts)
        : folder(std::move(parts.dataFolder)),
          scenes(folder, parts.frames, std::move(parts.setScene)),
          data(folder, std::move(parts.programs)) {
        addStatusHandlers(handlers, parts.frames);
        addImageHandlers(handlers, parts.frames);
        addPlaceHandlers(handlers, parts.frames);
        addConfigurationHandlers(handlers, parts.configuration);
        addSceneHandlers(handlers, scenes);
        addFlightHandlers(handlers, folder);
        addDataHandlers(handlers, data);
        addOperationHandlers(handlers, data.operations());
    }

    const std::optional<access::DataFolder> folder;
    SceneDesk scenes;
    DataDesk data;
    Handlers handlers;
    const RestDoor rest{handlers};
};

Api::Api(ApiParts parts) : impl_(std::make_unique<Impl>(std::move(parts))) {}
Api::~Api() = default;

const Handlers& Api::handlers() const { return impl_->handlers; }
const RestDoor& Api::rest() const { return impl_->rest; }
void Api::allow(const fabric::Scene& scene) { impl_->scenes.allow(scene); }

}  // namespace eyrie::api
