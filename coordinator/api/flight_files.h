// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <absl/status/statusor.h>

#include "access/data_folder.h"
#include "eyrie/v1/flight.pb.h"

/// Flights that are kept in a data folder, each under a name of 1 to 64 of a-z, A-Z, 0-9, '-' and
/// '_'. Errors of all: InvalidArgument (the name), NotFound, Unavailable (the folder cannot be read
/// or written). Any thread: who reads what another writes gets the old or the new, whole.
namespace eyrie::api {

/// Whether `eyrie bench` has a flight of its own of that name.
bool isBuiltInFlight(std::string_view name);

/// By name.
absl::StatusOr<std::vector<std::string>> flightNames(const access::DataFolder& folder);

/// DataLoss: what is in the file is no flight.
absl::StatusOr<v1::Flight> readFlight(const access::DataFolder& folder, const std::string& name);

/// InvalidArgument: the flight cannot be flown, or has too many keys, or the name is built in.
absl::Status writeFlight(const access::DataFolder& folder, const std::string& name,
                         const v1::Flight& flight);

absl::Status deleteFlight(const access::DataFolder& folder, const std::string& name);

}  // namespace eyrie::api
