// SPDX-License-Identifier: Apache-2.0
#include "coordinator/frame/active_configuration.h"

#include <gmock/gmock.h>

#include "coordinator/config/eqc_reader.h"

namespace eyrie::coordinator {
namespace {

using testing::HasSubstr;

config::Configuration read(const std::string& text) {
    config::Findings findings;
    config::Configuration configuration = config::readEqc(text, findings);
    EXPECT_FALSE(findings.hasErrors()) << describe(findings, "test");
    return configuration;
}

/// Two layouts, of which the second, with a wall one metre off and an observer whose left eye is
/// two metres off, is not shown.
ActiveConfiguration hiddenWall() {
    return ActiveConfiguration(
        read("config { appNode { pipe { window { channel { name \"0\" } } } } "
             "observer { eye_left [ 0 0 -2 ] } layout { name \"plain\" view {} } "
             "layout { name \"wall\" view { observer 0 "
             "wall { bottom_left [ -1 -1 -1 ] bottom_right [ 1 -1 -1 ] top_left [ -1 1 -1 ] } } } "
             "canvas { layout \"plain\" layout \"wall\" segment { channel \"0\" } } }"));
}

void expectRefused(ActiveConfiguration& active, const config::ViewState& settings) {
    const config::ConfigurationState before = active.state();
    const absl::Status status = active.setView("wall", "0", settings);
    EXPECT_TRUE(absl::IsInvalidArgument(status)) << status;
    EXPECT_THAT(std::string(status.message()), HasSubstr("not before the wall"));
    EXPECT_EQ(active.state(), before);
    EXPECT_TRUE(active.plan({}, 1, {}).ok());
    ASSERT_TRUE(active.switchLayout("0", "wall").ok());
    EXPECT_TRUE(active.plan({}, 2, {}).ok());
}

TEST(ActiveConfiguration, RefusesAWallBehindAnEyeEvenWhereItIsNotShown) {
    ActiveConfiguration active = hiddenWall();
    config::ViewState settings;
    settings.surface = config::Wall{{-1, -1, 1}, {1, -1, 1}, {-1, 1, 1}};
    expectRefused(active, settings);
}

TEST(ActiveConfiguration, RefusesToShowAnEyeThatIsBehindTheWall) {
    ActiveConfiguration active = hiddenWall();
    config::ViewState settings;
    settings.isStereo = true;
    expectRefused(active, settings);
}

}  // namespace
}  // namespace eyrie::coordinator
