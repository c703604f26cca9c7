// SPDX-License-Identifier: Apache-2.0
#include "coordinator/api/flight_files.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <system_error>

#include <fmt/format.h>
#include <google/protobuf/util/json_util.h>

#include "coordinator/api/replace_file.h"
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

absl::Status noFlight(const std::string& name) {
    return absl::NotFoundError(fmt::format("there is no flight '{}'", name));
}

absl::StatusOr<fs::path> pathOf(const access::DataFolder& folder, const std::string& name) {
    if (!isName(name))
        return absl::InvalidArgumentError(
            fmt::format("name is '{}'; it must be 1 to {} of a-z, A-Z, 0-9, '-' and '_'",
                        name.substr(0, kMaxNameBytes), kMaxNameBytes));
    absl::StatusOr<fs::path> path = folder.place(fmt::format("{}/{}{}", kFolder, name, kEnding));
    return absl::IsNotFound(path.status()) ? noFlight(name) : std::move(path);
}

absl::Status cannot(std::string_view what, const std::error_code& error) {
    return absl::UnavailableError(
        fmt::format("the flight cannot be {}: {}; see that the data folder is writable and not "
                    "full",
                    what, error.message()));
}

}  // namespace

bool isBuiltInFlight(std::string_view name) {
    return name == "orbit" || name == "walkthrough" || name == "worst";
}

absl::StatusOr<std::vector<std::string>> flightNames(const access::DataFolder& folder) {
    RETURN_IF_ERROR(folder.check());
    std::vector<std::string> names;
    std::error_code error;
    for (fs::directory_iterator entry(folder.path() / kFolder, error);
         !error && entry != fs::directory_iterator(); entry.increment(error))
        if (const fs::path& path = entry->path(); path.extension() == kEnding &&
                                                  isName(path.stem().string()) &&
                                                  names.size() < kMaxFlights)
            names.push_back(path.stem().string());
    if (error && error != std::errc::no_such_file_or_directory)  // no flight was ever kept
        return absl::UnavailableError(
            fmt::format("the flights cannot be read: {}; see that '{}' in the data folder is a "
                        "folder that the server may read",
                        error.message(), kFolder));
    std::ranges::sort(names);
    return names;
}

absl::StatusOr<v1::Flight> readFlight(const access::DataFolder& folder, const std::string& name) {
    ASSIGN_OR_RETURN(const fs::path path, pathOf(folder, name));
    std::ifstream file(path);
    if (!file)
        return noFlight(name);
    const std::string text(std::istreambuf_iterator<char>(file), {});
    v1::Flight flight;
    absl::Status status = wire::flightFromJson(text, path.filename().string()).status();
    if (status.ok() && !google::protobuf::util::JsonStringToMessage(text, &flight).ok())
        status = absl::DataLossError(path.filename().string());
    if (!status.ok())  // whoever asks for it has done nothing wrong
        return absl::DataLossError(
            fmt::format("the flight '{}' cannot be read: {}; keep it again, or delete it", name,
                        std::string_view(status.message().data(), status.message().size())));
    return flight;
}

absl::Status writeFlight(const access::DataFolder& folder, const std::string& name,
                         const v1::Flight& flight) {
    if (isBuiltInFlight(name))
        return absl::InvalidArgumentError(
            fmt::format("name is '{}', which `eyrie bench` has a flight of its own for; choose "
                        "another",
                        name));
    if (flight.keys_size() > kMaxKeys)
        return absl::InvalidArgumentError(fmt::format(
            "flight.keys has {} keys; at most {} are kept", flight.keys_size(), kMaxKeys));
    if (const absl::Status status = wire::fromMessage(flight).status(); !status.ok())
        return fabric::withContext(status, "flight");
    RETURN_IF_ERROR(folder.check());
    std::error_code error;
    fs::create_directory(folder.path() / kFolder, error);
    if (error)
        return cannot("written", error);
    ASSIGN_OR_RETURN(const fs::path path, pathOf(folder, name));
    if (error = replaceFile(path, wire::toJson(flight), Readers::Others); error)
        return cannot("written", error);
    return absl::OkStatus();
}

absl::Status deleteFlight(const access::DataFolder& folder, const std::string& name) {
    ASSIGN_OR_RETURN(const fs::path path, pathOf(folder, name));
    std::error_code error;
    if (!fs::remove(path, error) && !error)
        return noFlight(name);
    return error ? cannot("removed", error) : absl::OkStatus();
}

}  // namespace eyrie::api
