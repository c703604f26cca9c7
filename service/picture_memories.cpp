// SPDX-License-Identifier: Apache-2.0
#include "service/picture_memories.h"

#include <algorithm>
#include <utility>

#include "fabric/log.h"

namespace eyrie::service {

wire::PictureMemory* PictureMemories::find(const wire::MemoryOffer& offer) {
    const auto found =
        std::ranges::find_if(opened_, [&](const auto& memory) { return memory->offer() == offer; });
    if (found != opened_.end()) {
        opened_.splice(opened_.begin(), opened_, found);
        return opened_.front().get();
    }
    auto memory = wire::PictureMemory::open(offer);
    if (!memory.ok()) {
        spdlog::debug("pictures go in messages: {}", std::string(memory.status().message()));
        return nullptr;
    }
    opened_.push_front(*std::move(memory));
    if (opened_.size() > kKept)
        opened_.pop_back();
    return opened_.front().get();
}

}  // namespace eyrie::service
