// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "access/data_folder.h"
#include "coordinator/frame/configuration_access.h"
#include "coordinator/frame/frame_source.h"
#include "coordinator/observe/telemetry.h"

namespace eyrie::stream {
class SessionBook;
class StatisticsFeed;
}  // namespace eyrie::stream

namespace eyrie::api {

/// Where callers may name files; nothing: nowhere.
using DataFolder = std::optional<access::DataFolder>;

class DataDesk;
class Handlers;
class Operations;
class QuotaKeeper;
class SceneDesk;

/// Each adds some calls of CoordinatorService; what they are given outlives the handlers.
void addStatusHandlers(Handlers& handlers, coordinator::FrameSource& frames);
void addImageHandlers(Handlers& handlers, coordinator::FrameSource& frames,
                      stream::StatisticsFeed& statistics, const QuotaKeeper& quotas);
void addPlaceHandlers(Handlers& handlers, coordinator::FrameSource& frames);
void addConfigurationHandlers(Handlers& handlers, coordinator::ConfigurationAccess& configuration);
void addSessionHandlers(Handlers& handlers, coordinator::FrameSource& frames,
                        stream::SessionBook& sessions);
void addStatisticsHandlers(Handlers& handlers, stream::StatisticsFeed& statistics,
                           const QuotaKeeper& quotas);
void addTraceHandlers(Handlers& handlers, observe::SharedTelemetry telemetry,
                      const QuotaKeeper& quotas);
void addSceneHandlers(Handlers& handlers, SceneDesk& scenes);
void addFlightHandlers(Handlers& handlers, const DataFolder& folder);
void addDataHandlers(Handlers& handlers, DataDesk& data);
void addBenchHandlers(Handlers& handlers, DataDesk& data, SceneDesk& scenes,
                      const DataFolder& folder, const QuotaKeeper& quotas);
void addOperationHandlers(Handlers& handlers, Operations& operations);

}  // namespace eyrie::api
