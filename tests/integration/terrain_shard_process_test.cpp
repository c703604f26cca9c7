// SPDX-License-Identifier: Apache-2.0
// An import spread over processes, as machines that share a folder run it.
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>

#include <gtest/gtest.h>
#include <signal.h>

#include "tests/support/program.h"
#include "tests/support/temporary_folder.h"

namespace eyrie {
namespace {

using std::chrono::seconds;
using Words = std::vector<std::string>;

class TerrainShardProcesses : public testing::Test {
protected:
    void SetUp() override {
        ASSERT_TRUE(test::succeeded(
            {"synth", "terrain", "--size", "1600", "-o", folder_.path("dem.tif"), "--quiet"}));
        ASSERT_TRUE(test::succeeded(importInto("whole.eyt", {})));
    }
    Words importInto(const std::string& out, const Words& more) const {
        Words words = {"import",  "terrain", folder_.path("dem.tif"), "-o", folder_.path(out),
                       "--error", "2"};
        words.insert(words.end(), more.begin(), more.end());
        return words;
    }
    std::string bytesOf(const std::string& name) const {
        std::ifstream file(folder_.path(name), std::ios::binary);
        return {std::istreambuf_iterator<char>(file), {}};
    }

    test::TemporaryFolder folder_;
};

TEST_F(TerrainShardProcesses, MakeTheSameFileAllAtOnceOneOfThemTwiceAndOneKilled) {
    std::vector<std::unique_ptr<test::Process>> shards;
    for (const char* shard : {"0/3", "1/3", "2/3", "1/3"})
        shards.push_back(std::make_unique<test::Process>(
            test::eyrieCommand(importInto("dem.eyt", {"--shard", shard, "--threads", "1"}))));
    ASSERT_TRUE(test::eventually(seconds(60), [&] {
        return shards[0]->errors().find("measuring") != std::string::npos;
    })) << shards[0]->errors();
    shards[0]->send(SIGKILL);
    ASSERT_TRUE(shards[0]->waitFor(seconds(20)).has_value());
    for (std::size_t k = 1; k < shards.size(); ++k)
        EXPECT_EQ(shards[k]->waitFor(seconds(120)), (test::Exit{0, 0})) << shards[k]->errors();

    const test::Outcome early = test::eyrie(importInto("dem.eyt", {"--merge"}));
    EXPECT_EQ(early.exit, (test::Exit{2, 0})) << early.errors;
    EXPECT_NE(early.errors.find("--shard 0/3"), std::string::npos) << early.errors;
    EXPECT_FALSE(std::filesystem::exists(folder_.path("dem.eyt")));

    ASSERT_TRUE(test::succeeded(importInto("dem.eyt", {"--shard", "0/3"})));
    ASSERT_TRUE(test::succeeded(importInto("dem.eyt", {"--merge"})));
    EXPECT_TRUE(bytesOf("dem.eyt") == bytesOf("whole.eyt"));
    EXPECT_EQ(test::namesIn(folder_.path()),
              (std::set<std::string>{"dem.eyt", "dem.eyt.source", "dem.tif", "whole.eyt",
                                     "whole.eyt.source"}));
}

TEST_F(TerrainShardProcesses, SayWhatTheyMade) {
    const test::Outcome made =
        test::eyrie(importInto("dem.eyt", {"--shard", "1/2", "--json", "--quiet"}));
    ASSERT_EQ(made.exit, (test::Exit{0, 0})) << made.errors;
    EXPECT_NE(made.output.find("\"shard\": 1"), std::string::npos) << made.output;
    EXPECT_NE(made.output.find("shard-1-of-2"), std::string::npos) << made.output;
    EXPECT_NE(made.output.find("\"notes\": []"), std::string::npos) << made.output;
    const test::Outcome again = test::eyrie(importInto("dem.eyt", {"--shard", "1/2"}));
    EXPECT_NE(again.errors.find("is there already"), std::string::npos) << again.errors;
}

TEST_F(TerrainShardProcesses, RefuseShardsThatThereAreNot) {
    for (const char* wrong : {"4/4", "0/0", "-1/4", "1", "1/", "/4", "a/b", "0/513", "1/4/2"}) {
        const test::Outcome outcome = test::eyrie(importInto("dem.eyt", {"--shard", wrong}));
        EXPECT_NE(outcome.exit, (test::Exit{0, 0})) << wrong;
        EXPECT_NE(outcome.errors.find("--shard"), std::string::npos) << outcome.errors;
        EXPECT_FALSE(std::filesystem::exists(folder_.path("dem.eyt.parts"))) << wrong;
    }
    EXPECT_NE(test::eyrie(importInto("dem.eyt", {"--shard", "0/2", "--merge"})).exit,
              (test::Exit{0, 0}));
}

}  // namespace
}  // namespace eyrie
