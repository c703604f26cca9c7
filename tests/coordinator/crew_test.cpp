// SPDX-License-Identifier: Apache-2.0
#include "coordinator/frame/crew.h"

#include <gtest/gtest.h>

#include "fake_renderer.h"
#include "tests/service/eventually.h"
#include "tests/support/captured_log.h"

namespace eyrie::coordinator {
namespace {

fabric::Scene sceneNamed(const std::string& name) {
    fabric::Scene scene;
    scene.objects.push_back({name, fabric::ObjectKind::Mesh, "a.eym", fabric::Mat4(1.0), {}});
    return scene;
}

TEST(Crew, TellsTheLogOnceThatDataCannotBeHad) {
    auto renderer = std::make_shared<FakeRenderer>(std::make_shared<LayeredScene>(1));
    renderer->failToOpen(absl::AbortedError("http://host/a.eym: no answer"));
    Registry registry;
    const test::CapturedLog log;
    {
        Crew crew(registry, {}, [] {});
        crew.setScene(sceneNamed("a"));
        ASSERT_TRUE(registry.add("fake:0", {}, renderer, Registry::Clock::now()).ok());
        EXPECT_TRUE(eventually([&] {
            crew.openAgain(Registry::Clock::time_point::max());
            return renderer->asked >= 4;
        }));
    }
    EXPECT_EQ(log.count("cannot take part"), 1) << log.text();
}

TEST(Crew, OpensOfTheScenesSetMeanwhileTheLastAlone) {
    auto renderer = std::make_shared<FakeRenderer>(std::make_shared<LayeredScene>(1));
    renderer->holdOpening(true);
    Registry registry;
    Crew crew(registry, {}, [] {});
    crew.setScene(sceneNamed("first"));
    ASSERT_TRUE(registry.add("fake:0", {}, renderer, Registry::Clock::now()).ok());
    ASSERT_TRUE(eventually([&] { return renderer->asked == 1; }));
    for (const char* name : {"second", "third", "last"}) crew.setScene(sceneNamed(name));
    renderer->holdOpening(false);
    EXPECT_TRUE(eventually([&] { return crew.state().ready == 1; }));
    EXPECT_EQ(renderer->opened, (std::vector<std::string>{"first", "last"}));
}

TEST(Crew, HasARendererThatTakesTooLongToOpenTheSceneTryAgain) {
    auto renderer = std::make_shared<FakeRenderer>(std::make_shared<LayeredScene>(1));
    renderer->failToOpen(absl::DeadlineExceededError("not open after 120 s"));
    Registry registry;
    Crew crew(registry, {}, [] {});
    crew.setScene(sceneNamed("a"));
    ASSERT_TRUE(registry.add("fake:0", {}, renderer, Registry::Clock::now()).ok());
    EXPECT_TRUE(eventually([&] { return !crew.state().openError.empty(); }));
    const RendererStatus status = crew.renderers().front();
    EXPECT_EQ(status.condition, RendererCondition::Refused);
    EXPECT_EQ(status.why, "not open after 120 s");
    EXPECT_TRUE(registry.entries().front().isAlive()) << "its heartbeats come";
    renderer->failToOpen(absl::OkStatus());
    EXPECT_TRUE(eventually([&] {
        crew.openAgain(Registry::Clock::time_point::max());
        return crew.state().ready == 1;
    }));
}

}  // namespace
}  // namespace eyrie::coordinator
