// SPDX-License-Identifier: Apache-2.0
#include "coordinator/api/data_desk.h"

#include <algorithm>
#include <utility>

#include "coordinator/api/import_order.h"
#include "fabric/status.h"

namespace eyrie::api {

DataDesk::DataDesk(const std::optional<access::DataFolder>& folder, Programs programs)
    : folder_(folder),
      programs_(std::move(programs)),
      operations_({.atOnce = std::max<std::size_t>(1, programs_.importsAtOnce)}) {
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

absl::StatusOr<v1::Operation> DataDesk::import(const v1::ImportRequest& request) {
    RETURN_IF_ERROR(check());
    if (programs_.importsAtOnce == 0)
        return absl::FailedPreconditionError(
            "this server does no imports; start it with --imports 1");
    const std::string asked = request.SerializeAsString();
    // Asked for again, its output may be there by now.
    if (absl::StatusOr<v1::Operation> before = operations_.begun(request.request_id(), asked);
        !absl::IsNotFound(before.status()))
        return before;
    ASSIGN_OR_RETURN(const ImportOrder order,
                     importOrderOf(request, *folder_, programs_.importMemoryBytes));
    return operations_.begin(
        {request.request_id(), order.kind, request.output(), asked,
         [this, order](const Operations::Progress& progress, const std::stop_token& stop) {
             return carryOut(order, *folder_, programs_.run, progress, stop);
         }});
}

}  // namespace eyrie::api
