// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <utility>

#include <absl/status/statusor.h>

#include "access/rare_warnings.h"
#include "coordinator/api/answer_shares.h"
#include "coordinator/observe/telemetry.h"

namespace eyrie::api {

/// What programs may ask for at most; what is beyond is refused at once.
struct Quotas {
    static constexpr std::int64_t kMostImagePixels = std::int64_t{8192} * 8192;

    /// Of one that comes as JSON.
    static constexpr std::int64_t kMostTextPixels = std::int64_t{1} << 23;

    /// Over gRPC, where an answer is one message: colours and depths of as many pixels, or a
    /// report's file, and what is said of them.
    static constexpr int kMostAnswerBytes = static_cast<int>(8 * kMostImagePixels) + (1 << 20);

    /// Of one picture, and of those being made and sent at the same time twice as many, up to
    /// kMostImagePixels; 1 to kMostImagePixels.
    std::int64_t imagePixels = 1 << 25;
    int sceneObjects = 1000;
    /// Of the data folder's files that a scene names.
    std::uint64_t sceneBytes = std::uint64_t{1} << 40;
    std::uint64_t sceneTriangles = 100'000'000'000;
    int callsPerSecond = 200;  ///< of an address; 0: any number
    std::size_t readers = 64;  ///< of statistics, at a time
    /// Of reports' files and traces that are being read and sent: two of the largest.
    std::int64_t documentBytes = std::int64_t{512} << 20;
};

/// How fast an address may make calls: so many a second, and as many at once after a second of
/// silence. All functions may be called from any thread.
class CallRate {
public:
    using Clock = std::chrono::steady_clock;

    /// 0: as fast as it likes.
    explicit CallRate(int perSecond) : perSecond_(perSecond) {}

    /// ResourceExhausted: too many of late.
    absl::Status take(std::string_view address, Clock::time_point now = Clock::now());

private:
    const int perSecond_;
    std::mutex mutex_;  ///< guards due_
    /// When as many would have come at an even pace.
    std::map<std::string, Clock::time_point, std::less<>> due_;
};

/// Quotas, and how often they were reached. All functions may be called from any thread.
class QuotaKeeper {
public:
    /// `telemetry`, if any, counts what is refused.
    explicit QuotaKeeper(const Quotas& quotas, observe::SharedTelemetry telemetry = nullptr)
        : quotas_(quotas),
          telemetry_(std::move(telemetry)),
          rate_(quotas.callsPerSecond),
          documents_(quotas.documentBytes) {}

    const Quotas& most() const { return quotas_; }

    /// `status`, counted where it is an error, and told to the log, of each quota once a minute.
    absl::Status counted(observe::Quota quota, absl::Status status) const;

    /// A call from an address, an IP address without a port: CallRate's.
    absl::Status admit(std::string_view address) {
        return counted(observe::Quota::Rate, rate_.take(address));
    }

    /// For a report's file or a trace of that size, until it has been sent. ResourceExhausted: too
    /// many are on their way.
    absl::StatusOr<std::shared_ptr<void>> documentShare(std::int64_t bytes) const;

private:
    const Quotas quotas_;
    const observe::SharedTelemetry telemetry_;
    CallRate rate_;
    const AnswerShares documents_;
    mutable access::RareWarnings told_;
};

}  // namespace eyrie::api
