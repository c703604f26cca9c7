// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "wire/picture_memory.h"

namespace eyrie::coordinator {

/// Memory that one renderer puts its pictures into, if it is on this machine: each is the
/// renderer's from when it is lent until it is given back. One that does not come back in order,
/// because the call failed and the renderer may write yet, goes: nobody reads what is written then.
/// All functions may be called from any thread.
class PictureSlots : public std::enable_shared_from_this<PictureSlots> {
public:
    /// `peer` is for the log.
    explicit PictureSlots(std::string peer) : peer_(std::move(peer)) {}

    /// For a picture of `bytes` at most; null where pictures are to come in messages.
    std::unique_ptr<wire::PictureMemory> lend(std::uint64_t bytes);

    /// After a call that ended well. A renderer that did not use it (`wasUsed`) is offered no more,
    /// and the log says so, once.
    void giveBack(std::unique_ptr<wire::PictureMemory> memory, bool wasUsed);

    /// The same, of one that was used, when what is returned and its copies are gone: while
    /// somebody still reads the picture. Precondition: a shared pointer has this.
    std::shared_ptr<const void> giveBackLater(std::unique_ptr<wire::PictureMemory> memory);

private:
    void stopOffering(std::string_view why);

    const std::string peer_;
    std::mutex mutex_;  ///< guards what follows
    std::vector<std::unique_ptr<wire::PictureMemory>> free_;
    bool offers_ = true;
};

}  // namespace eyrie::coordinator
