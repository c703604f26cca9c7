// SPDX-License-Identifier: Apache-2.0
#include "cli/awaited_renderers.h"

#include <vector>

#include <gtest/gtest.h>

namespace eyrie::cli {
namespace {

using coordinator::RendererStatus;
using enum coordinator::RendererCondition;

coordinator::Status statusOf(const std::vector<coordinator::RendererCondition>& conditions) {
    coordinator::Status status;
    for (const auto condition : conditions) {
        RendererStatus& one = status.renderers.emplace_back();
        one.address = "unix:/ours/renderer";
        one.condition = condition;
        one.why = "it has no such file";
    }
    return status;
}

absl::StatusOr<bool> areThere(int count,
                              const std::vector<coordinator::RendererCondition>& conditions) {
    return cli::areThere({count, static_cast<int>(conditions.size()), "unix:/ours/"},
                         statusOf(conditions));
}

/// The first picture would be shared out among fewer, and be another where memory is short.
TEST(AwaitedRenderers, AreNotThereWhileOneOpensTheScene) {
    EXPECT_EQ(*areThere(2, {Ready, Opening}), false);
    EXPECT_EQ(*areThere(2, {Ready, Draining}), false);
    EXPECT_EQ(*areThere(2, {Ready, Ready}), true);
    EXPECT_EQ(*areThere(2, {Ready, Late}), true);
    EXPECT_EQ(*areThere(1, {Ready, Opening}), true);
}

TEST(AwaitedRenderers, AreNotThereWhileNoFrameCanBeHad) {
    coordinator::Status status = statusOf({Ready});
    status.problem = "nothing is to be shown";
    EXPECT_EQ(*cli::areThere({1, 1, "unix:/ours/"}, status), false);
}

TEST(AwaitedRenderers, AreNotWaitedForWhereTooFewAreLeft) {
    const auto some = areThere(2, {Ready, Refused});
    EXPECT_EQ(some.status().message(), "not every renderer can draw this: it has no such file");
    const auto none = areThere(2, {Refused, Refused});
    EXPECT_EQ(none.status().message(), "no renderer can draw this: it has no such file");
    EXPECT_EQ(*areThere(1, {Ready, Refused}), true);
}

}  // namespace
}  // namespace eyrie::cli
