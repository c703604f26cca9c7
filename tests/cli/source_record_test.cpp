// SPDX-License-Identifier: Apache-2.0
#include "cli/source_record.h"

#include <gtest/gtest.h>

#include "tests/support/temporary_folder.h"

namespace eyrie::cli {
namespace {

using Names = std::vector<std::string>;

TEST(SourceRecord, HasAddressesAsAnybodyMaySeeThem) {
    const test::TemporaryFolder folder;
    const std::string imported = folder.path("a.eyt");
    const Names shown{"http://…@host/a.tif?…", "/data/b?.tif"};
    ASSERT_TRUE(
        recordSources(imported, {"http://joe:sekret@host/a.tif?sig=1", "/data/b?.tif"}).ok());
    EXPECT_EQ(recordedSources(imported), shown);
    ASSERT_TRUE(recordSources(imported, {"http://joe@host/a.tif?sig=2", "/data/b?.tif"}).ok());
    EXPECT_EQ(recordedSources(imported), shown);
}

}  // namespace
}  // namespace eyrie::cli
