// SPDX-License-Identifier: Apache-2.0
#include "coordinator/api/data_sets.h"

#include <algorithm>
#include <iterator>
#include <system_error>
#include <utility>

#include <fmt/format.h>
#include <google/protobuf/struct.pb.h>
#include <google/protobuf/util/json_util.h>

#include "coordinator/stream/viewer_messages.h"
#include "fabric/status.h"

namespace eyrie::api {
namespace {

namespace fs = std::filesystem;
using google::protobuf::Struct;
using google::protobuf::Value;

constexpr int kMaxDepth = 16;
constexpr int kWrongInput = 2;  ///< exit status

Value valueOf(const Struct& json, const char* name) {
    const auto found = json.fields().find(name);
    return found == json.fields().end() ? Value() : found->second;
}

std::int64_t countOf(const Struct& json, const char* name) {
    const double count = valueOf(json, name).number_value();
    return count >= 0 && count < 9e18 ? static_cast<std::int64_t>(count) : 0;
}

void setCorner(const Struct& bounds, const char* name, v1::Vector3& corner) {
    const Value list = valueOf(bounds, name);
    if (list.list_value().values_size() != 3)
        return;
    corner.set_x(list.list_value().values(0).number_value());
    corner.set_y(list.list_value().values(1).number_value());
    corner.set_z(list.list_value().values(2).number_value());
}

bool isHidden(const fs::path& name) { return name.filename().string().starts_with('.'); }

bool isDataSet(const fs::path& path) {
    return path.extension() == ".eyt" || path.extension() == ".eym";
}

}  // namespace

absl::Status checkIsListed(std::string_view name) {
    const fs::path path(name);
    if (const auto hidden = std::ranges::find_if(path, isHidden); hidden != path.end())
        return absl::InvalidArgumentError(
            fmt::format("data name '{}' has the part '{}', and what begins with a dot is taken for "
                        "unfinished and not listed; choose a name without such a part",
                        name, hidden->string()));
    if (std::distance(path.begin(), path.end()) > kMaxDepth)
        return absl::InvalidArgumentError(
            fmt::format("data name '{}' has more than {} parts, and what lies that deep is not "
                        "listed; choose a folder further up",
                        name, kMaxDepth));
    return absl::OkStatus();
}

absl::StatusOr<v1::DataSet> dataSetOf(const std::string& json) {
    Struct facts;
    if (!google::protobuf::util::JsonStringToMessage(json, &facts).ok())
        return absl::DataLossError("what was said of the file cannot be read");
    v1::DataSet set;
    const std::string kind = valueOf(facts, "kind").string_value();
    if (kind == "terrain")
        set.set_kind(v1::DATA_SET_KIND_TERRAIN);
    else if (kind == "mesh")
        set.set_kind(v1::DATA_SET_KIND_MESH);
    else
        return absl::DataLossError("the file is neither terrain nor mesh");
    const Value bounds = valueOf(facts, "bounds");
    setCorner(bounds.struct_value(), "min", *set.mutable_bounds()->mutable_min());
    setCorner(bounds.struct_value(), "max", *set.mutable_bounds()->mutable_max());
    set.set_bytes(countOf(facts, "bytes"));
    set.set_samples(countOf(facts, "samples"));
    set.set_triangles(countOf(facts, "triangles"));
    set.set_levels(static_cast<std::int32_t>(std::min<std::int64_t>(64, countOf(facts, "levels"))));
    set.set_crs(valueOf(facts, "crs").string_value());
    const Value errors = valueOf(facts, "errorMetres");
    set.set_coarsest_error_metres(valueOf(errors.struct_value(), "coarsest").number_value());
    set.set_finest_error_metres(valueOf(errors.struct_value(), "finest").number_value());
    return set;
}

absl::StatusOr<std::vector<v1::DataSet>> DataSets::list(const std::stop_token& stop) {
    std::vector<v1::DataSet> sets;
    ASSIGN_OR_RETURN(const std::vector<std::string> there, names());
    for (const std::string& name : there) {
        ASSIGN_OR_RETURN(v1::DataSet set, look(name, stop));
        sets.push_back(std::move(set));
    }
    return sets;
}

absl::StatusOr<std::vector<std::string>> DataSets::names() const {
    RETURN_IF_ERROR(folder_.check());
    std::vector<std::string> names;
    std::error_code error;
    fs::recursive_directory_iterator at(folder_.path(),
                                        fs::directory_options::skip_permission_denied, error);
    for (; !error && at != fs::recursive_directory_iterator() && names.size() < kMost;
         at.increment(error)) {
        std::error_code ignored;
        if (isHidden(at->path()) || at.depth() >= kMaxDepth)
            at.disable_recursion_pending();
        else if (isDataSet(at->path()) && !at->is_symlink(ignored) && at->is_regular_file(ignored))
            names.push_back(at->path().lexically_relative(folder_.path()).string());
    }
    if (error)  // part of a list would look like all of it
        return absl::UnavailableError(
            fmt::format("the data folder cannot be read: {}; try again in a bit", error.message()));
    // Some could not be named in a scene either.
    std::erase_if(names, [](const std::string& name) { return !access::checkDataName(name).ok(); });
    std::ranges::sort(names);
    return names;
}

absl::StatusOr<v1::DataSet> DataSets::look(const std::string& name, const std::stop_token& stop) {
    std::error_code error;
    const Version version{fs::file_size(folder_.path() / name, error),
                          fs::last_write_time(folder_.path() / name, error)};
    {
        const std::lock_guard lock(mutex_);
        const auto known = known_.find(name);
        if (known != known_.end() && known->second.version == version)
            return known->second.dataSet;
    }
    ASSIGN_OR_RETURN(Seen seen, ask(name, stop));
    seen.dataSet.set_path(name);
    const std::lock_guard lock(mutex_);
    if (known_.size() > 2 * kMost)
        known_.clear();  // of files that came and went
    if (seen.isOfTheFile)
        known_[name] = {version, seen.dataSet};
    return seen.dataSet;
}

absl::StatusOr<DataSets::Seen> DataSets::ask(const std::string& name,
                                             const std::stop_token& stop) const {
    LastWords words;
    ASSIGN_OR_RETURN(const ProgramEnd end,
                     run_(
                         {"info", "--json", "./" + name}, folder_.path(),
                         [&](std::string_view line) { words.hear(line); }, stop));
    if (stop.stop_requested())
        return absl::CancelledError("the caller has gone");
    absl::Status status = words.statusOf(end);
    if (status.ok()) {
        absl::StatusOr<v1::DataSet> set = dataSetOf(end.output);
        if (set.ok())
            return Seen{*std::move(set), true};
        status = set.status();
    }
    v1::DataSet damaged;
    damaged.set_problem(stream::sanitised({status.message().data(), status.message().size()}));
    return Seen{std::move(damaged), !end.crashed && end.code == kWrongInput};
}

}  // namespace eyrie::api
