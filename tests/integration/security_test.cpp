// SPDX-License-Identifier: Apache-2.0
// The real programs behind their doors: which they open, to whom, and what they say.
#include <cstdlib>
#include <filesystem>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/http_client.h"
#include "tests/support/program.h"
#include "tests/support/temporary_folder.h"

namespace eyrie {
namespace {

using std::chrono::seconds;
using testing::HasSubstr;
using testing::Not;

constexpr char kSecret[] = "0123456789abcdef0123456789abcdef";
constexpr char kScene[] = EYRIE_SOURCE_DIR "/demo/rocker_arm.ply";

class Doors : public testing::Test {
protected:
    std::string tokenFile(const std::string& name, const std::string& text,
                          unsigned mode = 0600) const {
        std::string file = folder_.write(name, text);
        std::filesystem::permissions(file, static_cast<std::filesystem::perms>(mode));
        return file;
    }

    std::vector<std::string> environment() const {
        return {"XDG_CACHE_HOME=" + folder_.path("cache")};
    }

    test::TemporaryFolder folder_;
};

/// The port behind the last ':' of a line of output that begins with `text`.
std::string portAfter(const std::string& output, const std::string& text) {
    const std::size_t begin = output.find(text);
    const std::string line = output.substr(begin, output.find('\n', begin) - begin);
    return std::to_string(std::atoi(line.c_str() + line.rfind(':') + 1));
}

TEST_F(Doors, StayShutOnOpenAddressesUntilSomebodySaysWhoMayCome) {
    for (const std::vector<std::string>& command :
         {std::vector<std::string>{"serve", kScene, "--listen", "0.0.0.0:0"},
          {"serve", kScene, "--listen", ":0"},
          {"coordinator", kScene, "--listen", "[::]:0"},
          {"coordinator", kScene, "--listen", "127.0.0.1:0", "--grpc", "0.0.0.0:0"},
          {"renderer", "--coordinator", "127.0.0.1:1", "--listen", "0.0.0.0:0"}}) {
        const test::Outcome outcome = test::eyrie(command, environment());
        EXPECT_EQ(outcome.exit, (test::Exit{2, 0})) << command[0] << " " << command[3];
        EXPECT_THAT(outcome.errors, HasSubstr("--token-file")) << command[0];
        EXPECT_THAT(outcome.errors, HasSubstr("--insecure")) << command[0];
    }
}

TEST_F(Doors, SayWhatIsWrongWithTokensAndCertificatesAndNeverQuoteASecret) {
    const std::string fine = fmt::format("view {}\n", kSecret);
    const std::vector<std::pair<std::vector<std::string>, std::string>> cases = {
        {{"--token-file", tokenFile("open", fine, 0644)}, "chmod 600"},
        {{"--token-file", tokenFile("bare", std::string(kSecret) + "\n")}, "line 1"},
        {{"--token-file", folder_.path("none")}, "--token-file"},
        {{"--token-file", tokenFile("view", fine)}, "a token of role admin"},
        {{"--tls-cert", kScene}, "--tls-cert and --tls-key go together"},
        {{"--tls-cert", kScene, "--tls-key", folder_.path("none")}, "none"},
        {{"--tls-name", "eyrie"}, "--tls-name goes with"}};
    for (const auto& [options, expected] : cases) {
        std::vector<std::string> command = {"coordinator", kScene,   "--listen",
                                            "127.0.0.1:0", "--grpc", "127.0.0.1:0"};
        command.insert(command.end(), options.begin(), options.end());
        const test::Outcome outcome = test::eyrie(command, environment());
        EXPECT_EQ(outcome.exit, (test::Exit{2, 0})) << expected;
        EXPECT_THAT(outcome.errors, HasSubstr(expected));
        EXPECT_THAT(outcome.errors, Not(HasSubstr(kSecret)));
    }
}

TEST_F(Doors, OpenToRenderersAndPagesThatHaveATokenAndToNobodyElse) {
    const std::string tokens = tokenFile("tokens", fmt::format("admin {}\n", kSecret));
    test::Process coordinator(test::eyrieCommand({"coordinator", kScene, "--listen", "127.0.0.1:0",
                                                  "--grpc", "127.0.0.1:0", "--token-file", tokens}),
                              environment());
    ASSERT_TRUE(coordinator.waitForOutput("Renderers register at", seconds(120)))
        << coordinator.errors();
    ASSERT_TRUE(coordinator.waitForOutput("\n", seconds(5)));
    const std::string grpc =
        "127.0.0.1:" + portAfter(coordinator.output(), "Renderers register at");
    const auto web =
        static_cast<std::uint16_t>(std::stoi(portAfter(coordinator.output(), "Eyrie is at")));

    const test::Outcome stranger = test::eyrie({"renderer", "--coordinator", grpc}, environment());
    EXPECT_EQ(stranger.exit, (test::Exit{1, 0}));
    EXPECT_THAT(stranger.errors, HasSubstr("needs a token"));
    const std::string wrong = tokenFile("wrong", "admin ffffffffffffffffffffffffffffffff\n");
    const test::Outcome liar =
        test::eyrie({"renderer", "--coordinator", grpc, "--token-file", wrong}, environment());
    EXPECT_EQ(liar.exit, (test::Exit{1, 0}));
    EXPECT_THAT(liar.errors, HasSubstr("not, or no longer, valid"));

    EXPECT_EQ(test::httpGet(web, "/healthz")->status, 200);
    EXPECT_EQ(test::httpGet(web, "/readyz")->status, 503) << "the strangers were let in";
    EXPECT_EQ(test::httpGet(web, "/api/v1/status")->status, 401);
    test::Process renderer(
        test::eyrieCommand({"renderer", "--coordinator", grpc, "--token-file", tokens}),
        environment());
    EXPECT_TRUE(test::eventually(seconds(60), [&] {
        const auto answer = test::httpGet(web, "/readyz");
        return answer.ok() && answer->status == 200;
    })) << renderer.errors();
    for (const test::Process* process : {&coordinator, &renderer}) {
        EXPECT_THAT(process->output() + process->errors(), Not(HasSubstr(kSecret)));
        EXPECT_THAT(process->output() + process->errors(), Not(HasSubstr("ffffffffffffffff")));
    }
}

}  // namespace
}  // namespace eyrie
