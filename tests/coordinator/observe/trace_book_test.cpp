// SPDX-License-Identifier: Apache-2.0
#include "coordinator/observe/trace_book.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/support/json.h"

namespace eyrie::observe {
namespace {

using std::chrono::microseconds;

Clock::time_point at(int micro) {
    return Clock::time_point(std::chrono::hours(1000) + microseconds(micro));
}

std::vector<test::JsonValue> spansOf(const std::string& json) {
    std::vector<test::JsonValue> spans;
    for (const test::JsonValue& event : test::list(test::parseJson(json), "traceEvents"))
        if (test::at(event, "ph").string_value() == "X")
            spans.push_back(event);
    return spans;
}

TEST(TraceBook, WithoutFramesIsAnEmptyTrace) {
    EXPECT_TRUE(spansOf(TraceBook().chromeJson(10)).empty());
}

TEST(TraceBook, ShowsTheLastFramesFromTheFirstOnesBegin) {
    TraceBook book;
    for (int frame = 1; frame <= 5; ++frame)
        book.add({"coordinator", "frames", "frame", static_cast<std::uint64_t>(frame),
                  at(frame * 100), at(frame * 100 + 50)});
    book.add({"coordinator", "encodes", "encode", 0, at(420), at(430)});
    const auto spans = spansOf(book.chromeJson(2));
    ASSERT_EQ(spans.size(), 3u);
    EXPECT_EQ(test::number(spans[0], "args.frame"), 4);
    EXPECT_EQ(test::number(spans[0], "ts"), 0);
    EXPECT_EQ(test::number(spans[0], "dur"), 50);
    EXPECT_EQ(test::at(spans[1], "name").string_value(), "encode");
    EXPECT_EQ(test::number(spans[1], "ts"), 20);
    EXPECT_EQ(test::number(spans[2], "args.frame"), 5);
}

TEST(TraceBook, GivesEachProcessAndThreadANameAndANumber) {
    TraceBook book;
    book.add({"another \"one\"", "channels", "channel", 1, at(1), at(2), microseconds(3), "late"});
    book.add({"coordinator", "frames", "frame", 1, at(0), at(3)});
    const auto trace = test::parseJson(book.chromeJson(1));
    std::map<double, std::string> processes;
    for (const auto& event : test::list(trace, "traceEvents"))
        if (test::at(event, "name").string_value() == "process_name")
            processes[test::number(event, "pid")] = test::at(event, "args.name").string_value();
    const std::map<double, std::string> expected = {{1, "coordinator"}, {2, "another \"one\""}};
    EXPECT_EQ(processes, expected);
    const auto spans = spansOf(book.chromeJson(1));
    ASSERT_EQ(spans.size(), 2u);
    EXPECT_EQ(test::number(spans[1], "pid"), 2);
    EXPECT_NE(test::number(spans[0], "tid"), test::number(spans[1], "tid"));
    EXPECT_EQ(test::number(spans[1], "args.clockBoundMicroseconds"), 3);
    EXPECT_EQ(test::at(spans[1], "args.note").string_value(), "late");
}

TEST(TraceBook, TakesNothingThatEndsBeforeItBegins) {
    TraceBook book;
    book.add({"coordinator", "frames", "frame", 1, at(5), at(4)});
    EXPECT_TRUE(spansOf(book.chromeJson(1)).empty());
}

TEST(TraceBook, ForgetsTheOldest) {
    TraceBook book;
    for (std::size_t i = 0; i < TraceBook::kMaxSpans + 10; ++i)
        book.add({"coordinator", "frames", "frame", 1 + i, at(static_cast<int>(i)),
                  at(static_cast<int>(i) + 1)});
    EXPECT_EQ(spansOf(book.chromeJson(TraceBook::kMaxSpans + 10)).size(), TraceBook::kMaxSpans);
}

TEST(RendererName, IsShortForASocket) {
    EXPECT_EQ(rendererName("unix:/tmp/eyrie-abc/renderer-0-1"), "renderer-0-1");
    EXPECT_EQ(rendererName("unix:renderer"), "renderer");
    EXPECT_EQ(rendererName("10.0.0.7:5000"), "10.0.0.7:5000");
}

}  // namespace
}  // namespace eyrie::observe
