// SPDX-License-Identifier: Apache-2.0
#include "coordinator/frame/crew.h"

#include <gtest/gtest.h>

#include "fake_renderer.h"
#include "tests/service/eventually.h"
#include "tests/support/captured_log.h"

namespace eyrie::coordinator {
namespace {

TEST(Crew, TellsTheLogOnceThatDataCannotBeHad) {
    auto renderer = std::make_shared<FakeRenderer>(std::make_shared<LayeredScene>(1));
    renderer->failToOpen(absl::AbortedError("http://host/a.eym: no answer"));
    fabric::Scene scene;
    scene.objects.push_back({"a", fabric::ObjectKind::Mesh, "a.eym", fabric::Mat4(1.0), {}});
    Registry registry;
    const test::CapturedLog log;
    {
        Crew crew(registry, {}, [] {});
        crew.setScene(scene);
        ASSERT_TRUE(registry.add("fake:0", {}, renderer, Registry::Clock::now()).ok());
        EXPECT_TRUE(eventually([&] {
            crew.openAgain(Registry::Clock::time_point::max());
            return renderer->asked >= 4;
        }));
    }
    EXPECT_EQ(log.count("cannot take part"), 1) << log.text();
}

}  // namespace
}  // namespace eyrie::coordinator
