// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <list>
#include <memory>
#include <mutex>

namespace eyrie::pick {

/// Pages of a scene that were read last, within a limit: who points somewhere points beside it
/// next. Apart from the pages that frames need, which it neither sees nor drives out. Any thread.
class RecentPages {
public:
    /// A page of the scene's object of that number.
    struct Key {
        std::uint32_t object = 0;
        std::uint32_t page = 0;

        bool operator==(const Key&) const = default;
    };

    explicit RecentPages(std::uint64_t limitBytes) : limitBytes_(limitBytes) {}

    /// Null when it is not there.
    std::shared_ptr<const void> find(const Key& key);
    /// Drops what was asked for longest ago. A page beyond the limit is not kept.
    void keep(const Key& key, std::shared_ptr<const void> value, std::uint64_t bytes);

private:
    struct Entry {
        Key key;
        std::shared_ptr<const void> value;
        std::uint64_t bytes;
    };

    const std::uint64_t limitBytes_;
    std::mutex mutex_;          ///< guards what follows
    std::list<Entry> entries_;  ///< asked for last comes first; a handful
    std::uint64_t bytes_ = 0;
};

}  // namespace eyrie::pick
