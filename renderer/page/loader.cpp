// SPDX-License-Identifier: Apache-2.0
#include "renderer/page/loader.h"

#include <algorithm>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <optional>
#include <thread>
#include <unordered_map>
#include <utility>

#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

namespace eyrie::page {
namespace {

using Clock = std::chrono::steady_clock;

/// Of the threads that load, so that on few cores they give way to those that draw.
constexpr int kNice = 10;

void sort(std::vector<Wish>& wishes) {
    std::stable_sort(wishes.begin(), wishes.end(),
                     [](const Wish& a, const Wish& b) { return a.priority < b.priority; });
}

/// Trying again at once would bring the same.
bool isDamaged(const absl::Status& status) {
    return absl::IsDataLoss(status) || absl::IsInvalidArgument(status);
}

/// Reads a page whatever the source does.
absl::StatusOr<Loaded> load(const Loader::Load& load, std::uint32_t page) {
    try {
        return load(page);
    } catch (const std::exception& error) {
        return absl::ResourceExhaustedError(
            fmt::format("page {} cannot be loaded: {}", page, error.what()));
    }
}

}  // namespace

struct Loader::Source::State {
    Load load;
    std::uint64_t limitBytes = 0;

    /// In a row.
    struct Failures {
        int times = 0;
        bool isGivenUp = false;
        Clock::time_point retryAt;
    };

    // Guarded by Loader::State::mutex.
    std::vector<Wish> wishes;  ///< ascending by priority
    /// Bytes of the pages that are being loaded or have not been taken.
    std::unordered_map<std::uint32_t, std::uint64_t> held;
    std::uint64_t heldBytes = 0;
    std::vector<Arrival> arrivals;
    std::unordered_map<std::uint32_t, Failures> failures;  ///< by page
    Failures outage;                                       ///< of the source as a whole
    int loading = 0;

    bool fits(const Wish& wish) const { return heldBytes + wish.bytes <= limitBytes; }
    std::optional<Wish> next(Clock::time_point now, Clock::time_point& wakeAt) const;
    bool hasHope() const;
    Failures noteFailure(std::uint32_t page, const absl::Status& status, Clock::time_point begun,
                         const LoaderOptions& options);
};

/// The most wanted page that may be loaded now. The first that would be but for its size ends the
/// search: smaller ones do not overtake it. Pages that failed come after those that have not, so
/// that one bad page does not use up every attempt at a source that is coming back.
std::optional<Wish> Loader::Source::State::next(Clock::time_point now,
                                                Clock::time_point& wakeAt) const {
    if (outage.times > 0 && outage.retryAt > now) {
        if (!wishes.empty())
            wakeAt = std::min(wakeAt, outage.retryAt);
        return std::nullopt;
    }
    if (outage.times > 0 && loading > 0)
        return std::nullopt;
    std::optional<Wish> failed;
    for (auto wish = wishes.rbegin(); wish != wishes.rend(); ++wish) {
        if (held.contains(wish->page))
            continue;
        const auto failure = failures.find(wish->page);
        if (failure != failures.end() && failure->second.retryAt > now) {
            wakeAt = std::min(wakeAt, failure->second.retryAt);
            continue;
        }
        if (!fits(*wish))
            return failed;
        if (failure == failures.end())
            return *wish;
        if (!failed)
            failed = *wish;
    }
    return failed;
}

/// Whether a wish will be tried, now or after a pause, that is worth waiting for.
bool Loader::Source::State::hasHope() const {
    if (outage.isGivenUp)
        return false;
    const Clock::time_point now = Clock::now();
    return std::any_of(wishes.begin(), wishes.end(), [&](const Wish& wish) {
        const auto failure = failures.find(wish.page);
        return !held.contains(wish.page) && fits(wish) &&
               (failure == failures.end() || !failure->second.isGivenUp ||
                failure->second.retryAt <= now);
    });
}

/// Counts a failure of a load that began at `begun`, and says when the page is tried again.
Loader::Source::State::Failures Loader::Source::State::noteFailure(std::uint32_t page,
                                                                   const absl::Status& status,
                                                                   Clock::time_point begun,
                                                                   const LoaderOptions& options) {
    const Clock::time_point now = Clock::now();
    const auto count = [&](Failures& failures_) {
        const auto pause = options.firstRetry * (1 << std::min(failures_.times++, 20));
        failures_.retryAt = now + std::min<Clock::duration>(pause, options.lastRetry);
        failures_.isGivenUp = failures_.times >= options.patience;
    };
    Failures& failure = failures[page];
    count(failure);
    if (isDamaged(status)) {
        failure.retryAt = now + options.lastRetry;
        failure.isGivenUp = true;
    }
    // Loads that were under way when the source failed last say nothing new of it.
    if (absl::IsUnavailable(status) && begun >= outage.retryAt)
        count(outage);
    return failure;
}

struct Loader::State {
    LoaderOptions options;
    std::mutex mutex;  ///< guards what follows and the states of the sources
    std::condition_variable wished;
    std::condition_variable arrived;
    std::vector<Source::State*> sources;
    bool isStopping = false;
    std::vector<std::thread> threads;

    void work();
    void fulfil(std::unique_lock<std::mutex>& lock, Source::State& source, const Wish& wish);
};

void Loader::State::work() {
    // On Linux the nice value is a thread's own. Being refused it costs smoothness only.
    setpriority(PRIO_PROCESS, static_cast<id_t>(gettid()), kNice);
    std::unique_lock lock(mutex);
    while (!isStopping) {
        Source::State* source = nullptr;
        std::optional<Wish> best;
        Clock::time_point wakeAt = Clock::time_point::max();
        for (Source::State* candidate : sources)
            if (const auto wish = candidate->next(Clock::now(), wakeAt);
                wish && (!best || wish->priority > best->priority)) {
                best = wish;
                source = candidate;
            }
        if (best)
            fulfil(lock, *source, *best);
        else if (wakeAt == Clock::time_point::max())
            wished.wait(lock);
        else
            wished.wait_until(lock, wakeAt);
    }
}

void Loader::State::fulfil(std::unique_lock<std::mutex>& lock, Source::State& source,
                           const Wish& wish) {
    std::erase_if(source.wishes, [&](const Wish& other) { return other.page == wish.page; });
    source.held[wish.page] = wish.bytes;
    source.heldBytes += wish.bytes;
    ++source.loading;
    const Clock::time_point begun = Clock::now();
    lock.unlock();
    absl::StatusOr<Loaded> result = load(source.load, wish.page);
    if (result.ok() && result->bytes > wish.bytes)
        result = absl::ResourceExhaustedError(fmt::format(
            "page {} has {} bytes where {} were expected", wish.page, result->bytes, wish.bytes));
    lock.lock();
    --source.loading;
    const std::uint64_t bytes = result.ok() ? result->bytes : 0;
    source.held[wish.page] = bytes;
    source.heldBytes -= wish.bytes - bytes;
    Source::State::Failures failure;
    if (result.ok()) {
        source.failures.erase(wish.page);
        source.outage = {};
    } else {
        failure = source.noteFailure(wish.page, result.status(), begun, options);
    }
    source.arrivals.push_back({wish.page, std::move(result), failure.retryAt, failure.isGivenUp});
    arrived.notify_all();
    wished.notify_all();
}

Loader::Loader(const LoaderOptions& options) : state_(std::make_unique<State>()) {
    state_->options = options;
    for (int i = 0; i < options.threads; ++i)
        state_->threads.emplace_back([state = state_.get()] { state->work(); });
}

Loader::~Loader() {
    {
        const std::lock_guard lock(state_->mutex);
        state_->isStopping = true;
    }
    state_->wished.notify_all();
    for (std::thread& thread : state_->threads) thread.join();
}

std::unique_ptr<Loader::Source> Loader::open(Load load, std::uint64_t limitBytes) {
    return std::unique_ptr<Source>(new Source(*state_, std::move(load), limitBytes));
}

Loader::Source::Source(Loader::State& loader, Load load, std::uint64_t limitBytes)
    : loader_(loader), state_(std::make_unique<State>()) {
    state_->load = std::move(load);
    state_->limitBytes = limitBytes;
    const std::lock_guard lock(loader_.mutex);
    loader_.sources.push_back(state_.get());
}

Loader::Source::~Source() {
    std::unique_lock lock(loader_.mutex);
    std::erase(loader_.sources, state_.get());
    loader_.arrived.wait(lock, [this] { return state_->loading == 0; });
}

void Loader::Source::wish(std::vector<Wish> wishes) {
    sort(wishes);
    {
        const std::lock_guard lock(loader_.mutex);
        state_->wishes.swap(wishes);
    }
    loader_.wished.notify_all();
}

void Loader::Source::tryWish(std::vector<Wish> wishes) {
    sort(wishes);
    {
        const std::unique_lock lock(loader_.mutex, std::try_to_lock);
        if (!lock.owns_lock())
            return;
        state_->wishes.swap(wishes);
    }
    loader_.wished.notify_all();
}

std::vector<Arrival> Loader::Source::take() {
    const std::lock_guard lock(loader_.mutex);
    return takeLocked();
}

std::vector<Arrival> Loader::Source::tryTake() {
    const std::unique_lock lock(loader_.mutex, std::try_to_lock);
    return lock.owns_lock() ? takeLocked() : std::vector<Arrival>{};
}

std::vector<Arrival> Loader::Source::takeLocked() {
    std::vector<Arrival> arrivals;
    arrivals.swap(state_->arrivals);
    for (const Arrival& arrival : arrivals) {
        const auto held = state_->held.find(arrival.page);
        state_->heldBytes -= held->second;
        state_->held.erase(held);
        // A wish that is older than the arrival is fulfilled by it.
        if (arrival.result.ok())
            std::erase_if(state_->wishes,
                          [&](const Wish& wish) { return wish.page == arrival.page; });
    }
    if (!arrivals.empty())
        loader_.wished.notify_all();
    return arrivals;
}

bool Loader::Source::wait(const std::stop_token& stop) {
    // Its end waits for the callback, which wants the lock: so it goes after that.
    const std::stop_callback wake(stop, [this] {
        {
            // Whoever is between asking and waiting must not miss it.
            const std::lock_guard lock(loader_.mutex);
        }
        loader_.arrived.notify_all();
    });
    std::unique_lock lock(loader_.mutex);
    loader_.arrived.wait(lock, [&] {
        return !state_->arrivals.empty() || (state_->loading == 0 && !state_->hasHope()) ||
               stop.stop_requested();
    });
    return !state_->arrivals.empty();
}

std::uint64_t Loader::Source::bytes() const {
    const std::lock_guard lock(loader_.mutex);
    return state_->heldBytes;
}

}  // namespace eyrie::page
