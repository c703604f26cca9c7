// SPDX-License-Identifier: Apache-2.0
#include "coordinator/stream/statistics_feed.h"

#include <algorithm>
#include <condition_variable>
#include <iterator>
#include <limits>
#include <map>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "coordinator/stream/statistics_message.h"
#include "eyrie/v1/coordinator_service.pb.h"

namespace eyrie::stream {
namespace {

using Clock = std::chrono::steady_clock;

absl::Status theEnd() { return absl::UnavailableError("the server is shutting down"); }

}  // namespace

class StatisticsFeed::Impl {
public:
    /// One that reads; guarded by the feed's lock.
    struct Ear {
        Wish wish;
        Message newest = nullptr;  ///< that it has not been told
        std::uint64_t leftOut = 0;
        Then then = nullptr;  ///< it waits
        Clock::time_point notBefore{};
        bool isBeingTold = false;
    };

    explicit Impl(std::size_t readers) : limit_(readers), thread_([this] { tellLoop(); }) {}

    void drawn(const std::string& session, const coordinator::RenderedFrame& frame,
               std::uint64_t number) {
        auto message = std::make_shared<v1::WatchStatisticsResponse>();
        message->set_unix_milliseconds(std::chrono::duration_cast<std::chrono::milliseconds>(
                                           std::chrono::system_clock::now().time_since_epoch())
                                           .count());
        message->set_session(session);
        *message->mutable_statistics() =
            statisticsMessage(frame, frame.image.area.width, frame.image.area.height);
        {
            const std::lock_guard lock(mutex_);
            message->set_frame(++frames_);
            last_ = message;
            if (!session.empty())
                lastOf_[{session, number}] = message;
            for (const auto& ear : ears_)
                if (isFor(*ear, session)) {
                    if (ear->newest != nullptr)
                        ++ear->leftOut;
                    ear->newest = message;
                }
        }
        changed_.notify_all();
    }

    void ended(const std::string& session, std::uint64_t number) {
        const std::lock_guard lock(mutex_);
        lastOf_.erase({session, number});
    }

    absl::StatusOr<std::shared_ptr<Ear>> listen(Wish wish) {
        const std::lock_guard lock(mutex_);
        if (isStopped_)
            return theEnd();
        if (ears_.size() >= limit_)
            return absl::ResourceExhaustedError(fmt::format(
                "{} programs watch already; end one, or try again later", ears_.size()));
        auto ear = std::make_shared<Ear>();
        ear->wish = std::move(wish);
        if (ear->wish.session.empty())
            ear->newest = last_;
        else
            ear->newest = lastOf(ear->wish.session);
        ears_.push_back(ear);
        return ear;
    }

    void forget(const std::shared_ptr<Ear>& ear) {
        std::unique_lock lock(mutex_);
        std::erase(ears_, ear);
        ear->then = nullptr;
        if (std::this_thread::get_id() != thread_.get_id())
            changed_.wait(lock, [&] { return !ear->isBeingTold; });
    }

    void next(Ear& ear, Then then) {
        {
            const std::lock_guard lock(mutex_);
            if (!isStopped_)
                ear.then = std::exchange(then, nullptr);
        }
        if (then != nullptr)
            return then(theEnd());
        changed_.notify_all();
    }

    void stop() {
        {
            const std::lock_guard lock(mutex_);
            isStopped_ = true;
        }
        changed_.notify_all();
        const std::lock_guard joining(joining_);
        if (thread_.joinable())
            thread_.join();
    }

private:
    /// That of the last session of that id; null where there is none.
    Message lastOf(const std::string& session) const {
        const auto after =
            lastOf_.upper_bound({session, std::numeric_limits<std::uint64_t>::max()});
        if (after == lastOf_.begin() || std::prev(after)->first.first != session)
            return nullptr;
        return std::prev(after)->second;
    }

    static bool isFor(const Ear& ear, const std::string& session) {
        return ear.wish.session.empty() || ear.wish.session == session;
    }

    /// Who waits, and is to be told now; else nobody, and when somebody will be.
    std::shared_ptr<Ear> due(std::optional<Clock::time_point>& later) const {
        const Clock::time_point now = Clock::now();
        for (const auto& ear : ears_) {
            if (ear->then == nullptr || (ear->newest == nullptr && !isStopped_))
                continue;
            if (isStopped_ || now >= ear->notBefore)
                return ear;
            later = later ? std::min(*later, ear->notBefore) : ear->notBefore;
        }
        return nullptr;
    }

    absl::StatusOr<Message> take(Ear& ear) const {
        if (isStopped_)
            return theEnd();
        ear.notBefore = Clock::now() + ear.wish.interval;
        Message message = std::exchange(ear.newest, nullptr);
        if (ear.leftOut == 0)
            return message;
        auto own = std::make_shared<v1::WatchStatisticsResponse>(*message);
        own->set_left_out(std::exchange(ear.leftOut, 0));
        return Message(std::move(own));
    }

    void tellLoop() {
        std::unique_lock lock(mutex_);
        while (true) {
            std::optional<Clock::time_point> later;
            if (const std::shared_ptr<Ear> ear = due(later)) {
                const Then then = std::exchange(ear->then, nullptr);
                absl::StatusOr<Message> message = take(*ear);
                ear->isBeingTold = true;
                lock.unlock();
                then(std::move(message));
                lock.lock();
                ear->isBeingTold = false;
                changed_.notify_all();
            } else if (isStopped_) {
                return;
            } else if (later) {
                changed_.wait_until(lock, *later);
            } else {
                changed_.wait(lock);
            }
        }
    }

    const std::size_t limit_;
    std::mutex mutex_;  ///< guards what follows, up to the thread
    std::condition_variable changed_;
    std::vector<std::shared_ptr<Ear>> ears_;
    Message last_;
    std::map<std::pair<std::string, std::uint64_t>, Message> lastOf_;  ///< by session and number
    std::uint64_t frames_ = 0;
    bool isStopped_ = false;
    std::mutex joining_;
    std::thread thread_;
};

class StatisticsFeed::OwnReader final : public Reader {
public:
    OwnReader(std::shared_ptr<Impl> feed, std::shared_ptr<Impl::Ear> ear)
        : feed_(std::move(feed)), ear_(std::move(ear)) {}
    ~OwnReader() override { feed_->forget(ear_); }
    OwnReader(const OwnReader&) = delete;
    OwnReader& operator=(const OwnReader&) = delete;

    void next(Then then) override { feed_->next(*ear_, std::move(then)); }

private:
    const std::shared_ptr<Impl> feed_;
    const std::shared_ptr<Impl::Ear> ear_;
};

StatisticsFeed::StatisticsFeed(std::size_t readers) : impl_(std::make_shared<Impl>(readers)) {}
StatisticsFeed::~StatisticsFeed() { stop(); }

void StatisticsFeed::drawn(const std::string& session, const coordinator::RenderedFrame& frame,
                           std::uint64_t number) {
    impl_->drawn(session, frame, number);
}

absl::StatusOr<std::unique_ptr<StatisticsFeed::Reader>> StatisticsFeed::read(Wish wish) {
    absl::StatusOr<std::shared_ptr<Impl::Ear>> ear = impl_->listen(std::move(wish));
    if (!ear.ok())
        return ear.status();
    return std::make_unique<OwnReader>(impl_, *std::move(ear));
}

void StatisticsFeed::ended(const std::string& session, std::uint64_t number) {
    impl_->ended(session, number);
}

void StatisticsFeed::stop() { impl_->stop(); }

}  // namespace eyrie::stream
