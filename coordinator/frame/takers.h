// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

namespace eyrie::coordinator {

/// Who is asked first for each task of a frame. Counts the renderers that are ready, in the order
/// of their registration, and begins again after the last.
struct Takers {
    /// By task; empty: anybody for all.
    std::vector<std::size_t> preferred;
    /// Renderers that take tasks of one queue, each when it is free, one at a time.
    std::vector<std::vector<std::size_t>> queues = {};
    /// By task, the queue that it is in, in place of what is preferred; may be shorter.
    std::vector<std::optional<std::size_t>> queueOf = {};
};

}  // namespace eyrie::coordinator
