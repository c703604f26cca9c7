// SPDX-License-Identifier: Apache-2.0
#include "coordinator/api/data_desk.h"

#include <algorithm>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "coordinator/api/bench_order.h"
#include "coordinator/api/import_order.h"
#include "coordinator/api/quotas.h"
#include "coordinator/frame/frame_source.h"
#include "fabric/log.h"
#include "fabric/status.h"

namespace eyrie::api {

DataDesk::DataDesk(const std::optional<access::DataFolder>& folder, Programs programs,
                   const QuotaKeeper& quotas, observe::SharedTelemetry telemetry,
                   const coordinator::FrameSource& frames)
    : folder_(folder),
      programs_(std::move(programs)),
      quotas_(quotas),
      telemetry_(std::move(telemetry)),
      frames_(frames),
      operations_({.atOnce = std::max<std::size_t>(1, programs_.importsAtOnce)},
                  Operations::Clock::now,
                  [this](const v1::Operation& operation, const absl::Status& status) {
                      noteEnd(operation, status);
                  }) {
    if (folder_)
        sets_.emplace(*folder_, programs_.run);
}

absl::Status DataDesk::check() const {
    if (!folder_)
        return absl::FailedPreconditionError(
            "the server has no data folder; start it with --data DIR");
    if (!programs_.run)
        return absl::FailedPreconditionError("this server runs no other programs");
    return absl::OkStatus();
}

absl::StatusOr<std::vector<v1::DataSet>> DataDesk::dataSets(const std::stop_token& stop) {
    RETURN_IF_ERROR(check());
    return sets_->list(stop);
}

absl::StatusOr<v1::DataSet> DataDesk::look(const std::string& name, const std::stop_token& stop) {
    if (!sets_ || !programs_.run)
        return v1::DataSet();
    ASSIGN_OR_RETURN(v1::DataSet set, sets_->look(name, stop));
    if (!set.problem().empty())
        return absl::FailedPreconditionError(
            fmt::format("'{}' cannot be opened: {}", name, set.problem()));
    return set;
}

absl::Status DataDesk::checkOperations() const {
    RETURN_IF_ERROR(check());
    if (programs_.importsAtOnce == 0)
        return absl::FailedPreconditionError(
            "this server does no imports and no bench runs; start it with --imports 1");
    return absl::OkStatus();
}

void DataDesk::noteEnd(const v1::Operation& operation, const absl::Status& status) const {
    telemetry_->metrics.operationEnded(status);
    if (!status.ok() && !absl::IsCancelled(status))
        spdlog::warn("operation {}, of {}, has failed: {}", operation.id(), operation.output(),
                     operation.problem());
}

bool DataDesk::isOnShow(const std::filesystem::path& file) const {
    return std::ranges::any_of(
        frames_.status().scene.objects, [&](const fabric::SceneObject& object) {
            std::error_code error;
            return std::filesystem::equivalent(object.path, file, error) && !error;
        });
}

absl::StatusOr<v1::Operation> DataDesk::begin(Operations::Order order) {
    absl::StatusOr<v1::Operation> begun = operations_.begin(std::move(order));
    if (absl::IsResourceExhausted(begun.status()))
        return quotas_.counted(observe::Quota::Operations, begun.status());
    return begun;
}

absl::StatusOr<v1::Operation> DataDesk::import(const v1::ImportRequest& request) {
    RETURN_IF_ERROR(checkOperations());
    const std::string asked = request.SerializeAsString();
    // Asked for again, its output may be there by now.
    if (absl::StatusOr<v1::Operation> before = operations_.begun(request.request_id(), asked);
        !absl::IsNotFound(before.status()))
        return before;
    ASSIGN_OR_RETURN(const ImportOrder order,
                     importOrderOf(request, *folder_, programs_.importMemoryBytes));
    return begin({request.request_id(), order.kind, request.output(), asked,
                  [this, order, output = request.output()](
                      const Operations::Progress& progress,
                      const std::stop_token& stop) -> absl::StatusOr<Operations::Notes> {
                      ASSIGN_OR_RETURN(Operations::Notes notes,
                                       carryOut(order, *folder_, programs_.run, progress, stop));
                      if (isOnShow(order.output))
                          notes.insert(notes.begin(),
                                       fmt::format("{} is on show, as it was before: set the scene "
                                                   "again (PUT /api/v1/scene) to show it as it is "
                                                   "now",
                                                   output));
                      return notes;
                  }});
}

absl::StatusOr<v1::Operation> DataDesk::bench(const v1::BenchRequest& request,
                                              const MakeBenchOrder& order) {
    RETURN_IF_ERROR(checkOperations());
    const std::string asked = request.GetTypeName() + request.SerializeAsString();
    if (absl::StatusOr<v1::Operation> before = operations_.begun(request.request_id(), asked);
        !absl::IsNotFound(before.status()))
        return before;
    ASSIGN_OR_RETURN(BenchOrder made, order(programs_.importMemoryBytes));
    return begin({request.request_id(), v1::OPERATION_KIND_BENCH, request.output(), asked,
                  [this, made = std::move(made)](
                      const Operations::Progress& progress,
                      const std::stop_token& stop) -> absl::StatusOr<Operations::Notes> {
                      RETURN_IF_ERROR(carryOut(made, *folder_, programs_.run, progress, stop));
                      return Operations::Notes();
                  }});
}

}  // namespace eyrie::api
