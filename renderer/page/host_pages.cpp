// SPDX-License-Identifier: Apache-2.0
#include "renderer/page/host_pages.h"

#include <algorithm>
#include <limits>
#include <string_view>
#include <utility>

#include "fabric/log.h"

namespace eyrie::page {
namespace {

constexpr std::uint32_t kLowestRank = std::numeric_limits<std::uint32_t>::max() - 1;

std::uint64_t loaderBytes(std::uint64_t limitBytes, std::uint64_t greatestBytes) {
    return std::max(limitBytes / 4, greatestBytes);
}

}  // namespace

HostPages::HostPages(Loader& loader, Loader::Load load, PageFacts facts, std::uint64_t limitBytes,
                     std::uint64_t greatestBytes)
    : facts_(std::move(facts)),
      pages_(limitBytes - loaderBytes(limitBytes, greatestBytes)),
      source_(loader.open(std::move(load), loaderBytes(limitBytes, greatestBytes))) {}

void HostPages::beginFrame() {
    pages_.beginFrame();
    wanted_.clear();
    rankOf_.clear();
    wantedBytes_ = 0;
}

void HostPages::want(std::uint32_t page) {
    if (rankOf_.contains(page) || facts_.bytesOnDisk(page) == 0)
        return;
    wantedBytes_ += bytesOf(page);
    if (wantedBytes_ > pages_.limitBytes())
        return;
    const auto rank = static_cast<std::uint32_t>(wanted_.size());
    wanted_.push_back(page);
    rankOf_.emplace(page, rank);
    pages_.rank(page, rank);
}

bool HostPages::isGivenUp(std::uint32_t page, Clock::time_point time) const {
    const auto failure = failures_.find(page);
    return failure != failures_.end() && failure->second.isGivenUp &&
           time < failure->second.retryAt;
}

std::uint64_t HostPages::bytesOf(std::uint32_t page) const {
    const auto known = knownBytes_.find(page);
    return known != knownBytes_.end() ? known->second : facts_.greatestBytes(page);
}

HostPages::Loads HostPages::keep(std::vector<Arrival> arrivals) {
    Loads loaded;
    for (Arrival& arrival : arrivals) {
        if (!arrival.result.ok()) {
            loaded.hasFailed = true;
            noteFailure(arrival);
            continue;
        }
        ++loaded.pages;
        loaded.bytes += facts_.bytesOnDisk(arrival.page);
        isSourceDown_ = false;
        if (failures_.erase(arrival.page) != 0)
            spdlog::info("{}: page {} can be read again", facts_.path, arrival.page);
        if (const auto since = wishedSince_.find(arrival.page); since != wishedSince_.end()) {
            const std::chrono::duration<double> took = Clock::now() - since->second;
            latency_ += 0.1 * (took - latency_);
            wishedSince_.erase(since);
        }
        const std::uint64_t bytes = arrival.result->bytes;
        knownBytes_[arrival.page] = bytes;
        const auto found = rankOf_.find(arrival.page);
        const std::uint32_t rank = found == rankOf_.end() ? kLowestRank : found->second;
        if (!pages_.contains(arrival.page) && pages_.makeRoom(bytes, rank))
            pages_.insert(arrival.page, arrival.result->value, bytes, rank);
    }
    return loaded;
}

void HostPages::noteFailure(const Arrival& arrival) {
    const absl::Status& status = arrival.result.status();
    std::string message(status.message().data(), status.message().size());
    isSourceDown_ = absl::IsUnavailable(status);
    Failure& failure = failures_[arrival.page];
    failure.retryAt = arrival.retryAt;
    failure.isGivenUp = arrival.isGivenUp;
    if (failure.message == message)
        return;
    spdlog::warn("{}; coarser data stand in for it", message);
    failure.message = std::move(message);
}

std::vector<Wish> HostPages::missing() {
    std::vector<Wish> wishes;
    std::unordered_map<std::uint32_t, Clock::time_point> since;
    for (std::uint32_t rank = 0; rank < wanted_.size(); ++rank) {
        const std::uint32_t page = wanted_[rank];
        if (pages_.contains(page))
            continue;
        wishes.push_back({page, -static_cast<double>(rank), bytesOf(page)});
        const auto known = wishedSince_.find(page);
        since.emplace(page, known == wishedSince_.end() ? Clock::now() : known->second);
    }
    wishedSince_ = std::move(since);
    return wishes;
}

}  // namespace eyrie::page
