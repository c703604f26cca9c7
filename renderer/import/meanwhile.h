// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <utility>

#include <oneapi/tbb/task_arena.h>
#include <oneapi/tbb/task_group.h>

namespace eyrie::import {

/// Work for cores that would wait otherwise: other tasks go first, until somebody waits for it.
/// What the work uses must outlive this. Belongs to the thread that made it.
class Meanwhile {
public:
    template <typename Work>
    explicit Meanwhile(Work work) {
        arena_.execute([&] { group_.run(std::move(work)); });
    }
    Meanwhile(const Meanwhile&) = delete;
    Meanwhile& operator=(const Meanwhile&) = delete;
    ~Meanwhile() {
        try {
            wait();
        } catch (...) {
            // Whoever did not wait is leaving for a reason of its own.
        }
    }

    /// Until the work is done, with a hand from this thread. Throws what the work threw.
    void wait() {
        arena_.execute([this] { group_.wait(); });
    }

private:
    oneapi::tbb::task_arena arena_{oneapi::tbb::task_arena::automatic, 1,
                                   oneapi::tbb::task_arena::priority::low};
    oneapi::tbb::task_group group_;
};

}  // namespace eyrie::import
