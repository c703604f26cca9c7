// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace eyrie::coordinator {

/// Who is asked first for each task of a frame: renderers by their ids.
struct Takers {
    /// By task; empty: anybody for all.
    std::vector<std::string> preferred;
    /// Renderers that take tasks of one queue, each when it is free, one at a time.
    std::vector<std::vector<std::string>> queues = {};
    /// By task, the queue that it is in, in place of what is preferred; may be shorter.
    std::vector<std::optional<std::size_t>> queueOf = {};
};

}  // namespace eyrie::coordinator
