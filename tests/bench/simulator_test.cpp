// SPDX-License-Identifier: Apache-2.0
// The program as its users run it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/process.h"
#include "tests/support/temporary_folder.h"

namespace eyrie::simulator {
namespace {

test::Outcome simulator(std::vector<std::string> arguments) {
    const std::string data = EYRIE_SOURCE_DIR "/bench/data/";
    std::vector<std::string> command = {EYRIE_SIMULATOR, data + "costs.csv",
                                        data + "dragon_orbit.csv"};
    command.insert(command.end(), arguments.begin(), arguments.end());
    return test::run(command, std::chrono::minutes(1));
}

std::string plain(const std::string& compound) {
    return "config { appNode { pipe { window { viewport [ 0 0 1280 720 ] channel { name \"a\" } } "
           "} "
           "} layout { view { } } canvas { layout 0 segment { channel \"a\" } } compound { channel "
           "( segment 0 view 0 ) " +
           compound + " } }";
}

TEST(Simulator, TellsWhatItsConfigurationHasWithoutEffect) {
    const test::TemporaryFolder folder;
    const std::string file = folder.write("a.eqc", plain("inputframe { name \"nobody's\" }"));
    const test::Outcome outcome = simulator({"--config", file});
    EXPECT_EQ(outcome.exit, (test::Exit{0, 0}));
    EXPECT_THAT(outcome.output, testing::HasSubstr("frames a second"));
    EXPECT_THAT(outcome.errors, testing::HasSubstr("is named \"nobody's\""));
}

TEST(Simulator, TellsNothingOfItsOwnConfigurations) {
    EXPECT_EQ(simulator({"--renderers", "1,2,3,4,16"}).errors, "");
}

TEST(Simulator, TakesNoPicturesSizeBesideAConfigurations) {
    const test::TemporaryFolder folder;
    const std::string file = folder.write("a.eqc", plain(""));
    EXPECT_EQ(simulator({"--config", file}).exit, (test::Exit{0, 0}));
    for (const std::string option : {"--width", "--height", "--renderers"}) {
        const test::Outcome outcome = simulator({"--config", file, option, "4"});
        EXPECT_NE(outcome.exit.status, 0) << option;
        EXPECT_THAT(outcome.errors, testing::HasSubstr("--config excludes " + option));
    }
}

}  // namespace
}  // namespace eyrie::simulator
