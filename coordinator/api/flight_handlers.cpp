// SPDX-License-Identifier: Apache-2.0
#include <string>
#include <utility>
#include <vector>

#include "coordinator/api/flight_files.h"
#include "coordinator/api/handler_list.h"
#include "coordinator/api/handlers.h"
#include "eyrie/v1/coordinator_service.pb.h"
#include "fabric/status.h"

namespace eyrie::api {
namespace {

absl::Status check(const DataFolder& folder) {
    if (folder)
        return absl::OkStatus();
    return absl::FailedPreconditionError(
        "the server has no data folder, and so keeps no flights; start it with --data DIR");
}

}  // namespace

void addFlightHandlers(Handlers& handlers, const DataFolder& folder) {
    handlers.add<v1::ListFlightsRequest, v1::ListFlightsResponse>(
        "ListFlights",
        [&folder](const v1::ListFlightsRequest&,
                  const Call&) -> absl::StatusOr<v1::ListFlightsResponse> {
            RETURN_IF_ERROR(check(folder));
            v1::ListFlightsResponse response;
            ASSIGN_OR_RETURN(std::vector<std::string> names, flightNames(*folder));
            for (std::string& name : names) response.add_names(std::move(name));
            return response;
        });
    handlers.add<v1::GetFlightRequest, v1::GetFlightResponse>(
        "GetFlight",
        [&folder](const v1::GetFlightRequest& request,
                  const Call&) -> absl::StatusOr<v1::GetFlightResponse> {
            RETURN_IF_ERROR(check(folder));
            v1::GetFlightResponse response;
            ASSIGN_OR_RETURN(*response.mutable_flight(), readFlight(*folder, request.name()));
            return response;
        });
    handlers.add<v1::PutFlightRequest, v1::PutFlightResponse>(
        "PutFlight",
        [&folder](const v1::PutFlightRequest& request,
                  const Call&) -> absl::StatusOr<v1::PutFlightResponse> {
            RETURN_IF_ERROR(check(folder));
            RETURN_IF_ERROR(writeFlight(*folder, request.name(), request.flight()));
            v1::PutFlightResponse response;
            *response.mutable_flight() = request.flight();
            return response;
        });
    handlers.add<v1::DeleteFlightRequest, v1::DeleteFlightResponse>(
        "DeleteFlight",
        [&folder](const v1::DeleteFlightRequest& request,
                  const Call&) -> absl::StatusOr<v1::DeleteFlightResponse> {
            RETURN_IF_ERROR(check(folder));
            RETURN_IF_ERROR(deleteFlight(*folder, request.name()));
            return v1::DeleteFlightResponse();
        });
}

}  // namespace eyrie::api
