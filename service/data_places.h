// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <absl/status/status.h>
#include <absl/status/statusor.h>

namespace eyrie::service {

/// Where one machine has the data that scenes name: whole paths, folders or URLs, and what stands
/// for them there.
class DataPlaces {
public:
    /// Each of `rules` is FROM=TO; FROM ends at the first "=". Errors: InvalidArgument, naming the
    /// rule: without either side, or of a FROM that another has.
    static absl::StatusOr<DataPlaces> parse(std::span<const std::string> rules);

    /// Has files that no rule is for looked for in `folder` first.
    /// Errors: InvalidArgument, naming it: it is no folder.
    absl::Status lookIn(std::filesystem::path folder);

    /// `path` with the longest FROM that it is, or lies beneath, replaced. Without one, of a file
    /// the longest end of its path that lies in the folder; else as it is.
    std::string placed(std::string_view path) const;

private:
    struct Rule {
        std::string from;
        std::string to;
    };
    std::vector<Rule> rules_;       ///< the longest from first
    std::filesystem::path folder_;  ///< empty: none
};

}  // namespace eyrie::service
