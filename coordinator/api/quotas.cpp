// SPDX-License-Identifier: Apache-2.0
#include "coordinator/api/quotas.h"

#include <algorithm>

#include <fmt/format.h>

#include "coordinator/stream/viewer_messages.h"
#include "fabric/log.h"

namespace eyrie::api {
namespace {

/// Above which addresses that have been silent are forgotten.
constexpr std::size_t kManyAddresses = 1024;
constexpr std::chrono::seconds kBurst{1};

}  // namespace

absl::Status CallRate::take(std::string_view address, Clock::time_point now) {
    if (perSecond_ == 0)
        return absl::OkStatus();
    const std::lock_guard lock(mutex_);
    if (due_.size() > kManyAddresses)
        std::erase_if(due_, [&](const auto& known) { return known.second + kBurst < now; });
    auto at = due_.find(address);
    if (at == due_.end())
        at = due_.emplace(std::string(address), now - kBurst).first;
    const auto interval = std::chrono::duration_cast<Clock::duration>(kBurst) / perSecond_;
    const Clock::time_point due = std::max(at->second, now - kBurst) + interval;
    if (due > now)
        return absl::ResourceExhaustedError(fmt::format(
            "more than {} calls a second come from this address; make fewer, or try again in a bit",
            perSecond_));
    at->second = due;
    return absl::OkStatus();
}

absl::Status QuotaKeeper::counted(observe::Quota quota, absl::Status status) const {
    if (status.ok())
        return status;
    if (telemetry_ != nullptr)
        telemetry_->metrics.overQuota(quota);
    const std::string name(observe::nameOf(quota));
    if (told_.isDue(name, access::RareWarnings::Clock::now()))
        spdlog::warn(
            "a call is refused by the quota '{}': {}; more such within a minute "
            "are not told",
            name, stream::sanitised({status.message().data(), status.message().size()}));
    return status;
}

absl::StatusOr<std::shared_ptr<void>> QuotaKeeper::documentShare(std::int64_t bytes) const {
    if (std::shared_ptr<void> share = documents_.take(bytes))
        return share;
    return counted(observe::Quota::Documents,
                   absl::ResourceExhaustedError(
                       "too many large reports or traces are being sent; try again in a bit"));
}

}  // namespace eyrie::api
