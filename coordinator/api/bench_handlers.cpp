// SPDX-License-Identifier: Apache-2.0
#include <memory>
#include <utility>

#include "coordinator/api/bench_order.h"
#include "coordinator/api/bench_reports.h"
#include "coordinator/api/data_desk.h"
#include "coordinator/api/handler_list.h"
#include "coordinator/api/handlers.h"
#include "coordinator/api/scene_desk.h"
#include "eyrie/v1/coordinator_service.pb.h"
#include "fabric/status.h"

namespace eyrie::api {

void addBenchHandlers(Handlers& handlers, DataDesk& data, SceneDesk& scenes,
                      const DataFolder& folder, const QuotaKeeper& quotas) {
    handlers.add<v1::BenchRequest, v1::BenchResponse>(
        "Bench",
        [&data, &scenes, &folder](const v1::BenchRequest& request,
                                  const Call& call) -> absl::StatusOr<v1::BenchResponse> {
            const auto order = [&](std::uint64_t memoryBytes) -> absl::StatusOr<BenchOrder> {
                if (!request.has_scene())
                    return benchOrderOf(request, *folder, scenes.shown(), memoryBytes);
                ASSIGN_OR_RETURN(const fabric::Scene scene,
                                 scenes.resolved(request.scene(), call.stop));
                return benchOrderOf(request, *folder, scene, memoryBytes);
            };
            v1::BenchResponse response;
            ASSIGN_OR_RETURN(*response.mutable_operation(), data.bench(request, order));
            return response;
        });
    handlers.add<v1::GetReportRequest, v1::GetReportResponse>(
        "GetReport",
        [&folder, &quotas](const v1::GetReportRequest& request,
                           const Call& call) -> absl::StatusOr<v1::GetReportResponse> {
            if (!folder)
                return absl::FailedPreconditionError(
                    "the server has no data folder, and so no reports; start it with --data DIR");
            v1::GetReportResponse response;
            ASSIGN_OR_RETURN(const FoundReport found,
                             findReport(*folder, request.name(), request.file()));
            ASSIGN_OR_RETURN(std::shared_ptr<void> share,
                             quotas.documentShare(call.taking(found.bytes)));
            call.keep(std::move(share));
            ASSIGN_OR_RETURN(*response.mutable_content(), read(found));
            response.set_file(request.file() == v1::REPORT_FILE_UNSPECIFIED
                                  ? v1::REPORT_FILE_SUMMARY
                                  : request.file());
            return response;
        });
}

}  // namespace eyrie::api
