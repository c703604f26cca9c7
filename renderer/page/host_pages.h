// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <stop_token>
#include <string>
#include <unordered_map>
#include <vector>

#include "renderer/page/loader.h"
#include "renderer/page/resident_set.h"

namespace eyrie::page {

/// What the pages of a file are like.
struct PageFacts {
    std::string path;                                           ///< for the log
    std::function<std::uint64_t(std::uint32_t)> greatestBytes;  ///< that it may take in memory
    std::function<std::uint64_t(std::uint32_t)> bytesOnDisk;    ///< 0: it has none
};

/// The pages of one file that are in memory or on their way there, within a limit. One thread.
///
/// Each frame ranks the pages it wants, the most wanted first; those are wished for that are not
/// there. A page that cannot be read is logged once, and tried again by the loader.
class HostPages {
public:
    using Clock = std::chrono::steady_clock;

    /// What was read of the file.
    struct Loads {
        std::uint64_t pages = 0;
        std::uint64_t bytes = 0;  ///< as they lie in the file
        bool hasFailed = false;   ///< a page could not be read

        void add(const Loads& other) {
            pages += other.pages;
            bytes += other.bytes;
            hasFailed = hasFailed || other.hasFailed;
        }
    };

    /// A quarter of `limitBytes`, but room for one page of `greatestBytes`, is for pages that are
    /// being loaded or wait to be taken. The loader outlives this. Precondition: limitBytes is at
    /// least twice greatestBytes.
    HostPages(Loader& loader, Loader::Load load, PageFacts facts, std::uint64_t limitBytes,
              std::uint64_t greatestBytes);

    /// Nothing is wanted.
    void beginFrame();
    /// The next most wanted page, as long as there is room. Pages are ranked before any is kept.
    void want(std::uint32_t page);

    /// Takes what has come. What tries never waits for the loader's threads, and may do nothing.
    Loads take() { return keep(source_->take()); }
    Loads tryTake() { return keep(source_->tryTake()); }
    /// Wishes for what is wanted and not there.
    void wish() { source_->wish(missing()); }
    void tryWish() { source_->tryWish(missing()); }
    /// Loader::Source::wait.
    bool wait(const std::stop_token& stop) { return source_->wait(stop); }

    /// Null when it is not there. Valid until pages are taken.
    const std::shared_ptr<const void>* find(std::uint32_t page) { return pages_.find(page); }
    /// Whether it has failed for good, for now, and the next attempt comes after `time`.
    bool isGivenUp(std::uint32_t page, Clock::time_point time) const;
    /// Whether it cannot be read now: its last attempt failed, or its source is unavailable.
    bool isFailing(std::uint32_t page) const { return isSourceDown_ || failures_.contains(page); }

    /// From a page's first wish to its arrival, averaged over the last ones.
    std::chrono::duration<double> latency() const { return latency_; }
    /// Those being loaded included.
    std::uint64_t bytes() const { return pages_.bytes() + source_->bytes(); }

private:
    struct Failure {
        std::string message;
        Clock::time_point retryAt;
        bool isGivenUp = false;
    };

    std::uint64_t bytesOf(std::uint32_t page) const;
    Loads keep(std::vector<Arrival> arrivals);
    void noteFailure(const Arrival& arrival);
    std::vector<Wish> missing();

    const PageFacts facts_;
    ResidentSet<std::uint32_t, std::shared_ptr<const void>> pages_;
    std::vector<std::uint32_t> wanted_;  ///< of this frame, distinct, by rank
    std::unordered_map<std::uint32_t, std::uint32_t> rankOf_;
    std::uint64_t wantedBytes_ = 0;
    std::unordered_map<std::uint32_t, std::uint64_t> knownBytes_;
    std::unordered_map<std::uint32_t, Failure> failures_;
    bool isSourceDown_ = false;  ///< says the last attempt
    std::unordered_map<std::uint32_t, Clock::time_point> wishedSince_;
    std::chrono::duration<double> latency_{0.1};
    std::unique_ptr<Loader::Source> source_;
};

}  // namespace eyrie::page
