// SPDX-License-Identifier: Apache-2.0
// The real programs behind their doors: which they open, to whom, and what they say.
#include <cstdlib>
#include <filesystem>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/certificates.h"
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
          {"serve", kScene, "--listen", "127.0.0.1:0", "--grpc", "0.0.0.0:0"},
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

/// They reach their coordinator over a socket that only its user does.
TEST_F(Doors, AreNotThoseOfRenderersThatACommandStarts) {
    const test::Authority authority("the authority");
    const access::TlsFiles files = authority.issue("doors");
    for (const std::vector<std::string>& variables :
         {std::vector<std::string>{"EYRIE_TOKEN_FILE=" +
                                   tokenFile("view", fmt::format("view {}\n", kSecret))},
          {"EYRIE_TLS_CERT=" + files.certificate, "EYRIE_TLS_KEY=" + files.key,
           "EYRIE_TLS_CA=" + files.authority, "EYRIE_TLS_NAME=elsewhere.example"}}) {
        std::vector<std::string> all = environment();
        all.insert(all.end(), variables.begin(), variables.end());
        const test::Outcome outcome = test::eyrie(
            {"render", kScene, "--size", "64x48", "--renderers", "1", "-o", folder_.path("a.png")},
            all);
        EXPECT_EQ(outcome.exit, (test::Exit{0, 0})) << variables[0] << "\n" << outcome.errors;
    }
}

TEST_F(Doors, OfPublishedPortsAnswerToNoStrangersName) {
    for (const std::vector<std::string>& program :
         {std::vector<std::string>{"serve"}, {"coordinator", "--grpc", "127.0.0.1:0"}}) {
        std::vector<std::string> command = program;
        command.insert(command.end(),
                       {"--listen", "0.0.0.0:0", "--insecure", "--local-names-only"});
        test::Process server(test::eyrieCommand(command), environment());
        ASSERT_TRUE(server.waitForOutput("/\n", seconds(120))) << server.errors();
        const auto web =
            static_cast<std::uint16_t>(std::stoi(portAfter(server.output(), "Eyrie is at")));
        EXPECT_EQ(test::httpGet(web, "/api/v1/status")->status, 200);
        EXPECT_EQ(test::httpGet(web, "http://evil.example/api/v1/status")->status, 403);
    }
}

/// The command line's part that shows `files`.
std::vector<std::string> showing(const access::TlsFiles& files) {
    return {"--tls-cert", files.certificate, "--tls-key", files.key, "--tls-ca", files.authority};
}

std::vector<std::string> operator+(std::vector<std::string> words,
                                   const std::vector<std::string>& more) {
    words.insert(words.end(), more.begin(), more.end());
    return words;
}

/// curl from 127.0.0.`host`, in the way of gRPC. What comes.
std::string curl(int host, const std::vector<std::string>& arguments) {
    return test::run(
               std::vector<std::string>{"/usr/bin/env", "curl", "--silent", "--http2", "--max-time",
                                        "20", "--interface", fmt::format("127.0.0.{}", host)} +
                   arguments,
               seconds(30))
        .output;
}

/// Who knocks at doors that ask for certificates of one authority.
class CertificateDoors : public Doors {
protected:
    /// Plain text, no certificate, one of nobody's, and an expired one, each from an address of its
    /// own: 127.0.0.`host` and the next three.
    void knockWrongly(const std::string& port, int host) const {
        const std::string place = "127.0.0.1:" + port;
        curl(host, {"http://" + place});
        const std::vector<std::string> believing = {"--cacert", authority_.file(),
                                                    "https://" + place};
        curl(host + 1, believing);
        const access::TlsFiles foreign = other_.issue("foreign");
        curl(host + 2, believing + std::vector<std::string>{"--cert", foreign.certificate, "--key",
                                                            foreign.key});
        const access::TlsFiles old = authority_.issue("old", {.validToSeconds = -1800});
        curl(host + 3,
             believing + std::vector<std::string>{"--cert", old.certificate, "--key", old.key});
    }

    /// Waits for /metrics to have `count` of them.
    bool counts(const std::string& web, const std::string& door, int count) const {
        const std::string line = fmt::format(
            "eyrie_peers_refused_total{{door=\"{}\",reason=\"handshake\"}} {}\n", door, count);
        return test::eventually(seconds(20), [&] {
            return curl(1, {"--cacert", authority_.file(), "https://127.0.0.1:" + web + "/metrics"})
                       .find(line) != std::string::npos;
        });
    }

    static void expectTold(const test::Process& process, int host) {
        const auto told = [&](int from, const std::string& why) {
            const std::string line =
                fmt::format("no encrypted connection with 127.0.0.{}: {}; more", from, why);
            EXPECT_TRUE(test::eventually(
                seconds(10), [&] { return process.errors().find(line) != std::string::npos; }))
                << line << "\n"
                << process.errors();
        };
        told(host, "http request");
        told(host + 1, "peer did not return a certificate");
        told(host + 2, "certificate verify failed");
        told(host + 3, "certificate verify failed");
    }

    const test::Authority authority_{"the authority"};
    const test::Authority other_{"another authority"};
};

TEST_F(CertificateDoors, OfCoordinatorAndRenderersCountAndTellWhomTheyRefuse) {
    const std::vector<std::string> mutual = showing(authority_.issue("node"));
    test::Process coordinator(
        test::eyrieCommand(std::vector<std::string>{"coordinator", kScene, "--listen",
                                                    "127.0.0.1:0", "--grpc", "127.0.0.1:0"} +
                           mutual),
        environment());
    ASSERT_TRUE(coordinator.waitForOutput("Renderers register at", seconds(120)) &&
                coordinator.waitForOutput("\n", seconds(5)))
        << coordinator.errors();
    const std::string grpc = portAfter(coordinator.output(), "Renderers register at");
    const std::string web = portAfter(coordinator.output(), "Eyrie is at");
    EXPECT_TRUE(counts(web, "grpc", 0));
    knockWrongly(grpc, 2);
    expectTold(coordinator, 2);
    EXPECT_TRUE(counts(web, "grpc", 4));
    curl(2, {"http://127.0.0.1:" + grpc});  // once more
    EXPECT_TRUE(counts(web, "grpc", 5));
    const std::string log = coordinator.errors();
    EXPECT_EQ(log.find("with 127.0.0.2: "), log.rfind("with 127.0.0.2: ")) << log;

    test::Process renderer(
        test::eyrieCommand(
            std::vector<std::string>{"renderer", "--coordinator", "127.0.0.1:" + grpc} + mutual),
        environment());
    ASSERT_TRUE(test::eventually(seconds(60), [&] {
        return renderer.errors().find("registered with the") != std::string::npos;
    })) << renderer.errors();
    knockWrongly(portAfter(renderer.errors(), "drawing with"), 12);
    expectTold(renderer, 12);
    EXPECT_TRUE(counts(web, "renderer", 4));
    EXPECT_TRUE(counts(web, "grpc", 5)) << "those at a renderer are not the coordinator's";
}

TEST_F(CertificateDoors, OfServeOpenToProgramsByCertificatesAloneAndTakeReplacedOnes) {
    const access::TlsFiles files = authority_.issue("serve");
    const std::vector<std::string> command = {"serve",  kScene,      "--listen",    "127.0.0.1:0",
                                              "--grpc", "0.0.0.0:0", "--renderers", "1"};
    const test::Outcome oneSided = test::eyrie(
        command + std::vector<std::string>{"--tls-cert", files.certificate, "--tls-key", files.key},
        environment());
    EXPECT_EQ(oneSided.exit, (test::Exit{2, 0})) << "nobody shows who calls";
    EXPECT_THAT(oneSided.errors, HasSubstr("--tls-ca"));

    test::Process serve(test::eyrieCommand(command + showing(files)), environment());
    ASSERT_TRUE(serve.waitForOutput("Programs call by gRPC at", seconds(120)) &&
                serve.waitForOutput("\n", seconds(5)))
        << serve.errors();
    EXPECT_THAT(serve.errors(), Not(HasSubstr("everybody who reaches this address")));
    const std::string port = portAfter(serve.output(), "Programs call by gRPC at");
    const auto health = [&](const std::vector<std::string>& more) {
        return test::eyrie(
                   std::vector<std::string>{"health", "127.0.0.1:" + port, "--limit", "30"} + more)
            .exit;
    };
    const std::vector<std::string> known = showing(authority_.issue("program"));
    EXPECT_EQ(health(known), (test::Exit{0, 0}));
    EXPECT_EQ(health({"--tls-ca", files.authority}), (test::Exit{1, 0})) << "shows none";
    EXPECT_EQ(health({}), (test::Exit{1, 0})) << "in the clear";
    knockWrongly(port, 2);
    expectTold(serve, 2);

    // For another host, so that it shows which one is used.
    authority_.issue("serve", {.name = "elsewhere.example"});
    const std::vector<std::string> elsewhere =
        known + std::vector<std::string>{"--tls-name", "elsewhere.example"};
    EXPECT_TRUE(test::eventually(seconds(20), [&] {
        return health(elsewhere) == test::Exit{0, 0};
    })) << "the new certificate is not taken";
    EXPECT_EQ(health(known), (test::Exit{1, 0}));
    EXPECT_THAT(
        curl(1, {"--cacert", files.authority, "--insecure",
                 "https://127.0.0.1:" + portAfter(serve.output(), "Eyrie is at") + "/readyz"}),
        HasSubstr("\"ready\""))
        << "the renderers, which serve started, are still there";
}

}  // namespace
}  // namespace eyrie
