// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <list>
#include <memory>
#include <mutex>

namespace eyrie::pick {

/// Pages that were read last, within a limit: who points somewhere points beside it next. Apart
/// from the pages that frames need, which it neither sees nor drives out. Any thread.
class RecentPages {
public:
    explicit RecentPages(std::uint64_t limitBytes) : limitBytes_(limitBytes) {}

    /// Null when it is not there.
    std::shared_ptr<const void> find(std::uint32_t page);
    /// Drops what was asked for longest ago. A page beyond the limit is not kept.
    void keep(std::uint32_t page, std::shared_ptr<const void> value, std::uint64_t bytes);

private:
    struct Entry {
        std::uint32_t page;
        std::shared_ptr<const void> value;
        std::uint64_t bytes;
    };

    const std::uint64_t limitBytes_;
    std::mutex mutex_;          ///< guards what follows
    std::list<Entry> entries_;  ///< asked for last comes first; a handful
    std::uint64_t bytes_ = 0;
};

}  // namespace eyrie::pick
