// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <stop_token>
#include <vector>

#include <absl/status/statusor.h>

#include "access/data_folder.h"
#include "coordinator/api/data_sets.h"
#include "coordinator/api/operations.h"
#include "coordinator/api/programs.h"
#include "eyrie/v1/coordinator_service.pb.h"

namespace eyrie::api {

/// What data there are for scenes, and how more come to be. All functions may be called from any
/// thread.
class DataDesk {
public:
    /// `folder` outlives the desk; nothing: there are no data.
    DataDesk(const std::optional<access::DataFolder>& folder, Programs programs);

    /// Those of DataSets; FailedPrecondition: the server has no data folder, or runs no programs.
    absl::StatusOr<std::vector<v1::DataSet>> dataSets(const std::stop_token& stop);

    /// Begins one. Errors: those of importOrderOf() and Operations::begin(); FailedPrecondition:
    /// the server does no imports.
    absl::StatusOr<v1::Operation> import(const v1::ImportRequest& request);

    Operations& operations() { return operations_; }

private:
    absl::Status check() const;

    const std::optional<access::DataFolder>& folder_;
    const Programs programs_;
    std::optional<DataSets> sets_;
    Operations operations_;  ///< last: what it does ends before the rest goes
};

}  // namespace eyrie::api
