// SPDX-License-Identifier: Apache-2.0
// `eyrie health`, as containers ask it.
#include <arpa/inet.h>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <signal.h>
#include <sys/socket.h>
#include <unistd.h>

#include "tests/support/certificates.h"
#include "tests/support/program.h"
#include "tests/support/temporary_folder.h"

namespace eyrie {
namespace {

using std::chrono::seconds;
using testing::HasSubstr;

/// What follows `before` in a text, up to the end of the line or a '/'.
std::string placeAfter(const std::string& text, const std::string& before) {
    const std::size_t begin = text.find(before) + before.size();
    return text.substr(begin, text.find_first_of("/\n", begin) - begin);
}

TEST(Health, IsThatOfACoordinatorByHttpAndByGrpc) {
    const test::TemporaryFolder folder;
    ASSERT_TRUE(test::succeeded(
        {"synth", "mesh", "--size", "100", "--seed", "1", "-o", folder.path("m.ply")}));
    test::Process coordinator(test::eyrieCommand({"coordinator", folder.path("m.ply"), "--listen",
                                                  "127.0.0.1:0", "--grpc", "127.0.0.1:0"}),
                              {"XDG_CACHE_HOME=" + folder.path("cache")});
    ASSERT_TRUE(coordinator.waitForOutput("Renderers register at ", seconds(120)) &&
                coordinator.waitForOutput("\n", seconds(5)))
        << coordinator.errors();
    const std::string page = "http://" + placeAfter(coordinator.output(), "Eyrie is at http://");
    const std::string grpc = placeAfter(coordinator.output(), "Renderers register at ");

    const test::Outcome both = test::eyrie({"health", page, grpc, "--limit", "30"});
    EXPECT_EQ(both.exit, (test::Exit{0, 0})) << both.errors;
    EXPECT_EQ(both.output, fmt::format("{}: healthy\n{}: healthy\n", page, grpc));
    const test::Outcome unready = test::eyrie({"health", page + "/readyz", "--limit", "30"});
    EXPECT_EQ(unready.exit, (test::Exit{1, 0})) << "without renderers it is not ready";
    EXPECT_THAT(unready.errors, HasSubstr("503"));

    coordinator.send(SIGTERM);
    ASSERT_EQ(coordinator.waitFor(seconds(30)), (test::Exit{0, 0}));
    for (const std::string& address : {page, grpc})
        EXPECT_EQ(test::eyrie({"health", address, "--limit", "30"}).exit, (test::Exit{1, 0}))
            << address;
}

TEST(Health, IsAskedByTlsWhereTheCoordinatorEncrypts) {
    const test::TemporaryFolder folder;
    ASSERT_TRUE(test::succeeded(
        {"synth", "mesh", "--size", "100", "--seed", "1", "-o", folder.path("m.ply")}));
    const test::Authority authority("the authority");
    test::Authority::Holder viz;
    viz.name = "viz";
    const access::TlsFiles files = authority.issue("viz", viz);
    test::Process coordinator(
        test::eyrieCommand({"coordinator", folder.path("m.ply"), "--listen", "127.0.0.1:0",
                            "--grpc", "127.0.0.1:0", "--tls-cert", files.certificate, "--tls-key",
                            files.key, "--tls-ca", files.authority}),
        {"XDG_CACHE_HOME=" + folder.path("cache")});
    ASSERT_TRUE(coordinator.waitForOutput("Renderers register at ", seconds(120)) &&
                coordinator.waitForOutput("\n", seconds(5)))
        << coordinator.errors();
    const std::string page = placeAfter(coordinator.output(), "Eyrie is at https://");
    const std::string grpc = placeAfter(coordinator.output(), "Renderers register at ");

    const auto health = [](std::vector<std::string> more) {
        more.insert(more.begin(), {"health", "--limit", "30"});
        return test::eyrie(more);
    };
    const std::vector<std::string> known = {"--tls-ca",        files.authority, "--tls-cert",
                                            files.certificate, "--tls-key",     files.key};
    std::vector<std::string> named = known;
    named.insert(named.end(), {"--tls-name", "viz", "https://" + page, grpc});
    const test::Outcome both = health(named);
    EXPECT_EQ(both.exit, (test::Exit{0, 0})) << both.errors;
    EXPECT_EQ(both.output, fmt::format("https://{}: healthy\n{}: healthy\n", page, grpc));

    for (const std::string& address : {"https://" + page, grpc}) {
        std::vector<std::string> unnamed = known;
        unnamed.push_back(address);
        EXPECT_EQ(health(unnamed).exit, (test::Exit{1, 0})) << address << ": of another name";
        EXPECT_EQ(health({address, "--tls-name", "viz"}).exit, (test::Exit{1, 0}))
            << address << ": of an authority that nobody knows";
    }
    EXPECT_EQ(health({"http://" + page}).exit, (test::Exit{1, 0})) << "in the clear";
    EXPECT_EQ(health({grpc, "--tls-name", "viz", "--tls-ca", files.authority}).exit,
              (test::Exit{1, 0}))
        << "gRPC wants a certificate of who asks";
    EXPECT_EQ(health({grpc, "--tls-cert", files.certificate}).exit, (test::Exit{2, 0}));
    EXPECT_EQ(health({grpc, "--tls-ca", folder.path("none")}).exit, (test::Exit{2, 0}));
}

TEST(Health, IsNotThatOfAServerThatSaysNothing) {
    const int mute = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    sockaddr_in place{};
    place.sin_family = AF_INET;
    place.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof place;
    ASSERT_EQ(bind(mute, reinterpret_cast<sockaddr*>(&place), size), 0);
    ASSERT_EQ(listen(mute, 4), 0);
    ASSERT_EQ(getsockname(mute, reinterpret_cast<sockaddr*>(&place), &size), 0);
    const std::string address = fmt::format("127.0.0.1:{}", ntohs(place.sin_port));
    for (const std::string& asked : {address, "http://" + address}) {
        const test::Outcome outcome = test::eyrie({"health", asked, "--limit", "0.5"});
        EXPECT_EQ(outcome.exit, (test::Exit{1, 0})) << asked;
        EXPECT_THAT(outcome.errors, HasSubstr(address));
    }
    close(mute);
}

TEST(Health, WithinNoNumberOfSecondsIsAWrongCommandLine) {
    for (const char* limit : {"nan", "0", "soon"}) {
        const test::Outcome outcome = test::eyrie({"health", "localhost:1", "--limit", limit});
        EXPECT_EQ(outcome.exit, (test::Exit{2, 0})) << limit;
        EXPECT_THAT(outcome.errors, HasSubstr("--limit")) << limit;
    }
}

TEST(Health, OfWhatIsNoAddressIsAWrongCommandLine) {
    for (const char* address : {"localhost", "http://localhost", "http://localhost:x/", "unix:"})
        EXPECT_EQ(test::eyrie({"health", address}).exit, (test::Exit{2, 0})) << address;
}

}  // namespace
}  // namespace eyrie
