// SPDX-License-Identifier: Apache-2.0
#include "coordinator/frame/for_anybody.h"

#include <gtest/gtest.h>

namespace eyrie::coordinator {
namespace {

fabric::Scene sceneOf(const std::vector<std::pair<std::string, std::string>>& namesAndPaths) {
    fabric::Scene scene;
    for (const auto& [name, path] : namesAndPaths)
        scene.objects.push_back({name, fabric::ObjectKind::Mesh, path, fabric::Mat4(1.0), {}});
    return scene;
}

TEST(ForAnybody, DataHaveTheirNamesAndRenderersTheirIds) {
    const fabric::Scene scene = sceneOf({{"hill", "/srv/a.eyt"},
                                         {"/srv/a.eyt", "/srv/a.eyt2"},
                                         {"", "https://me:secret@host/c.eym?signature=x"},
                                         {"page", "page"}});
    const auto told = [&](const std::string& said, const std::string& address) {
        const absl::Status status =
            forAnybody(absl::DataLossError(said), scene, "renderer-2", address);
        EXPECT_TRUE(absl::IsDataLoss(status));
        return std::string(status.message());
    };
    EXPECT_EQ(told("renderer at unix:/run/e/2: /srv/a.eyt: page 7 is damaged", "unix:/run/e/2"),
              "renderer-2: hill: page 7 is damaged");
    EXPECT_EQ(told("'/srv/a.eyt2', /srv/b.eyt, no unix:/run/e/2", "unix:/run/e/2"),
              "'/srv/a.eyt', /srv/b.eyt, no renderer-2");
    EXPECT_EQ(
        told("https://me:secret@host/c.eym?signature=x: HTTP 503; https://…@host/c.eym?…: no", ""),
        ": HTTP 503; : no");
    EXPECT_EQ(told("", ""), "");
}

}  // namespace
}  // namespace eyrie::coordinator
