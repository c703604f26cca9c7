// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <compare>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <thread>
#include <utility>

#include <absl/status/statusor.h>

#include "fabric/image.h"

namespace eyrie::service {

/// Which picture of all those that renderers send each other.
struct FrameKey {
    std::uint64_t session = 0;
    std::uint64_t frameNumber = 0;
    std::uint32_t frame = 0;

    auto operator<=>(const FrameKey&) const = default;
};

/// "frame 3 of picture 17"; the session is nobody's business.
std::string describe(const FrameKey& key);

/// Pictures on their way from other renderers to the programs of this one. A program announces what
/// it expects; what comes before it was announced is kept for a short time. The bytes held, those
/// still arriving included, are bounded. All functions may be called from any thread.
class Mailbox {
public:
    using Clock = std::chrono::steady_clock;

    struct Limits {
        std::uint64_t bytes = std::uint64_t{1} << 30;
        std::size_t pictures = 1024;  ///< that nobody has announced
        std::chrono::milliseconds unannounced{5000};
        std::chrono::milliseconds arriving{60000};  ///< until a sender is taken to have stalled
    };

    /// A picture that is arriving. It fails, with whoever waits for it, when this goes before
    /// complete was called.
    class Arrival {
    public:
        Arrival(Mailbox& mailbox, const FrameKey& key, std::uint64_t bytes, std::uint64_t number)
            : mailbox_(&mailbox), key_(key), bytes_(bytes), number_(number) {}
        ~Arrival();
        Arrival(Arrival&& other) noexcept
            : mailbox_(std::exchange(other.mailbox_, nullptr)),
              key_(other.key_),
              bytes_(other.bytes_),
              number_(other.number_) {}
        Arrival& operator=(Arrival&&) = delete;

        void complete(fabric::Image image);

    private:
        friend class Mailbox;

        Mailbox* mailbox_;  ///< null: completed, or moved from
        FrameKey key_;
        std::uint64_t bytes_;
        std::uint64_t number_;  ///< of all arrivals
    };

    explicit Mailbox(const Limits& limits);
    ~Mailbox();
    Mailbox(const Mailbox&) = delete;
    Mailbox& operator=(const Mailbox&) = delete;

    /// Where others reach it from now on.
    void setAddress(std::string address);

    /// InvalidArgument for what is sent to another address: it leads here by mistake. What is for
    /// whom is not known before setAddress.
    absl::Status checkAddress(const std::string& to) const;

    /// A program is going to await this picture: within `area`, with depth if `wantsDepth`.
    /// AlreadyExists when another one is; InvalidArgument when it has come and is not like that.
    absl::Status announce(const FrameKey& key, const fabric::PixelViewport& area, bool wantsDepth);

    /// The program has ended: it takes no more pictures.
    void forget(const FrameKey& key);

    /// Waits for an announced picture, which then belongs to the caller. DeadlineExceeded;
    /// Cancelled after `stop`; Unavailable when its sender went away amid it.
    absl::StatusOr<fabric::Image> await(const FrameKey& key, Clock::time_point deadline,
                                        const std::stop_token& stop);

    /// A picture begins to arrive. InvalidArgument when it is not as announced, AlreadyExists when
    /// it has come before, ResourceExhausted beyond the limits. `breakOff` is called, with the
    /// mailbox locked, of one that takes longer than it may: whoever has the Arrival is to drop it.
    absl::StatusOr<Arrival> admit(const FrameKey& key, const fabric::PixelViewport& area,
                                  bool hasDepth, std::function<void()> breakOff = {});

    std::uint64_t bytesHeld() const;

private:
    struct Slot {
        // Of whoever awaits it; none: nobody has announced it yet.
        std::optional<fabric::PixelViewport> announced;
        bool wantsDepth = false;
        // Of what has begun to arrive; none: nothing has.
        std::optional<fabric::PixelViewport> area;
        bool hasDepth = false;
        std::uint64_t arrival = 0;  ///< its number; another's, of a slot of before, is not for this
        std::uint64_t bytes = 0;    ///< of the image, once it is here
        std::optional<absl::StatusOr<fabric::Image>> arrived;
        Clock::time_point since{};
    };
    using Slots = std::map<FrameKey, Slot>;
    struct Arriving {
        Clock::time_point since{};
        std::function<void()> breakOff;
    };

    static absl::Status checkFits(const FrameKey& key, const Slot& slot);
    absl::Status checkRoom(const Slot& slot, std::uint64_t bytes) const;
    void arrive(const Arrival& arrival, absl::StatusOr<fabric::Image> image);
    void erase(Slots::iterator slot);
    void dropUnannounced(Clock::time_point now);
    void breakOffStalled(Clock::time_point now);
    void sweep(const std::stop_token& stop);

    const Limits limits_;
    mutable std::mutex mutex_;  ///< guards what follows, up to the thread
    std::condition_variable_any changed_;
    std::string address_;
    Slots slots_;
    std::uint64_t bytesHeld_ = 0;
    std::uint64_t arrivals_ = 0;
    std::map<std::uint64_t, Arriving> arriving_;  ///< by their numbers
    std::size_t unannounced_ = 0;                 ///< slots
    std::jthread sweeper_;                        ///< drops what nobody announces, and what stalls
};

}  // namespace eyrie::service
