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
#include "fabric/scene.h"

namespace eyrie::api {

/// What a bench run's report is called.
inline constexpr std::string_view kReportEnding = ".bench";

/// Its files besides those that `eyrie bench` writes: what was drawn, and along which flight
/// (flight-NAME.json) where that is no built-in one.
inline constexpr std::string_view kSceneFile = "scene.json";
inline constexpr std::string_view kFlightFileBegin = "flight-";

/// A bench run that may be begun: all that it names lies in the data folder, or is drawn already.
struct BenchOrder {
    /// Of `eyrie`, run in the folder that becomes the report.
    std::vector<std::string> arguments = {};
    std::string sceneJson = {};   ///< what it draws: scene.json there
    std::string flightName = {};  ///< its file there; empty: it needs none
    std::string flightJson = {};
    std::filesystem::path output = {};  ///< the report's place
    bool replaces = false;              ///< the report that is there already
    bool measuresErrors = false;        ///< a broken promise leaves a report, too
};

/// `scene` names files by where they lie; `memoryBytes` is what a reference may take. Errors:
/// InvalidArgument, NotFound or PermissionDenied, naming the field; AlreadyExists: the output is
/// there and is not to be replaced; FailedPrecondition: it is no report (checkIsReport).
absl::StatusOr<BenchOrder> benchOrderOf(const v1::BenchRequest& request,
                                        const access::DataFolder& folder,
                                        const fabric::Scene& scene, std::uint64_t memoryBytes);

/// Carries it out. The report is made in a folder beside its place, and moved there when it is
/// whole; that folder goes, whatever happens to the program. Where the place has become another's
/// by then, that stays. Errors: those of runToItsEnd(), in the request's terms, also of one whose
/// report was moved, since the source is where its pictures do not promise it; those of
/// checkIsReport().
absl::Status carryOut(const BenchOrder& order, const access::DataFolder& folder,
                      const RunProgram& run, const Operations::Progress& progress,
                      const std::stop_token& stop);

}  // namespace eyrie::api
