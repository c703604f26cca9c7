// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <list>
#include <memory>

#include "wire/picture_memory.h"

namespace eyrie::service {

/// Memory that callers have offered for pictures and that could be opened, the latest few. For one
/// thread.
class PictureMemories {
public:
    /// A caller has two; those before are kept no longer than this.
    static constexpr std::size_t kKept = 3;

    /// Null where it cannot be opened. Valid until the next call.
    wire::PictureMemory* find(const wire::MemoryOffer& offer);

private:
    std::list<std::unique_ptr<wire::PictureMemory>> opened_;  ///< the last used first
};

}  // namespace eyrie::service
