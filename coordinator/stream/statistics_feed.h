// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include <absl/status/statusor.h>

#include "coordinator/frame/frame_source.h"

namespace eyrie::v1 {
class WatchStatisticsResponse;
}

namespace eyrie::stream {

/// What frames took and showed, told as they are drawn to who wants to know. A reader asks for one
/// message after another; between them only the newest is kept, and the number of those left out:
/// who reads slowly, or seldom, costs no memory. All functions may be called from any thread.
class StatisticsFeed {
public:
    using Message = std::shared_ptr<const v1::WatchStatisticsResponse>;
    using Then = std::function<void(absl::StatusOr<Message>)>;

    /// `readers` at the same time, at most.
    explicit StatisticsFeed(std::size_t readers = 64);
    /// As stop().
    ~StatisticsFeed();
    StatisticsFeed(const StatisticsFeed&) = delete;
    StatisticsFeed& operator=(const StatisticsFeed&) = delete;

    /// A frame has been drawn for the session of that id; empty: for a program. `number` tells
    /// sessions that have the same id one after another apart: later ones have greater ones.
    void drawn(const std::string& session, const coordinator::RenderedFrame& frame,
               std::uint64_t number = 0);
    /// There is no such session any more; there may already be another of that id.
    void ended(const std::string& session, std::uint64_t number = 0);

    struct Wish {
        std::string session = {};                        ///< of its frames only; empty: all
        std::chrono::steady_clock::duration interval{};  ///< at least so long between messages
    };

    /// Who hears of frames. May outlive the feed.
    class Reader {
    public:
        /// Ends it: afterwards no `then` runs any more.
        virtual ~Reader() = default;

        /// `then` is called once, without locks held: with the next message, the first time with
        /// that of the last frame, where there was one that it wishes to hear of; or Unavailable:
        /// there will be no more. Not before the one before has been called.
        virtual void next(Then then) = 0;
    };

    /// ResourceExhausted: too many read already.
    absl::StatusOr<std::unique_ptr<Reader>> read(Wish wish);

    /// Tells all readers that there will be no more.
    void stop();

private:
    class Impl;
    class OwnReader;
    std::shared_ptr<Impl> impl_;
};

}  // namespace eyrie::stream
