// SPDX-License-Identifier: Apache-2.0
#include "service/gl_thread.h"

#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

#include "fake_drawer.h"

namespace eyrie::service {
namespace {

TEST(GlThread, TheDrawerLivesAndDiesOnIt) {
    auto control = std::make_shared<FakeDrawerControl>();
    {
        auto thread = GlThread::start(fakeDrawers(control)).value();
        EXPECT_EQ(thread->device().renderer, "fake");
        ASSERT_TRUE(thread->post([](ChannelDrawer& drawer) { (void)drawer.openScene({}); }).ok());
    }
    EXPECT_TRUE(control->destroyed);
    EXPECT_TRUE(control->oneThread);
}

TEST(GlThread, WhatTheDrawerLacksIsTheErrorOfStart) {
    const auto thread = GlThread::start(
        [] { return absl::FailedPreconditionError("no EGL device with OpenGL 4.5"); });
    EXPECT_EQ(thread.status(), absl::FailedPreconditionError("no EGL device with OpenGL 4.5"));
}

TEST(GlThread, RunsEveryJobItAcceptedInOrder) {
    std::vector<int> order;
    {
        auto thread = GlThread::start(fakeDrawers(std::make_shared<FakeDrawerControl>())).value();
        for (int i = 0; i < 50; ++i)
            ASSERT_TRUE(thread->post([&order, i](ChannelDrawer&) { order.push_back(i); }).ok());
    }
    ASSERT_EQ(order.size(), 50U);
    EXPECT_TRUE(std::is_sorted(order.begin(), order.end()));
}

TEST(GlThread, RefusesJobsBeyondItsBound) {
    auto control = std::make_shared<FakeDrawerControl>();
    auto thread = GlThread::start(fakeDrawers(control), 2).value();
    control->hold();
    const auto wait = [&](ChannelDrawer&) { control->waitWhileHeld(); };
    absl::Status status = absl::OkStatus();
    for (int i = 0; i < 4 && status.ok(); ++i) status = thread->post(wait);
    EXPECT_EQ(status.code(), absl::StatusCode::kResourceExhausted);
    control->release();
}

}  // namespace
}  // namespace eyrie::service
