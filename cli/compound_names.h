// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>

namespace eyrie::cli {

/// What --compound takes, and the layouts of the default configuration that it means.
inline const std::map<std::string, std::string>& compoundNames() {
    static const std::map<std::string, std::string> names = {{"2D", "2D"},
                                                             {"DB", "DB dynamic"},
                                                             {"DB-static", "DB static"},
                                                             {"direct-send", "direct-send"},
                                                             {"DB-2D", "DB-2D"}};
    return names;
}

inline constexpr const char* kCompoundHelp =
    "How renderers share a frame: 2D, by pixels; DB, by data; DB-static, without balancing; "
    "direct-send, by data, merged by the renderers; DB-2D, by data in groups [2D]";

}  // namespace eyrie::cli
