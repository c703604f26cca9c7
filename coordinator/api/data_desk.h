// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include <absl/status/statusor.h>

#include "access/data_folder.h"
#include "coordinator/api/data_sets.h"
#include "coordinator/api/operations.h"
#include "coordinator/api/programs.h"
#include "coordinator/observe/telemetry.h"
#include "eyrie/v1/coordinator_service.pb.h"

namespace eyrie::coordinator {
class FrameSource;
}

namespace eyrie::api {

struct BenchOrder;
class QuotaKeeper;

/// What data there are for scenes, and how more come to be. All functions may be called from any
/// thread.
class DataDesk {
public:
    /// `folder` and `quotas` outlive the desk; no folder: there are no data. `telemetry` counts
    /// what becomes of operations; `frames`, which outlives the desk, knows what is on show.
    DataDesk(const std::optional<access::DataFolder>& folder, Programs programs,
             const QuotaKeeper& quotas, observe::SharedTelemetry telemetry,
             const coordinator::FrameSource& frames);

    /// Those of DataSets; FailedPrecondition: the server has no data folder, or runs no programs.
    absl::StatusOr<std::vector<v1::DataSet>> dataSets(const std::stop_token& stop);

    /// Begins one. Errors: those of importOrderOf() and Operations::begin(); FailedPrecondition:
    /// the server does no imports.
    absl::StatusOr<v1::Operation> import(const v1::ImportRequest& request);

    /// What is known of the file of that name; nothing where the server runs no programs.
    /// Errors: those of DataSets; FailedPrecondition (the file cannot be read).
    absl::StatusOr<v1::DataSet> look(const std::string& name, const std::stop_token& stop);

    /// What a bench run of programs that may take so much memory is.
    using MakeBenchOrder = std::function<absl::StatusOr<BenchOrder>(std::uint64_t memoryBytes)>;

    /// Begins a bench run; `order` is asked for what it is unless it has begun before. Errors: its
    /// own, and those of import().
    absl::StatusOr<v1::Operation> bench(const v1::BenchRequest& request,
                                        const MakeBenchOrder& order);

    Operations& operations() { return operations_; }

private:
    absl::Status check() const;
    absl::Status checkOperations() const;
    absl::StatusOr<v1::Operation> begin(Operations::Order order);
    void noteEnd(const v1::Operation& operation, const absl::Status& status) const;
    bool isOnShow(const std::filesystem::path& file) const;

    const std::optional<access::DataFolder>& folder_;
    const Programs programs_;
    const QuotaKeeper& quotas_;
    std::optional<DataSets> sets_;
    const observe::SharedTelemetry telemetry_;
    const coordinator::FrameSource& frames_;
    Operations operations_;  ///< last: what it does ends before the rest goes
};

}  // namespace eyrie::api
