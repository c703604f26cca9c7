// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include <absl/status/statusor.h>

#include "access/data_folder.h"
#include "coordinator/api/operations.h"
#include "coordinator/api/programs.h"
#include "eyrie/v1/coordinator_service.pb.h"

namespace eyrie::api {

/// An import that may be begun: all that it names lies in the data folder.
struct ImportOrder {
    v1::OperationKind kind = v1::OPERATION_KIND_UNSPECIFIED;
    /// Of `eyrie`, run in the data folder, without what it writes.
    std::vector<std::string> arguments = {};
    std::filesystem::path output = {};  ///< where that goes
    bool replaces = false;              ///< what is there already
};

/// InvalidArgument, NotFound or PermissionDenied, naming the field; AlreadyExists: the output is
/// there and is not to be replaced.
absl::StatusOr<ImportOrder> importOrderOf(const v1::ImportRequest& request,
                                          const access::DataFolder& folder,
                                          std::uint64_t memoryBytes);

/// Carries it out. What it makes is made in a folder of its own beside its place, and moved there
/// when it is whole; that folder goes, whatever happens to the program. Answers with what the
/// program notes of it.
absl::StatusOr<Operations::Notes> carryOut(const ImportOrder& order,
                                           const access::DataFolder& folder, const RunProgram& run,
                                           const Operations::Progress& progress,
                                           const std::stop_token& stop);

}  // namespace eyrie::api
