// SPDX-License-Identifier: Apache-2.0
#include "coordinator/api/bench_order.h"

#include <array>
#include <cctype>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "coordinator/api/bench_reports.h"
#include "coordinator/api/flight_files.h"
#include "coordinator/api/replace_file.h"
#include "coordinator/api/work_folder.h"
#include "fabric/frame_data.h"
#include "fabric/status.h"
#include "wire/json.h"
#include "wire/scene.h"

namespace eyrie::api {
namespace {

namespace fs = std::filesystem;

constexpr int kMaxRuns = 16;

/// `given` or, where it is absent, `usual`.
absl::StatusOr<int> number(bool isGiven, int given, int usual, const char* field, int least,
                           int most) {
    const int value = isGiven ? given : usual;
    if (value >= least && value <= most)
        return value;
    return absl::InvalidArgumentError(
        fmt::format("{} is {}; it must be from {} to {}", field, value, least, most));
}

using Numbers = google::protobuf::RepeatedField<double>;

absl::StatusOr<std::string> listOf(const Numbers& numbers, const char* field, double least,
                                   double most) {
    if (numbers.size() > kMaxRuns)
        return absl::InvalidArgumentError(fmt::format("{} has {} numbers; at most {} are taken",
                                                      field, numbers.size(), kMaxRuns));
    std::string list;
    for (int i = 0; i < numbers.size(); ++i) {
        if (!(numbers[i] >= least && numbers[i] <= most))
            return absl::InvalidArgumentError(fmt::format("{}[{}] is {}; it must be from {} to {}",
                                                          field, i, numbers[i], least, most));
        list += fmt::format("{}{}", list.empty() ? "" : ",", numbers[i]);
    }
    return list;
}

/// Of what is measured, for the command line.
absl::Status addFigures(const v1::BenchRequest& request, std::vector<std::string>& arguments) {
    ASSIGN_OR_RETURN(const std::string taus, listOf(request.tau_pixels(), "tau_pixels",
                                                    fabric::kMinTauPixels, fabric::kMaxTauPixels));
    ASSIGN_OR_RETURN(const std::string budgets,
                     listOf(request.budget_milliseconds(), "budget_milliseconds", 1, 10'000));
    ASSIGN_OR_RETURN(const int width,
                     number(request.has_width(), request.width(), 1280, "width", 16, 4096));
    ASSIGN_OR_RETURN(const int height,
                     number(request.has_height(), request.height(), 720, "height", 16, 4096));
    ASSIGN_OR_RETURN(const int frames,
                     number(request.has_frames(), request.frames(), 120, "frames", 1, 10'000));
    ASSIGN_OR_RETURN(const int repeats,
                     number(request.has_repeats(), request.repeats(), 5, "repeats", 1, 100));
    ASSIGN_OR_RETURN(const int renderers, number(true, request.renderers(), 0, "renderers", 0, 8));
    if (!taus.empty())
        arguments.push_back("--tau=" + taus);
    if (!budgets.empty())
        arguments.push_back("--budget-ms=" + budgets);
    arguments.push_back(fmt::format("--size={}x{}", width, height));
    arguments.push_back(fmt::format("--frames={}", frames));
    arguments.push_back(fmt::format("--repeats={}", repeats));
    arguments.push_back(fmt::format("--renderers={}", renderers));
    return absl::OkStatus();
}

absl::Status addReference(const v1::BenchRequest& request, std::uint64_t memoryBytes,
                          BenchOrder& order) {
    ASSIGN_OR_RETURN(const int frames,
                     number(request.has_reference_frames(), request.reference_frames(), 6,
                            "reference_frames", 1, 1000));
    order.measuresErrors = request.with_reference();
    if (!order.measuresErrors)
        return absl::OkStatus();
    order.arguments.emplace_back("--reference");
    order.arguments.push_back(fmt::format("--reference-frames={}", frames));
    order.arguments.push_back(fmt::format("--reference-memory={}", memoryBytes));
    return absl::OkStatus();
}

absl::Status addFlight(const std::string& name, const access::DataFolder& folder,
                       BenchOrder& order) {
    if (name.empty() || isBuiltInFlight(name)) {
        order.arguments.push_back("--flight=" + (name.empty() ? "orbit" : name));
        return absl::OkStatus();
    }
    const absl::StatusOr<v1::Flight> flight = readFlight(folder, name);
    if (!flight.ok())
        return fabric::withContext(flight.status(), "flight");
    order.flightName = fmt::format("{}{}.json", kFlightFileBegin, name);
    order.flightJson = wire::toJson(*flight);
    order.arguments.push_back("--flight=" + order.flightName);
    return absl::OkStatus();
}

absl::StatusOr<fs::path> placeOf(const v1::BenchRequest& request,
                                 const access::DataFolder& folder) {
    if (fs::path(request.output()).extension() != kReportEnding)
        return absl::InvalidArgumentError(fmt::format(
            "output is '{}'; it must be a name and {}, such as orbit{}",
            fs::path(request.output()).filename().string(), kReportEnding, kReportEnding));
    const absl::StatusOr<fs::path> before = folder.existing(request.output());
    if (before.ok() && !request.replace())
        return absl::AlreadyExistsError(fmt::format(
            "output '{}' is there already; choose another name, or set replace", request.output()));
    if (before.ok()) {
        RETURN_IF_ERROR(fabric::withContext(checkIsReport(*before, request.output()), "output"));
        return *before;
    }
    const absl::StatusOr<fs::path> place = folder.place(request.output());
    return place.ok() ? place : fabric::withContext(place.status(), "output");
}

absl::Status write(const fs::path& path, const std::string& text, Readers readers) {
    return replaceFile(path, text, readers)
               ? absl::UnavailableError(
                     "nothing can be written beside the output; see that the data folder is "
                     "writable and not full")
               : absl::OkStatus();
}

absl::Status cannotBePlaced(const std::error_code& error) {
    return absl::UnavailableError(
        fmt::format("the report cannot be put in its place: {}", error.message()));
}

/// `before` to where it was moved from, since `why`. Where that cannot be, it stays in `work`.
absl::Status putBack(const fs::path& before, const fs::path& place, absl::Status why,
                     WorkFolder& work) {
    std::error_code error;
    fs::rename(before, place, error);
    if (!error)
        return why;
    work.leave();
    return absl::UnavailableError(
        fmt::format("{}; what was there is '{}/{}' beside it now", std::string(why.message()),
                    work.path().filename().string(), before.filename().string()));
}

/// `made` into the place of what is there, which goes with `work` where it is a report.
absl::Status exchange(const fs::path& made, const fs::path& place, WorkFolder& work) {
    const fs::path before = work.path() / "before";
    std::error_code error;
    fs::rename(place, before, error);
    if (error)
        return cannotBePlaced(error);
    // What has come since the order was taken is looked for where nobody puts more any longer.
    absl::Status status =
        fabric::withContext(checkIsReport(before, place.filename().string()), "output");
    if (!status.ok())
        return putBack(before, place, std::move(status), work);
    fs::rename(made, place, error);
    return error ? putBack(before, place, cannotBePlaced(error), work) : absl::OkStatus();
}

absl::Status moveInto(const fs::path& made, const BenchOrder& order, WorkFolder& work) {
    std::error_code error;
    const bool isThere = fs::exists(fs::symlink_status(order.output, error));
    if (isThere && !order.replaces)
        return absl::AlreadyExistsError(
            fmt::format("output '{}' is there by now; choose another name, or set replace",
                        order.output.filename().string()));
    if (isThere)
        return exchange(made, order.output, work);
    fs::rename(made, order.output, error);
    return error ? cannotBePlaced(error) : absl::OkStatus();
}

/// What `eyrie bench` advises, and what of that the caller can do.
constexpr std::array<std::pair<std::string_view, std::string_view>, 5> kAdvice = {
    {{", or name the source's files with --source", ""},
     {", or name what it was with --source", ""},
     {"--reference-memory", "--import-memory of the server"},
     {"--reference-frames", "referenceFrames"},
     {"a smaller --size", "a smaller width and height"}}};

/// With names in the folder for paths below it: where those begin, not within addresses of others.
std::string withoutFolder(std::string text, const std::string& folder) {
    const auto isOfAName = [](char c) {
        return std::isalnum(static_cast<unsigned char>(c)) != 0 ||
               std::string_view("/.-_:~%").find(c) != std::string_view::npos;
    };
    for (std::size_t at = text.find(folder); at != std::string::npos; at = text.find(folder, at))
        if (at > 0 && isOfAName(text[at - 1]))
            ++at;
        else
            text.erase(at, folder.size());
    return text;
}

/// What the program says that made `report`, in the caller's terms: where the data folder is nobody
/// is told.
absl::Status inCallersTerms(const absl::Status& status, const fs::path& report,
                            const fs::path& output, const access::DataFolder& folder) {
    std::string text(status.message());
    text = named(std::move(text), report.string(), output.string());
    text = withoutFolder(std::move(text), (folder.path() / "").string());
    for (const auto& [advice, possible] : kAdvice) text = named(std::move(text), advice, possible);
    return {status.code(), text};
}

}  // namespace

absl::StatusOr<BenchOrder> benchOrderOf(const v1::BenchRequest& request,
                                        const access::DataFolder& folder,
                                        const fabric::Scene& scene, std::uint64_t memoryBytes) {
    BenchOrder order;
    ASSIGN_OR_RETURN(order.output, placeOf(request, folder));
    RETURN_IF_ERROR(fabric::withContext(
        checkIsInNoReport(order.output.lexically_relative(folder.path())), "output"));
    order.replaces = request.replace();
    if (scene.objects.empty())
        return absl::FailedPreconditionError("scene is absent, and nothing is drawn now; name one");
    order.sceneJson = wire::toJson(wire::toMessage(scene));
    order.arguments = {"bench", std::string(kSceneFile), "--quiet", "--progress-json",
                       "--output=."};
    RETURN_IF_ERROR(addFlight(request.flight(), folder, order));
    RETURN_IF_ERROR(addFigures(request, order.arguments));
    RETURN_IF_ERROR(addReference(request, memoryBytes, order));
    return order;
}

absl::Status carryOut(const BenchOrder& order, const access::DataFolder& folder,
                      const RunProgram& run, const Operations::Progress& progress,
                      const std::stop_token& stop) {
    ASSIGN_OR_RETURN(WorkFolder work, WorkFolder::in(order.output.parent_path(), "bench"));
    const fs::path report = work.path() / "report";
    std::error_code error;
    fs::create_directory(report, error);
    RETURN_IF_ERROR(write(report / kSceneFile, order.sceneJson, Readers::OwnerAlone));
    if (!order.flightName.empty())
        RETURN_IF_ERROR(write(report / order.flightName, order.flightJson, Readers::Others));
    const absl::Status end =
        inCallersTerms(runToItsEnd(order.arguments, report, run, progress, stop).status(), report,
                       order.output, folder);
    const bool isWhole =  // the summary is written last
        end.ok() || (order.measuresErrors && !stop.stop_requested() &&
                     fs::exists(report / fileNameOf(v1::REPORT_FILE_SUMMARY), error));
    if (isWhole)
        RETURN_IF_ERROR(moveInto(report, order, work));
    return end;
}

}  // namespace eyrie::api
