// SPDX-License-Identifier: Apache-2.0
#include "cli/lost_bytes.h"

#include <filesystem>
#include <string>

#include <gtest/gtest.h>

#include "renderer/import/mesh_reader.h"
#include "renderer/import/mesh_synth.h"
#include "renderer/import/ply_writer.h"
#include "tests/support/temporary_folder.h"

namespace eyrie::cli {
namespace {

TEST(LostBytes, OfASourceThatIsCutWhileItIsReadAreSaid) {
    GTEST_FLAG_SET(death_test_style, "threadsafe");
    const test::TemporaryFolder folder;
    const std::string ball = folder.path("ball.ply");
    ASSERT_TRUE(import::writePly(import::synthesizeMesh(2000, 1), ball).ok());
    const auto cut = [&](std::string_view, double) { std::filesystem::resize_file(ball, 0); };
    EXPECT_EXIT(
        {
            sayWhereBytesAreLost();
            import::readMesh(ball, {cut, {}}).IgnoreError();
        },
        testing::ExitedWithCode(1), "^eyrie: a file that was being read became shorter");
}

}  // namespace
}  // namespace eyrie::cli
