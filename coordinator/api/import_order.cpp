// SPDX-License-Identifier: Apache-2.0
#include "coordinator/api/import_order.h"

#include <algorithm>
#include <charconv>
#include <string_view>
#include <system_error>

#include <absl/strings/ascii.h>
#include <fmt/format.h>
#include <google/protobuf/struct.pb.h>
#include <google/protobuf/util/json_util.h>

#include "coordinator/api/bench_reports.h"
#include "coordinator/api/data_sets.h"
#include "coordinator/api/work_folder.h"
#include "fabric/name_beside.h"
#include "fabric/status.h"

namespace eyrie::api {
namespace {

namespace fs = std::filesystem;

constexpr int kMaxFiles = 1000;
/// As `eyrie import terrain --error` takes them.
constexpr double kLeastErrorMetres = 1e-6;
constexpr double kMostErrorMetres = 1e6;

/// The files' names as a program in the data folder has them: no option begins so.
absl::StatusOr<std::vector<std::string>> filesOf(
    const google::protobuf::RepeatedPtrField<std::string>& names, const char* field,
    const access::DataFolder& folder) {
    if (names.size() > kMaxFiles)
        return absl::InvalidArgumentError(
            fmt::format("{} has {} names; at most {} are taken", field, names.size(), kMaxFiles));
    std::vector<std::string> files;
    for (int i = 0; i < names.size(); ++i) {
        const absl::StatusOr<fs::path> path = folder.existing(names[i]);
        if (!path.ok())
            return fabric::withContext(path.status(), fmt::format("{}[{}]", field, i));
        std::error_code error;
        if (!fs::is_regular_file(*path, error))
            return absl::InvalidArgumentError(
                fmt::format("{}[{}] is '{}', which is no file", field, i, names[i]));
        files.push_back("./" + path->lexically_relative(folder.path()).string());
    }
    return files;
}

bool hasAny(std::string_view text, std::string_view characters) {
    return text.find_first_of(characters) != std::string_view::npos;
}

/// The name by which GDAL knows a part of a file. It is put together here of pieces in which no
/// colon or quote ends the file's path early: it can name no other file.
absl::StatusOr<std::string> nameOfPart(const std::string& part, const std::string& file) {
    constexpr std::string_view kEnds = ":\"";
    const bool isPlain =
        !hasAny(part, kEnds) && std::ranges::all_of(part, [](unsigned char c) { return c >= ' '; });
    if (!isPlain || hasAny(file, kEnds))
        return absl::InvalidArgumentError(
            fmt::format("subdataset, of '{}': neither it nor the file's name may have colons, "
                        "quotes or control characters",
                        file));
    const std::string ending = absl::AsciiStrToLower(fs::path(file).extension().string());
    if (ending == ".gpkg")
        return fmt::format("GPKG:{}:{}", file, part);
    if (ending == ".nc")
        return fmt::format("NETCDF:\"{}\":{}", file, part);
    if (ending == ".h5")
        return fmt::format("HDF5:\"{}\"://{}", file,
                           part.substr(std::min(part.find_first_not_of('/'), part.size())));
    if (ending != ".tif" && ending != ".tiff")
        return absl::InvalidArgumentError(
            fmt::format("subdataset is of .gpkg, .tif, .nc and .h5, and a source is '{}'", file));
    if (hasAny(part.substr(0, 1), "0") || part.find_first_not_of("0123456789") != std::string::npos)
        return absl::InvalidArgumentError(
            fmt::format("subdataset is '{}'; of .tif it is the number of a page, from 1", part));
    return fmt::format("GTIFF_DIR:{}:{}", part, file);
}

/// As `eyrie import mesh --normals` takes it.
bool isNormals(std::string_view text) {
    constexpr std::string_view kCrease = "crease=";
    if (!text.starts_with(kCrease))
        return text == "auto" || text == "smooth" || text == "file";
    double degrees = 0;
    const char* const end = text.data() + text.size();
    const auto [rest, error] = std::from_chars(text.data() + kCrease.size(), end, degrees);
    return error == std::errc() && rest == end && degrees >= 0 && degrees <= 180;
}

absl::StatusOr<v1::OperationKind> kindOf(const fs::path& output) {
    if (output.extension() == ".eyt")
        return v1::OPERATION_KIND_IMPORT_TERRAIN;
    if (output.extension() == ".eym")
        return v1::OPERATION_KIND_IMPORT_MESH;
    return absl::InvalidArgumentError(
        fmt::format("output is '{}'; its name must end in .eyt for a terrain or .eym for a mesh",
                    output.filename().string()));
}

absl::Status checkChoices(const v1::ImportRequest& request, v1::OperationKind kind) {
    if (request.sources().empty())
        return absl::InvalidArgumentError("sources is empty; name at least one file");
    if (kind == v1::OPERATION_KIND_IMPORT_TERRAIN && request.orient())
        return absl::InvalidArgumentError("orient is of meshes, and the output is a terrain");
    if (kind == v1::OPERATION_KIND_IMPORT_TERRAIN && !request.normals().empty())
        return absl::InvalidArgumentError("normals is of meshes, and the output is a terrain");
    if (kind == v1::OPERATION_KIND_IMPORT_MESH && !request.subdataset().empty())
        return absl::InvalidArgumentError("subdataset is of terrains, and the output is a mesh");
    if (!request.normals().empty() && !isNormals(request.normals()))
        return absl::InvalidArgumentError(
            fmt::format("normals is '{}'; give auto, smooth, file, or crease= and degrees from 0 "
                        "to 180, such as crease=40",
                        request.normals()));
    if (kind == v1::OPERATION_KIND_IMPORT_MESH && request.imagery_size() > 0)
        return absl::InvalidArgumentError("imagery is of terrains, and the output is a mesh");
    if (kind == v1::OPERATION_KIND_IMPORT_MESH && request.has_error_metres())
        return absl::InvalidArgumentError("error_metres is of terrains, and the output is a mesh");
    if (request.has_error_metres() && !(request.error_metres() >= kLeastErrorMetres &&
                                        request.error_metres() <= kMostErrorMetres))
        return absl::InvalidArgumentError(
            fmt::format("error_metres is {}; it must be from {} to {}", request.error_metres(),
                        kLeastErrorMetres, kMostErrorMetres));
    return absl::OkStatus();
}

absl::Status checkOutput(const ImportOrder& order, const std::string& name) {
    std::error_code error;
    if (order.replaces || !fs::exists(order.output, error))
        return absl::OkStatus();
    return absl::AlreadyExistsError(
        fmt::format("output '{}' is there already; choose another name, or set replace", name));
}

/// The data and, beside them, what they were made of (cli/source_record.h).
absl::Status moveInto(const fs::path& made, const fs::path& place) {
    std::error_code error;
    for (const char* const ending : {".source", ""}) {
        fs::rename(fabric::nameBeside(made.string(), ending),
                   fabric::nameBeside(place.string(), ending), error);
        if (error)
            return absl::UnavailableError(
                fmt::format("what was made cannot be put in its place: {}", error.message()));
    }
    return absl::OkStatus();
}

/// Of what the program's `--json` says.
Operations::Notes notesOf(const std::string& output, const std::string& made,
                          const std::string& name) {
    google::protobuf::Struct json;
    Operations::Notes notes;
    if (!google::protobuf::util::JsonStringToMessage(output, &json).ok())
        return notes;
    const google::protobuf::Value list =
        json.fields().contains("notes") ? json.fields().at("notes") : google::protobuf::Value();
    for (const google::protobuf::Value& note : list.list_value().values())
        notes.push_back(named(note.string_value(), made, name));
    return notes;
}

}  // namespace

absl::StatusOr<ImportOrder> importOrderOf(const v1::ImportRequest& request,
                                          const access::DataFolder& folder,
                                          std::uint64_t memoryBytes) {
    ImportOrder order;
    const absl::StatusOr<fs::path> output = folder.place(request.output());
    if (!output.ok())
        return fabric::withContext(output.status(), "output");
    order.output = *output;
    const std::string listed = order.output.lexically_relative(folder.path()).string();
    RETURN_IF_ERROR(fabric::withContext(checkIsListed(listed), "output"));
    RETURN_IF_ERROR(fabric::withContext(checkIsInNoReport(listed), "output"));
    ASSIGN_OR_RETURN(order.kind, kindOf(order.output));
    order.replaces = request.replace();
    RETURN_IF_ERROR(checkChoices(request, order.kind));
    RETURN_IF_ERROR(checkOutput(order, request.output()));
    ASSIGN_OR_RETURN(std::vector<std::string> sources,
                     filesOf(request.sources(), "sources", folder));
    ASSIGN_OR_RETURN(const std::vector<std::string> imagery,
                     filesOf(request.imagery(), "imagery", folder));
    if (!request.subdataset().empty())
        for (std::string& source : sources) {
            ASSIGN_OR_RETURN(source, nameOfPart(request.subdataset(), source));
        }
    const bool isTerrain = order.kind == v1::OPERATION_KIND_IMPORT_TERRAIN;
    // Sources come first: what follows --imagery would be more pictures.
    order.arguments = {"import", isTerrain ? "terrain" : "mesh"};
    order.arguments.insert(order.arguments.end(), sources.begin(), sources.end());
    order.arguments.insert(order.arguments.end(), {"--progress-json", "--json",
                                                   "--memory=" + std::to_string(memoryBytes)});
    for (const std::string& each : imagery) order.arguments.push_back("--imagery=" + each);
    if (request.has_error_metres())
        order.arguments.push_back(fmt::format("--error={}", request.error_metres()));
    if (request.orient())
        order.arguments.emplace_back("--orient");
    if (!request.normals().empty())
        order.arguments.push_back("--normals=" + request.normals());
    if (!isTerrain)
        order.arguments.emplace_back("--within=.");  // it is run in the data folder
    return order;
}

absl::StatusOr<Operations::Notes> carryOut(const ImportOrder& order,
                                           const access::DataFolder& folder, const RunProgram& run,
                                           const Operations::Progress& progress,
                                           const std::stop_token& stop) {
    ASSIGN_OR_RETURN(const WorkFolder work, WorkFolder::in(order.output.parent_path(), "import"));
    const fs::path made = work.path() / order.output.filename();
    std::vector<std::string> arguments = order.arguments;
    arguments.push_back("--output=" + made.string());
    const std::string name = order.output.lexically_relative(folder.path()).string();
    const absl::StatusOr<std::string> output =
        runToItsEnd(arguments, folder.path(), run, progress, stop);
    if (!output.ok())
        return absl::Status(output.status().code(),
                            named(std::string(output.status().message()), made.string(), name));
    RETURN_IF_ERROR(checkOutput(order, order.output.filename().string()));
    RETURN_IF_ERROR(moveInto(made, order.output));
    return notesOf(*output, made.string(), name);
}

}  // namespace eyrie::api
