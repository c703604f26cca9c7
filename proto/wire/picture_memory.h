// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include <absl/status/statusor.h>

#include "fabric/delivery.h"
#include "fabric/image.h"

namespace eyrie::wire {

/// How another process of this machine finds a PictureMemory, and knows it for that one.
struct MemoryOffer {
    std::int32_t process = 0;
    std::int32_t descriptor = -1;  ///< of the process
    std::uint64_t bytes = 0;       ///< of pixels
    std::string key;               ///< random

    bool operator==(const MemoryOffer&) const = default;
};

/// Memory that two processes of one machine see, for the pixels of one picture: colour, then depth,
/// as they lie in memory.
///
/// A memory file without a name, so that nothing is left of it when both have ended, however they
/// did; its size is sealed, so that neither can take pages away beneath the other. Who may write is
/// a matter between the two: the file does not tell.
class PictureMemory {
public:
    static constexpr std::uint64_t kMaxBytes = std::uint64_t{1} << 28;

    /// For a picture of `bytes`, 1 to kMaxBytes. ResourceExhausted where the system has none.
    static absl::StatusOr<std::unique_ptr<PictureMemory>> create(std::uint64_t bytes);

    /// That of another process, or of this one. Believes nothing of the offer: FailedPrecondition
    /// unless there is a memory file of that size, sealed, of this user, with that key in it.
    static absl::StatusOr<std::unique_ptr<PictureMemory>> open(const MemoryOffer& offer);

    ~PictureMemory();
    PictureMemory(const PictureMemory&) = delete;
    PictureMemory& operator=(const PictureMemory&) = delete;

    /// Valid while this lives; of one that was opened, what it was opened by.
    const MemoryOffer& offer() const { return offer_; }

    /// Where a picture's pixels go; nothing where they are more than it holds. Of one that was
    /// opened: whoever made it may read only.
    std::optional<fabric::PixelRoom> room(const fabric::PixelViewport& area, bool withDepth) const;

    /// Copies a picture in. False, and nothing done, where it is larger than the memory.
    bool put(const fabric::Image& picture);

    /// The picture in it, of `area`, of any bits; an error where it would be larger than the
    /// memory. The other process may go on writing.
    absl::StatusOr<fabric::ImageView> picture(const fabric::PixelViewport& area,
                                              bool hasDepth) const;

private:
    PictureMemory(MemoryOffer offer, int descriptor, std::byte* begin);

    std::byte* pixels() const;

    const MemoryOffer offer_;
    const int descriptor_;  ///< -1: none is needed any more
    std::byte* const begin_;
};

}  // namespace eyrie::wire
