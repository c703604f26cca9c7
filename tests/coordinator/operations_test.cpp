// SPDX-License-Identifier: Apache-2.0
#include "coordinator/api/operations.h"

#include <atomic>
#include <condition_variable>
#include <mutex>
#include <stop_token>
#include <string>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "tests/service/eventually.h"

namespace eyrie::api {
namespace {

using std::chrono::seconds;
using testing::HasSubstr;

/// Work that a test lets go on.
class Gate {
public:
    Operations::Work work() {
        return [this](const Operations::Progress& progress, const std::stop_token& stop) {
            progress("reading", 0.25);
            ++begun;
            std::unique_lock lock(mutex_);
            changed_.wait(lock, stop, [this] { return isOpen_; });
            return stop.stop_requested() ? absl::CancelledError("") : result;
        };
    }
    void open() {
        {
            const std::lock_guard lock(mutex_);
            isOpen_ = true;
        }
        changed_.notify_all();
    }

    std::atomic<int> begun{0};
    absl::StatusOr<Operations::Notes> result = Operations::Notes();

private:
    std::mutex mutex_;
    std::condition_variable_any changed_;
    bool isOpen_ = false;
};

class OperationsTest : public testing::Test {
protected:
    Operations::Order order(const std::string& id, const std::string& request = "a") {
        return {id, v1::OPERATION_KIND_IMPORT_MESH, id + request + ".eym", request, gate_.work()};
    }
    bool becomes(const std::string& id, v1::OperationState state) {
        return eventually([&] { return operations_.find(id)->state() == state; });
    }

    Gate gate_;
    std::atomic<int> now_{0};  ///< seconds
    Operations operations_{{.atOnce = 1, .waiting = 2, .ended = 2},
                           [this] { return Operations::Clock::time_point(seconds(1000 + now_)); }};
};

TEST_F(OperationsTest, TellHowFarTheyAreAndHowLongTheyTakeYet) {
    ASSERT_TRUE(operations_.begin(order("a")).ok());
    ASSERT_TRUE(eventually([&] { return gate_.begun == 1; }));
    EXPECT_FALSE(operations_.find("a")->has_stage_seconds_left());
    now_ = 2;
    const v1::Operation told = *operations_.find("a");
    EXPECT_EQ(told.state(), v1::OPERATION_STATE_RUNNING);
    EXPECT_EQ(told.stage(), "reading");
    EXPECT_EQ(told.stage_progress(), 0.25);
    EXPECT_EQ(told.seconds(), 2);
    EXPECT_EQ(told.stage_seconds_left(), 6);
    gate_.open();
    ASSERT_TRUE(becomes("a", v1::OPERATION_STATE_DONE));
    now_ = 9;
    EXPECT_EQ(operations_.find("a")->seconds(), 2);
    EXPECT_EQ(operations_.find("a")->stage(), "");
}

TEST_F(OperationsTest, AreTheSameForTheSameIdAndRequestOnly) {
    ASSERT_TRUE(operations_.begin(order("a")).ok());
    EXPECT_EQ(operations_.begin(order("a"))->id(), "a");
    EXPECT_TRUE(absl::IsAlreadyExists(operations_.begin(order("a", "b")).status()));
    EXPECT_EQ(operations_.all().size(), 1U);
    gate_.open();
    ASSERT_TRUE(becomes("a", v1::OPERATION_STATE_DONE));
    EXPECT_EQ(operations_.begin(order("a"))->state(), v1::OPERATION_STATE_DONE);
    EXPECT_EQ(gate_.begun, 1);
}

TEST_F(OperationsTest, DoNotMakeTheSameAtTheSameTime) {
    ASSERT_TRUE(operations_.begin(order("a")).ok());
    Operations::Order other = order("b");
    other.output = "aa.eym";
    EXPECT_TRUE(absl::IsFailedPrecondition(operations_.begin(other).status()));
    gate_.open();
    ASSERT_TRUE(becomes("a", v1::OPERATION_STATE_DONE));
    EXPECT_TRUE(operations_.begin(other).ok());
}

TEST_F(OperationsTest, WaitAFewAtATime) {
    ASSERT_TRUE(operations_.begin(order("a")).ok());
    ASSERT_TRUE(eventually([&] { return gate_.begun == 1; }));
    ASSERT_TRUE(operations_.begin(order("b")).ok());
    ASSERT_TRUE(operations_.begin(order("c")).ok());
    EXPECT_TRUE(absl::IsResourceExhausted(operations_.begin(order("d")).status()));
    EXPECT_TRUE(absl::IsNotFound(operations_.find("d").status()));
    EXPECT_EQ(operations_.find("b")->state(), v1::OPERATION_STATE_WAITING);
}

TEST_F(OperationsTest, AreCalledOffWhetherTheyHaveBegunOrNot) {
    ASSERT_TRUE(operations_.begin(order("a")).ok());
    ASSERT_TRUE(operations_.begin(order("b")).ok());
    ASSERT_TRUE(eventually([&] { return gate_.begun == 1; }));
    EXPECT_EQ(operations_.cancel("b")->state(), v1::OPERATION_STATE_CANCELLED);
    ASSERT_TRUE(operations_.cancel("a").ok());
    EXPECT_TRUE(becomes("a", v1::OPERATION_STATE_CANCELLED));
    gate_.open();
    ASSERT_TRUE(operations_.begin(order("c")).ok());
    EXPECT_TRUE(becomes("c", v1::OPERATION_STATE_DONE));
    EXPECT_EQ(operations_.cancel("c")->state(), v1::OPERATION_STATE_DONE);
    EXPECT_EQ(gate_.begun, 2);
}

TEST_F(OperationsTest, ThatAreCalledOffOrForgottenMakeRoomForOthers) {
    ASSERT_TRUE(operations_.begin(order("a")).ok());
    ASSERT_TRUE(eventually([&] { return gate_.begun == 1; }));
    for (int i = 0; i < 10; ++i) {
        for (const char* id : {"b", "c"}) {
            const auto begun = operations_.begin(order(fmt::format("{}{}", id, i)));
            ASSERT_TRUE(begun.ok()) << begun.status();
        }
        EXPECT_TRUE(absl::IsResourceExhausted(operations_.begin(order("d")).status()));
        ASSERT_TRUE(operations_.cancel(fmt::format("b{}", i)).ok());
        ASSERT_TRUE(operations_.forget(fmt::format("c{}", i)).ok());
    }
    ASSERT_TRUE(operations_.begin(order("e")).ok());
    gate_.open();
    EXPECT_TRUE(becomes("e", v1::OPERATION_STATE_DONE));
    EXPECT_EQ(gate_.begun, 2);
}

TEST_F(OperationsTest, AreForgottenWhenAskedToAndOneByOneWhenThereAreMany) {
    ASSERT_TRUE(operations_.begin(order("a")).ok());
    ASSERT_TRUE(eventually([&] { return gate_.begun == 1; }));
    ASSERT_TRUE(operations_.forget("a").ok());
    EXPECT_TRUE(absl::IsNotFound(operations_.find("a").status()));
    EXPECT_TRUE(absl::IsNotFound(operations_.cancel("a").status()));
    gate_.open();
    for (const char* id : {"b", "c", "d"}) {
        ASSERT_TRUE(operations_.begin(order(id)).ok());
        ASSERT_TRUE(becomes(id, v1::OPERATION_STATE_DONE));
    }
    EXPECT_TRUE(absl::IsNotFound(operations_.find("b").status()));
    EXPECT_EQ(operations_.all().size(), 2U);
}

TEST_F(OperationsTest, SayWhyTheyFailed) {
    gate_.result = absl::DataLossError("dem.tif: is damaged");
    gate_.open();
    ASSERT_TRUE(operations_.begin(order("a")).ok());
    ASSERT_TRUE(becomes("a", v1::OPERATION_STATE_FAILED));
    EXPECT_EQ(operations_.find("a")->problem(), "dem.tif: is damaged");
}

TEST_F(OperationsTest, TellAtMostTwentyNotesAndHowManyMoreThereAre) {
    Operations::Notes notes(20, "a\nnote");
    gate_.result = notes;
    gate_.open();
    ASSERT_TRUE(operations_.begin(order("a")).ok());
    ASSERT_TRUE(becomes("a", v1::OPERATION_STATE_DONE));
    EXPECT_EQ(operations_.find("a")->notes_size(), 20);
    EXPECT_EQ(operations_.find("a")->notes(19), "a note");
    notes.push_back(std::string(1000, 'x'));
    gate_.result = notes;
    ASSERT_TRUE(operations_.begin(order("b")).ok());
    ASSERT_TRUE(becomes("b", v1::OPERATION_STATE_DONE));
    EXPECT_EQ(operations_.find("b")->notes_size(), 20);
    EXPECT_THAT(operations_.find("b")->notes(19), HasSubstr("and 2 more"));
}

TEST_F(OperationsTest, HaveNamesThatFitIntoPaths) {
    for (const std::string& id : {std::string("a/b"), std::string(65, 'a'), std::string("ü")})
        EXPECT_TRUE(absl::IsInvalidArgument(operations_.begin(order(id)).status())) << id;
    gate_.open();
    const absl::StatusOr<v1::Operation> made = operations_.begin(order(""));
    ASSERT_TRUE(made.ok()) << made.status();
    EXPECT_EQ(made->id().size(), 16U);
}

}  // namespace
}  // namespace eyrie::api
