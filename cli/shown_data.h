// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace eyrie::cli {

/// What a service shows: what its command line names, or what programs set.
struct ShownData {
    std::vector<std::string> names;  ///< files and URLs; none: programs set what is shown
    std::string folder;              ///< where programs may name files; empty: nowhere
};

void addShownData(CLI::App& command, ShownData& data);

/// Tells the log who says what is shown where `data` names nothing.
void logWhoShows(const ShownData& data);

}  // namespace eyrie::cli
