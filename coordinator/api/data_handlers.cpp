// SPDX-License-Identifier: Apache-2.0
#include <utility>

#include "coordinator/api/data_desk.h"
#include "coordinator/api/handler_list.h"
#include "coordinator/api/handlers.h"
#include "eyrie/v1/coordinator_service.pb.h"
#include "fabric/status.h"

namespace eyrie::api {
namespace {

/// An answer that is an operation.
template <typename Response>
absl::StatusOr<Response> responseWith(absl::StatusOr<v1::Operation> operation) {
    RETURN_IF_ERROR(operation.status());
    Response response;
    *response.mutable_operation() = *std::move(operation);
    return response;
}

}  // namespace

void addDataHandlers(Handlers& handlers, DataDesk& data) {
    handlers.add<v1::ListDataSetsRequest, v1::ListDataSetsResponse>(
        "ListDataSets",
        [&data](const v1::ListDataSetsRequest&,
                const Call& call) -> absl::StatusOr<v1::ListDataSetsResponse> {
            ASSIGN_OR_RETURN(std::vector<v1::DataSet> sets, data.dataSets(call.stop));
            v1::ListDataSetsResponse response;
            for (v1::DataSet& set : sets) *response.add_data_sets() = std::move(set);
            return response;
        });
    handlers.add<v1::ImportRequest, v1::ImportResponse>(
        "Import", [&data](const v1::ImportRequest& request, const Call&) {
            return responseWith<v1::ImportResponse>(data.import(request));
        });
}

void addOperationHandlers(Handlers& handlers, Operations& operations) {
    handlers.add<v1::ListOperationsRequest, v1::ListOperationsResponse>(
        "ListOperations",
        [&operations](const v1::ListOperationsRequest&,
                      const Call&) -> absl::StatusOr<v1::ListOperationsResponse> {
            v1::ListOperationsResponse response;
            for (v1::Operation& one : operations.all()) *response.add_operations() = std::move(one);
            return response;
        });
    handlers.add<v1::GetOperationRequest, v1::GetOperationResponse>(
        "GetOperation", [&operations](const v1::GetOperationRequest& request, const Call&) {
            return responseWith<v1::GetOperationResponse>(operations.find(request.id()));
        });
    handlers.add<v1::CancelOperationRequest, v1::CancelOperationResponse>(
        "CancelOperation", [&operations](const v1::CancelOperationRequest& request, const Call&) {
            return responseWith<v1::CancelOperationResponse>(operations.cancel(request.id()));
        });
    handlers.add<v1::DeleteOperationRequest, v1::DeleteOperationResponse>(
        "DeleteOperation",
        [&operations](const v1::DeleteOperationRequest& request,
                      const Call&) -> absl::StatusOr<v1::DeleteOperationResponse> {
            RETURN_IF_ERROR(operations.forget(request.id()));
            return v1::DeleteOperationResponse();
        });
}

}  // namespace eyrie::api
