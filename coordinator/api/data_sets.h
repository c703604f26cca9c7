// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <mutex>
#include <stop_token>
#include <string>
#include <string_view>
#include <vector>

#include <absl/status/statusor.h>

#include "access/data_folder.h"
#include "coordinator/api/programs.h"
#include "eyrie/v1/data_set.pb.h"

namespace eyrie::api {

/// What `eyrie info --json` prints of a file, as a message; DataLoss where that is something else.
absl::StatusOr<v1::DataSet> dataSetOf(const std::string& json);

/// InvalidArgument unless DataSets lists a data set of that name, once it is there: of its at most
/// 16 parts none begins with a dot, as names of unfinished files and of folders of work do.
absl::Status checkIsListed(std::string_view name);

/// The imported files in a data folder. Each is looked into by another process, once while it stays
/// as it is. All functions may be called from any thread.
class DataSets {
public:
    static constexpr std::size_t kMost = 1000;

    /// Both outlive this.
    DataSets(const access::DataFolder& folder, const RunProgram& run)
        : folder_(folder), run_(run) {}

    /// By path, those hidden, too deep (checkIsListed) and behind links left out. Takes as long as
    /// looking into what is new. Cancelled after `stop`; Unavailable where the folder cannot be
    /// read.
    absl::StatusOr<std::vector<v1::DataSet>> list(const std::stop_token& stop);

    /// Of the file of that name. Errors as list().
    absl::StatusOr<v1::DataSet> look(const std::string& name, const std::stop_token& stop);

private:
    struct Version {
        std::uintmax_t bytes = 0;
        std::filesystem::file_time_type written = {};
        bool operator==(const Version&) const = default;
    };
    struct Seen {
        v1::DataSet dataSet;
        bool isOfTheFile;  ///< and not of the moment: it is the same the next time
    };
    struct Known {
        Version version;
        v1::DataSet dataSet;
    };

    absl::StatusOr<std::vector<std::string>> names() const;
    absl::StatusOr<Seen> ask(const std::string& name, const std::stop_token& stop) const;

    const access::DataFolder& folder_;
    const RunProgram& run_;
    std::mutex mutex_;  ///< guards what follows
    std::map<std::string, Known> known_;
};

}  // namespace eyrie::api
