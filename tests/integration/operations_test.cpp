// SPDX-License-Identifier: Apache-2.0
// What an operator relies on: options from three places, a log for machines, a wall clock that may
// be set, and an end in time.
#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <signal.h>

#include "tests/support/http_client.h"
#include "tests/support/json.h"
#include "tests/support/program.h"
#include "tests/support/temporary_folder.h"

namespace eyrie {
namespace {

using std::chrono::seconds;
using testing::HasSubstr;

std::vector<std::string> linesOf(const std::string& text) {
    std::istringstream stream(text);
    std::vector<std::string> lines;
    for (std::string line; std::getline(stream, line);) lines.push_back(line);
    return lines;
}

TEST(Options, ComeFromTheCommandLineTheEnvironmentAndAFile) {
    const test::TemporaryFolder folder;
    std::ofstream(folder.path("eyrie.toml"))
        << "renderers = 3\ncache = \"/from/the/file\"\n[serve]\nlisten = \"127.0.0.1:1\"\n";
    const auto outcome = test::eyrie({"serve", "scene.json", "--print-config", "--renderers", "4"},
                                     {"EYRIE_OPTIONS=" + folder.path("eyrie.toml"),
                                      "EYRIE_CACHE=/environment", "EYRIE_SERVICE_HOST=10.0.0.1"});
    EXPECT_EQ(outcome.exit, (test::Exit{0, 0})) << outcome.errors;
    EXPECT_THAT(outcome.output, HasSubstr("renderers = 4  # the command line\n"));
    EXPECT_THAT(outcome.output, HasSubstr("cache = \"/environment\"  # EYRIE_CACHE\n"));
    EXPECT_THAT(outcome.output,
                HasSubstr("listen = \"127.0.0.1:1\"  # " + folder.path("eyrie.toml") + "\n"));
    EXPECT_THAT(outcome.output, HasSubstr("\n# cache-size = \"10G\"  # default\n"));
}

TEST(Options, SayWhereAWrongValueComesFrom) {
    const auto outcome = test::eyrie({"serve", "scene.json"}, {"EYRIE_RENDERERS=many"});
    EXPECT_EQ(outcome.exit, (test::Exit{2, 0}));
    EXPECT_THAT(outcome.errors, HasSubstr("--renderers comes from EYRIE_RENDERERS"));
}

TEST(Options, SayWhereAValueComesFromThatTheCommandRefuses) {
    const auto outcome = test::eyrie({"render", "scene.json", "-o", "a.png"},
                                     {"EYRIE_TAU=0", "EYRIE_CACHE=/environment"});
    EXPECT_EQ(outcome.exit, (test::Exit{2, 0}));
    EXPECT_THAT(outcome.errors, HasSubstr("--tau comes from EYRIE_TAU"));
    EXPECT_THAT(outcome.errors, testing::Not(HasSubstr("EYRIE_CACHE")));
    const auto other = test::eyrie({"render", "scene.json", "-o", "a.png", "--cache-size", "much"},
                                   {"EYRIE_CACHE=/environment"});
    EXPECT_THAT(other.errors,
                testing::AllOf(HasSubstr("--cache-size"), testing::Not(HasSubstr("EYRIE_CACHE"))));
}

TEST(Options, UnknownOnesInAFileAreRefusedWithWhatComesNear) {
    const test::TemporaryFolder folder;
    std::ofstream(folder.path("eyrie.toml")) << "[serve]\nrenderer = 3\n";
    const auto outcome =
        test::eyrie({"serve", "scene.json", "--options", folder.path("eyrie.toml")});
    EXPECT_EQ(outcome.exit, (test::Exit{2, 0}));
    EXPECT_THAT(outcome.errors, HasSubstr("did you mean 'renderers'?"));
}

/// The lines without where they are from.
std::vector<std::string> valuesIn(const std::string& printed) {
    std::vector<std::string> lines = linesOf(printed);
    for (std::string& line : lines) line.erase(std::min(line.size(), line.rfind("  # ")));
    return lines;
}

TEST(Options, OfEveryCommandAreReadAsTheyArePrinted) {
    const test::TemporaryFolder folder;
    for (const std::vector<std::string>& line : std::vector<std::vector<std::string>>{
             {"serve"},
             {"import", "terrain", "a.tif", "-o", "a.eyt"},
             {"import", "mesh", "a.ply", "-o", "a.eym"},
             {"info", "a.eyt"},
             {"check", "a.eqc"},
             {"render", "a.eyt", "-o", "a.png"},
             {"pick", "a.eyt", "--camera", "a.json", "--pixel", "1,2"},
             {"bench", "a.eyt", "--budget-ms", "33"},
             {"synth", "mesh", "--size", "9", "-o", "a.ply"},
             {"synth", "terrain", "--size", "9", "-o", "a.tif"},
             {"coordinator"},
             {"renderer", "--coordinator", "viz:9090"},
             {"health"}}) {
        std::vector<std::string> asked = line;
        asked.emplace_back("--print-config");
        const auto printed = test::eyrie(asked);
        ASSERT_EQ(printed.exit, (test::Exit{0, 0})) << line[0] << printed.errors;
        std::ofstream(folder.path("eyrie.toml")) << printed.output;
        // Of the line its command and its files.
        asked.erase(std::ranges::find_if(asked, [](const auto& word) { return word[0] == '-'; }),
                    asked.end());
        asked.insert(asked.end(), {"--print-config", "--options", folder.path("eyrie.toml")});
        const auto read = test::eyrie(asked);
        EXPECT_EQ(read.exit, (test::Exit{0, 0})) << line[0] << read.errors;
        EXPECT_EQ(valuesIn(read.output), valuesIn(printed.output));
    }
}

TEST(Options, OfNumbersBetweenCommasLeaveTheSceneBehindThemAlone) {
    for (const char* option : {"--tau", "--budget-ms", "--renderers"}) {
        const auto outcome =
            test::eyrie({"bench", option, "1,2", "a.eyt", "-o", "report", "--print-config"});
        EXPECT_EQ(outcome.exit, (test::Exit{0, 0})) << outcome.errors;
    }
}

TEST(JsonLog, HasTheSameFieldsInEveryLine) {
    const auto outcome = test::eyrie({"info", "/nowhere/\"x\"\xff.eyt", "--log-format", "json"});
    EXPECT_NE(outcome.exit, (test::Exit{0, 0}));
    const std::vector<std::string> lines = linesOf(outcome.errors);
    ASSERT_FALSE(lines.empty());
    for (const std::string& line : lines) {
        const test::JsonValue entry = test::parseJson(line);
        for (const char* field : {"time", "level", "command", "message"})
            EXPECT_FALSE(test::at(entry, field).string_value().empty()) << line;
        EXPECT_GT(test::number(entry, "process"), 0);
        EXPECT_GT(test::number(entry, "thread"), 0);
        EXPECT_EQ(test::at(entry, "command").string_value(), "info");
    }
}

/// `eyrie serve` of the demo's scene.
class Served : public testing::Test {
protected:
    void start(std::vector<std::string> environment) {
        std::filesystem::create_directory(folder_.path("tmp"));
        environment.push_back("TMPDIR=" + folder_.path("tmp"));
        environment.push_back("XDG_CACHE_HOME=" + folder_.path("cache"));
        server_ = std::make_unique<test::Process>(
            test::eyrieCommand({"serve", EYRIE_SOURCE_DIR "/demo/scene.json", "--listen",
                                "127.0.0.1:0", "--renderers", "2", "--log-format", "json"}),
            environment);
        ASSERT_TRUE(server_->waitForOutput("Eyrie is at http://", seconds(60)) &&
                    server_->waitForOutput("/\n", seconds(1)))
            << server_->output() << server_->errors();
        const std::string line = server_->output();
        port_ = static_cast<std::uint16_t>(
            std::atoi(line.c_str() + line.find(':', line.find("http://") + 7) + 1));
        ASSERT_TRUE(test::eventually(seconds(60), [&] { return conditions()["ready"] == 2; }))
            << server_->errors();
    }

    /// How many renderers /metrics says are in each.
    std::map<std::string, int> conditions() const {
        std::map<std::string, int> counts;
        const auto answer = test::httpGet(port_, "/metrics");
        if (!answer.ok())
            return counts;
        constexpr std::string_view kSeries = "eyrie_renderers{condition=\"";
        for (const std::string& line : linesOf(answer->body))
            if (line.starts_with(kSeries)) {
                const std::size_t end = line.find('"', kSeries.size());
                counts[line.substr(kSeries.size(), end - kSeries.size())] =
                    std::atoi(line.c_str() + end + 2);
            }
        return counts;
    }

    const test::TemporaryFolder folder_;
    std::unique_ptr<test::Process> server_;
    std::uint16_t port_ = 0;
};

TEST_F(Served, GoesOnWhileTheWallClockJumps) {
    start({"LD_PRELOAD=" EYRIE_JUMPING_CLOCK});
    const auto children = test::childrenOf(server_->id());
    const auto until = std::chrono::steady_clock::now() + seconds(5);
    while (std::chrono::steady_clock::now() < until) {
        EXPECT_EQ(conditions()["dead"], 0) << server_->errors();
        std::this_thread::sleep_for(std::chrono::milliseconds(200));
    }
    EXPECT_TRUE(test::eventually(seconds(60), [&] { return conditions()["ready"] == 2; }))
        << server_->errors();
    EXPECT_EQ(test::childrenOf(server_->id()), children);
    server_->send(SIGTERM);
    EXPECT_EQ(server_->waitFor(seconds(30)), (test::Exit{0, 0})) << server_->errors();
}

TEST_F(Served, EndsInTimeAlthoughItsRenderersHang) {
    start({});
    const auto renderers = test::childrenOf(server_->id());
    ASSERT_FALSE(renderers.empty());
    for (const pid_t renderer : renderers) kill(renderer, SIGSTOP);
    server_->send(SIGTERM);
    EXPECT_EQ(server_->waitFor(seconds(30)), (test::Exit{0, 0})) << server_->errors();
    for (const pid_t renderer : renderers) EXPECT_FALSE(test::isAlive(renderer));
    EXPECT_NE(server_->errors().find("\"message\": \"drawing with "), std::string::npos)
        << server_->errors();
    for (const std::string& line : linesOf(server_->errors()))
        EXPECT_TRUE(!line.starts_with("{") || test::parseJson(line).has_struct_value()) << line;
}

}  // namespace
}  // namespace eyrie
