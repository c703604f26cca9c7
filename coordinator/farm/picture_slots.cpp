// SPDX-License-Identifier: Apache-2.0
#include "coordinator/farm/picture_slots.h"

#include <algorithm>
#include <utility>

#include "fabric/log.h"

namespace eyrie::coordinator {
namespace {

/// One is drawn into while another's picture waits for the rest of its frame and a third's is
/// composed.
constexpr std::size_t kKept = 3;

/// Pictures grow and shrink with what the link carries; one of a poster's size is not kept for
/// them.
constexpr std::uint64_t kMostTimesTooLarge = 16;

bool fits(std::uint64_t has, std::uint64_t needs) {
    return has >= needs && has / kMostTimesTooLarge <= needs;
}

}  // namespace

std::unique_ptr<wire::PictureMemory> PictureSlots::lend(std::uint64_t bytes) {
    if (bytes < 1 || bytes > wire::PictureMemory::kMaxBytes)
        return nullptr;
    {
        const std::lock_guard lock(mutex_);
        if (!offers_)
            return nullptr;
        const auto found = std::ranges::find_if(
            free_, [&](const auto& memory) { return fits(memory->offer().bytes, bytes); });
        if (found != free_.end()) {
            auto memory = std::move(*found);
            free_.erase(found);
            return memory;
        }
        free_.clear();  // of another size, which is not asked for any more
    }
    auto made = wire::PictureMemory::create(bytes);
    if (made.ok())
        return *std::move(made);
    const std::lock_guard lock(mutex_);
    stopOffering(std::string(made.status().message()));
    return nullptr;
}

void PictureSlots::giveBack(std::unique_ptr<wire::PictureMemory> memory, bool wasUsed) {
    const std::lock_guard lock(mutex_);
    if (!wasUsed)
        stopOffering("it cannot open this process's memory");
    else if (free_.size() < kKept)
        free_.push_back(std::move(memory));
}

std::shared_ptr<const void> PictureSlots::giveBackLater(
    std::unique_ptr<wire::PictureMemory> memory) {
    const auto giveBack = [slots = weak_from_this()](wire::PictureMemory* used) {
        std::unique_ptr<wire::PictureMemory> owned(used);
        if (const auto there = slots.lock())
            there->giveBack(std::move(owned), true);
    };
    return std::shared_ptr<wire::PictureMemory>(memory.release(), giveBack);
}

void PictureSlots::stopOffering(std::string_view why) {
    if (!std::exchange(offers_, false))
        return;
    free_.clear();
    spdlog::info("{}: its pictures come in messages: {}", peer_, why);
}

}  // namespace eyrie::coordinator
