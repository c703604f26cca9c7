// SPDX-License-Identifier: Apache-2.0
#include "service/data_places.h"

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/temporary_folder.h"

namespace eyrie::service {
namespace {

DataPlaces parsed(const std::vector<std::string>& rules) {
    auto places = DataPlaces::parse(rules);
    EXPECT_TRUE(places.ok()) << places.status();
    return *std::move(places);
}

TEST(DataPlaces, LeavePathsAloneWithoutARule) {
    EXPECT_EQ(DataPlaces().placed("/data/dem.eyt"), "/data/dem.eyt");
    EXPECT_EQ(parsed({"/data=/mnt"}).placed("/other/dem.eyt"), "/other/dem.eyt");
}

TEST(DataPlaces, ReplaceFoldersAndNotWhatBeginsLikeThem) {
    const DataPlaces places = parsed({"/data=/mnt/fast", "https://a.example/=/srv/"});
    EXPECT_EQ(places.placed("/data/alps/dem.eyt"), "/mnt/fast/alps/dem.eyt");
    EXPECT_EQ(places.placed("/data"), "/mnt/fast");
    EXPECT_EQ(places.placed("/database/dem.eyt"), "/database/dem.eyt");
    EXPECT_EQ(places.placed("https://a.example/dem.eyt"), "/srv/dem.eyt");
    EXPECT_EQ(places.placed("https://a.example.org/dem.eyt"), "https://a.example.org/dem.eyt");
}

TEST(DataPlaces, TakeTheLongestOnce) {
    const DataPlaces places =
        parsed({"/data=/a", "/data/alps/dem.eyt=/b.eyt", "/data/alps=/data/new"});
    EXPECT_EQ(places.placed("/data/alps/dem.eyt"), "/b.eyt");
    EXPECT_EQ(places.placed("/data/alps/other.eyt"), "/data/new/other.eyt");
    EXPECT_EQ(places.placed("/data/x.eyt"), "/a/x.eyt");
}

TEST(DataPlaces, KeepWhatComesAfterTheFirstEquals) {
    EXPECT_EQ(parsed({"/data=https://a.example/?v=2&f="}).placed("/data/x"),
              "https://a.example/?v=2&f=/x");
}

TEST(DataPlaces, OfHalfARuleOrTwoForOneAreRefusedByName) {
    for (const char* rule : {"", "=", "/data", "/data=", "=/mnt"}) {
        const auto places = DataPlaces::parse(std::vector<std::string>{"/a=/b", rule});
        EXPECT_EQ(places.status().code(), absl::StatusCode::kInvalidArgument) << rule;
        EXPECT_NE(places.status().message().find("FROM=TO"), std::string::npos);
    }
    const auto twice = DataPlaces::parse(std::vector<std::string>{"/a=/b", "/a=/c"});
    EXPECT_NE(twice.status().message().find("/a has a place already"), std::string::npos);
}

TEST(DataPlaces, FindTheLongestEndOfAPathInTheirFolder) {
    const test::TemporaryFolder folder;
    std::filesystem::create_directories(folder.path("alps"));
    for (const char* name : {"dem.eyt", "alps/dem.eyt", "scan.eym"}) folder.write(name, "");
    DataPlaces places = parsed({"/data/scan.eym=/mnt/scan.eym"});
    ASSERT_TRUE(places.lookIn(folder.path()).ok());
    EXPECT_EQ(places.placed("/data/alps/dem.eyt"), folder.path("alps/dem.eyt"));
    EXPECT_EQ(places.placed("/data/andes/dem.eyt"), folder.path("dem.eyt"));
    EXPECT_EQ(places.placed("/data/alps"), "/data/alps") << "a folder";
    std::filesystem::create_directories(folder.path("inner"));
    DataPlaces inner;
    ASSERT_TRUE(inner.lookIn(folder.path("inner")).ok());
    EXPECT_EQ(inner.placed("/data/../dem.eyt"), "/data/../dem.eyt") << "beside the folder";
    EXPECT_EQ(places.placed("/data/alps/other.eyt"), "/data/alps/other.eyt");
    EXPECT_EQ(places.placed("/data/scan.eym"), "/mnt/scan.eym") << "the rule is for it alone";
    EXPECT_EQ(places.placed("https://a.example/dem.eyt"), "https://a.example/dem.eyt");
}

TEST(DataPlaces, LookInNothingThatIsNoFolder) {
    const absl::Status status = DataPlaces().lookIn("/nowhere/at/all");
    EXPECT_EQ(status.code(), absl::StatusCode::kInvalidArgument);
    EXPECT_NE(status.message().find("/nowhere/at/all: is no folder"), std::string::npos);
}

}  // namespace
}  // namespace eyrie::service
