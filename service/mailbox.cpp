// SPDX-License-Identifier: Apache-2.0
#include "service/mailbox.h"

#include <utility>

#include <fmt/format.h>

#include "fabric/status.h"

namespace eyrie::service {
namespace {

std::uint64_t bytesOf(const fabric::PixelViewport& area, bool hasDepth) {
    return static_cast<std::uint64_t>(area.area()) * (hasDepth ? 8 : 4);
}

}  // namespace

std::string describe(const FrameKey& key) {
    return fmt::format("frame {} of picture {}", key.frame, key.frameNumber);
}

Mailbox::Arrival::~Arrival() {
    if (mailbox_ != nullptr)
        mailbox_->arrive(
            *this, absl::UnavailableError(fmt::format(
                       "{} broke off: its sender went away, or took too long", describe(key_))));
}

void Mailbox::Arrival::complete(fabric::Image image) {
    std::exchange(mailbox_, nullptr)->arrive(*this, std::move(image));
}

Mailbox::Mailbox(const Limits& limits)
    : limits_(limits), sweeper_([this](const std::stop_token& stop) { sweep(stop); }) {}

Mailbox::~Mailbox() = default;

void Mailbox::setAddress(std::string address) {
    const std::lock_guard lock(mutex_);
    address_ = std::move(address);
}

absl::Status Mailbox::checkAddress(const std::string& to) const {
    const std::lock_guard lock(mutex_);
    if (address_.empty() || to == address_)
        return absl::OkStatus();
    return absl::InvalidArgumentError(fmt::format(
        "a picture for another renderer came to the one at {}; start renderers with --listen at "
        "addresses that lead to them from everywhere",
        address_));
}

absl::Status Mailbox::announce(const FrameKey& key, const fabric::PixelViewport& area,
                               bool wantsDepth) {
    const std::lock_guard lock(mutex_);
    const auto [found, isNew] = slots_.try_emplace(key);
    Slot& slot = found->second;
    if (slot.announced)
        return absl::AlreadyExistsError(
            fmt::format("another program awaits {} already", describe(key)));
    slot.announced = area;
    slot.wantsDepth = wantsDepth;
    if (isNew)
        return absl::OkStatus();
    --unannounced_;
    const absl::Status fits = checkFits(key, slot);
    if (!fits.ok())
        erase(found);
    return fits;
}

void Mailbox::forget(const FrameKey& key) {
    const std::lock_guard lock(mutex_);
    if (const auto found = slots_.find(key); found != slots_.end() && found->second.announced)
        erase(found);
}

absl::StatusOr<fabric::Image> Mailbox::await(const FrameKey& key, Clock::time_point deadline,
                                             const std::stop_token& stop) {
    std::unique_lock lock(mutex_);
    const auto found = slots_.find(key);
    if (found == slots_.end() || !found->second.announced)
        return absl::InternalError(fmt::format("{} was not announced", describe(key)));
    // The slot stays: only its program, which waits here, forgets it.
    const bool came = changed_.wait_until(lock, stop, deadline,
                                          [&] { return found->second.arrived.has_value(); });
    if (stop.stop_requested())
        return absl::CancelledError("nobody waits for this program's answer any more");
    if (!came)
        return absl::DeadlineExceededError(fmt::format("{} has not come in time", describe(key)));
    absl::StatusOr<fabric::Image> image = *std::move(found->second.arrived);
    erase(found);
    return image;
}

absl::StatusOr<Mailbox::Arrival> Mailbox::admit(const FrameKey& key,
                                                const fabric::PixelViewport& area, bool hasDepth,
                                                std::function<void()> breakOff) {
    const std::lock_guard lock(mutex_);
    const auto known = slots_.find(key);
    if (known != slots_.end() && known->second.area)
        return absl::AlreadyExistsError(fmt::format("{} has come before", describe(key)));
    Slot slot = known != slots_.end() ? known->second : Slot();
    slot.area = area;
    slot.hasDepth = hasDepth;
    const std::uint64_t bytes = bytesOf(area, hasDepth);
    RETURN_IF_ERROR(checkFits(key, slot));
    RETURN_IF_ERROR(checkRoom(slot, bytes));
    bytesHeld_ += bytes;
    slot.arrival = ++arrivals_;
    slot.since = Clock::now();
    if (!slot.announced)
        ++unannounced_;
    arriving_[arrivals_] = {slot.since, std::move(breakOff)};
    slots_.insert_or_assign(key, std::move(slot));
    changed_.notify_all();
    return Arrival(*this, key, bytes, arrivals_);
}

std::uint64_t Mailbox::bytesHeld() const {
    const std::lock_guard lock(mutex_);
    return bytesHeld_;
}

absl::Status Mailbox::checkFits(const FrameKey& key, const Slot& slot) {
    if (!slot.announced || !slot.area || slot.area->isEmpty())
        return absl::OkStatus();
    const fabric::PixelViewport& is = *slot.area;
    const fabric::PixelViewport& whole = *slot.announced;
    if (!whole.contains(is))
        return absl::InvalidArgumentError(fmt::format(
            "{} is {}x{} at {},{}, outside the {}x{} at {},{} that were announced", describe(key),
            is.width, is.height, is.x, is.y, whole.width, whole.height, whole.x, whole.y));
    if (slot.wantsDepth && !slot.hasDepth)
        return absl::InvalidArgumentError(
            fmt::format("{} has no depth, but is to be merged by it", describe(key)));
    return absl::OkStatus();
}

absl::Status Mailbox::checkRoom(const Slot& slot, std::uint64_t bytes) const {
    if (bytes > limits_.bytes || bytesHeld_ > limits_.bytes - bytes)
        return absl::ResourceExhaustedError(
            fmt::format("{} bytes of pictures are waiting here, {} more are above the limit of {}",
                        bytesHeld_, bytes, limits_.bytes));
    if (!slot.announced && unannounced_ >= limits_.pictures)
        return absl::ResourceExhaustedError(
            fmt::format("{} pictures are waiting here that nobody has announced", unannounced_));
    return absl::OkStatus();
}

void Mailbox::arrive(const Arrival& arrival, absl::StatusOr<fabric::Image> image) {
    {
        const std::lock_guard lock(mutex_);
        arriving_.erase(arrival.number_);
        const auto found = slots_.find(arrival.key_);
        const bool isAwaited = found != slots_.end() && found->second.arrival == arrival.number_;
        if (!isAwaited || !image.ok())
            bytesHeld_ -= arrival.bytes_;
        if (!isAwaited)
            return;  // Forgotten meanwhile.
        found->second.bytes = image.ok() ? arrival.bytes_ : 0;
        found->second.arrived = std::move(image);
    }
    changed_.notify_all();
}

void Mailbox::erase(Slots::iterator slot) {
    bytesHeld_ -= slot->second.bytes;
    slots_.erase(slot);
}

void Mailbox::dropUnannounced(Clock::time_point now) {
    for (auto slot = slots_.begin(); slot != slots_.end();) {
        const auto next = std::next(slot);
        if (!slot->second.announced && slot->second.since <= now - limits_.unannounced) {
            --unannounced_;
            erase(slot);
        }
        slot = next;
    }
}

void Mailbox::breakOffStalled(Clock::time_point now) {
    for (auto& [number, arriving] : arriving_)
        if (arriving.breakOff && arriving.since <= now - limits_.arriving)
            std::exchange(arriving.breakOff, nullptr)();
}

void Mailbox::sweep(const std::stop_token& stop) {
    const auto isIdle = [this] { return unannounced_ == 0 && arriving_.empty(); };
    std::unique_lock lock(mutex_);
    while (!stop.stop_requested()) {
        if (isIdle())
            changed_.wait(lock, stop, [&] { return !isIdle(); });
        else
            changed_.wait_for(lock, stop, limits_.unannounced, [] { return false; });
        const Clock::time_point now = Clock::now();
        dropUnannounced(now);
        breakOffStalled(now);
    }
}

}  // namespace eyrie::service
