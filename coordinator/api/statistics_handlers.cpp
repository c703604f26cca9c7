// SPDX-License-Identifier: Apache-2.0
#include <chrono>
#include <memory>
#include <utility>

#include <fmt/format.h>

#include "coordinator/api/handler_list.h"
#include "coordinator/api/handlers.h"
#include "coordinator/stream/statistics_feed.h"
#include "eyrie/v1/coordinator_service.pb.h"
#include "fabric/status.h"

namespace eyrie::api {
namespace {

constexpr double kLeastPerSecond = 0.01;
constexpr double kMostPerSecond = 1000;
constexpr std::size_t kMaxIdBytes = 64;

class StatisticsStream final : public MessageStream {
public:
    explicit StatisticsStream(std::unique_ptr<stream::StatisticsFeed::Reader> reader)
        : reader_(std::move(reader)) {}

    void next(Then then) override {
        reader_->next([then = std::move(then)](
                          const absl::StatusOr<stream::StatisticsFeed::Message>& message) {
            then(message.ok() ? absl::StatusOr<Message>(*message) : message.status());
        });
    }

private:
    const std::unique_ptr<stream::StatisticsFeed::Reader> reader_;
};

absl::StatusOr<stream::StatisticsFeed::Wish> wishOf(const v1::WatchStatisticsRequest& request) {
    if (request.session().size() > kMaxIdBytes)
        return absl::InvalidArgumentError(
            fmt::format("session has {} bytes; no session's id has more than {}",
                        request.session().size(), kMaxIdBytes));
    stream::StatisticsFeed::Wish wish{request.session()};
    if (!request.has_per_second())
        return wish;
    if (!(request.per_second() >= kLeastPerSecond && request.per_second() <= kMostPerSecond))
        return absl::InvalidArgumentError(fmt::format("per_second is {}; it must be from {} to {}",
                                                      request.per_second(), kLeastPerSecond,
                                                      kMostPerSecond));
    wish.interval = std::chrono::duration_cast<std::chrono::steady_clock::duration>(
        std::chrono::duration<double>(1 / request.per_second()));
    return wish;
}

}  // namespace

void addStatisticsHandlers(Handlers& handlers, stream::StatisticsFeed& statistics,
                           const QuotaKeeper& quotas) {
    handlers.addStream<v1::WatchStatisticsRequest>(
        "WatchStatistics",
        [&statistics, &quotas](const v1::WatchStatisticsRequest& request)
            -> absl::StatusOr<std::unique_ptr<MessageStream>> {
            ASSIGN_OR_RETURN(const stream::StatisticsFeed::Wish wish, wishOf(request));
            auto reader = statistics.read(wish);
            if (absl::IsResourceExhausted(reader.status()))
                return quotas.counted(observe::Quota::Readers, reader.status());
            RETURN_IF_ERROR(reader.status());
            return std::make_unique<StatisticsStream>(*std::move(reader));
        });
}

}  // namespace eyrie::api
