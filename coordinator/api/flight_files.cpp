// SPDX-License-Identifier: Apache-2.0
#include "coordinator/api/flight_files.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <system_error>

#include <fmt/format.h>
#include <google/protobuf/util/json_util.h>

#include "fabric/status.h"
#include "wire/flight.h"
#include "wire/json.h"

namespace eyrie::api {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxNameBytes = 64;
constexpr int kMaxKeys = 10'000;
constexpr std::size_t kMaxFlights = 10'000;
constexpr std::string_view kFolder = "flights";
constexpr std::string_view kEnding = ".json";

bool isName(std::string_view name) {
    return !name.empty() && name.size() <= kMaxNameBytes && std::ranges::all_of(name, [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
               c == '-' || c == '_';
    });
}

absl::StatusOr<fs::path> pathOf(const access::DataFolder& folder, const std::string& name) {
    if (!isName(name))
        return absl::InvalidArgumentError(
            fmt::format("name is '{}'; it must be 1 to {} of a-z, A-Z, 0-9, '-' and '_'",
                        name.substr(0, kMaxNameBytes), kMaxNameBytes));
    std::error_code error;  // what is amiss with it, place() tells
    fs::create_directory(folder.path() / kFolder, error);
    return folder.place(fmt::format("{}/{}{}", kFolder, name, kEnding));
}

absl::Status noFlight(const std::string& name) {
    return absl::NotFoundError(fmt::format("there is no flight '{}'", name));
}

}  // namespace

std::vector<std::string> flightNames(const access::DataFolder& folder) {
    std::vector<std::string> names;
    std::error_code error;
    for (fs::directory_iterator entry(folder.path() / kFolder, error);
         !error && entry != fs::directory_iterator(); entry.increment(error))
        if (const fs::path& path = entry->path(); path.extension() == kEnding &&
                                                  isName(path.stem().string()) &&
                                                  names.size() < kMaxFlights)
            names.push_back(path.stem().string());
    std::ranges::sort(names);
    return names;
}

absl::StatusOr<v1::Flight> readFlight(const access::DataFolder& folder, const std::string& name) {
    ASSIGN_OR_RETURN(const fs::path path, pathOf(folder, name));
    std::ifstream file(path);
    if (!file)
        return noFlight(name);
    const std::string text(std::istreambuf_iterator<char>(file), {});
    RETURN_IF_ERROR(wire::flightFromJson(text, path.filename().string()).status());
    v1::Flight flight;
    const auto status = google::protobuf::util::JsonStringToMessage(text, &flight);
    if (!status.ok())
        return absl::DataLossError(fmt::format("the flight '{}' cannot be read", name));
    return flight;
}

absl::Status writeFlight(const access::DataFolder& folder, const std::string& name,
                         const v1::Flight& flight) {
    ASSIGN_OR_RETURN(const fs::path path, pathOf(folder, name));
    if (flight.keys_size() > kMaxKeys)
        return absl::InvalidArgumentError(fmt::format(
            "flight.keys has {} keys; at most {} are kept", flight.keys_size(), kMaxKeys));
    if (const absl::Status status = wire::fromMessage(flight).status(); !status.ok())
        return fabric::withContext(status, "flight");
    std::error_code error;
    // Whole or not at all, whoever reads meanwhile.
    const fs::path partial = fmt::format("{}.partial", path.string());
    std::ofstream file(partial, std::ios::trunc);
    file << wire::toJson(flight);
    file.close();
    if (file.fail())
        return absl::UnavailableError(
            "the flight cannot be written; see that the data folder is writable and not full");
    fs::rename(partial, path, error);
    if (error)
        return absl::UnavailableError(
            fmt::format("the flight cannot be written: {}", error.message()));
    return absl::OkStatus();
}

absl::Status deleteFlight(const access::DataFolder& folder, const std::string& name) {
    ASSIGN_OR_RETURN(const fs::path path, pathOf(folder, name));
    std::error_code error;
    if (!fs::remove(path, error) && !error)
        return noFlight(name);
    if (error)
        return absl::UnavailableError(
            fmt::format("the flight cannot be removed: {}", error.message()));
    return absl::OkStatus();
}

}  // namespace eyrie::api
