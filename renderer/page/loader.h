// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <stop_token>
#include <vector>

#include <absl/status/statusor.h>

namespace eyrie::page {

/// A page in memory. Whoever opened its source knows what it points to.
struct Loaded {
    std::shared_ptr<const void> value;
    std::uint64_t bytes = 0;
};

/// A page that should be in memory.
struct Wish {
    std::uint32_t page = 0;
    double priority = 0;      ///< the higher, the sooner; comparable between sources
    std::uint64_t bytes = 0;  ///< what loading it may take, at most
};

/// What became of a wish.
struct Arrival {
    std::uint32_t page = 0;
    absl::StatusOr<Loaded> result;
    std::chrono::steady_clock::time_point retryAt;  ///< of a failure: not tried again before
    bool isGivenUp = false;  ///< of a failure: nobody should wait for the next attempt
};

struct LoaderOptions {
    int threads = 2;
    /// A page that failed is tried again after `firstRetry`, then after twice as long each time, up
    /// to `lastRetry`; one that is damaged (DataLoss, InvalidArgument), after `lastRetry` at once:
    /// it will not mend by itself, but somebody may mend it.
    std::chrono::milliseconds firstRetry{250};
    std::chrono::milliseconds lastRetry{10'000};
    /// After so many failures in a row nobody waits for a page; after one that is damaged.
    int patience = 3;
};

/// Loads pages of any number of sources on threads of its own, most wanted first. The threads run
/// at a low priority, so that on a machine whose processors also draw, drawing comes first.
///
/// A source that is Unavailable is left alone as long as a page that failed would be, and then
/// asked for one page at a time until one comes, so that a server that stalls holds up neither all
/// threads nor other sources for longer than it takes to find out.
class Loader {
public:
    /// Reads one page, on a thread of the loader; several at a time. May block and may fail.
    using Load = std::function<absl::StatusOr<Loaded>(std::uint32_t page)>;

    class Source;

    explicit Loader(const LoaderOptions& options = {});

    /// Waits for the loads in progress. The sources must be gone.
    ~Loader();
    Loader(const Loader&) = delete;
    Loader& operator=(const Loader&) = delete;

    /// `limitBytes` bounds the pages that are being loaded or have not been taken yet. The loader
    /// outlives the source.
    std::unique_ptr<Source> open(Load load, std::uint64_t limitBytes);

private:
    struct State;
    std::unique_ptr<State> state_;
};

/// One source's wishes and what came of them; used by one thread. Its end drops all wishes and
/// waits for its loads in progress.
class Loader::Source {
public:
    ~Source();
    Source(const Source&) = delete;
    Source& operator=(const Source&) = delete;

    /// Replaces all wishes: what is no longer wished for and has not been begun is not loaded.
    /// Pages that are being loaded, wait to be taken or wait to be tried again are left alone.
    void wish(std::vector<Wish> wishes);

    /// What has arrived since the last call; each failure of a page once for each attempt.
    std::vector<Arrival> take();

    /// The same without ever waiting: while a thread of the loader is at its books, nothing is
    /// wished or taken. Those threads have a low priority and may be kept from going on for long;
    /// a frame must not wait for them.
    void tryWish(std::vector<Wish> wishes);
    std::vector<Arrival> tryTake();

    /// Blocks until something can be taken, or no wish is left but for pages that are given up and
    /// not due again, or of a source that failed as often, or `stop`. True when something can be
    /// taken.
    bool wait(const std::stop_token& stop = {});

    /// Of pages that are being loaded or wait to be taken.
    std::uint64_t bytes() const;

private:
    friend class Loader;
    struct State;
    Source(Loader::State& loader, Load load, std::uint64_t limitBytes);
    std::vector<Arrival> takeLocked();

    Loader::State& loader_;
    std::unique_ptr<State> state_;
};

}  // namespace eyrie::page
