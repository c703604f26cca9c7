// SPDX-License-Identifier: Apache-2.0
// The program that gives a command a network: what it says, what it ends with, what it leaves.
#include <chrono>
#include <filesystem>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <signal.h>

#include "tests/support/process.h"

namespace eyrie::test {
namespace {

using std::chrono::seconds;

std::vector<std::string> inNetwork(const std::string& script) {
    return {EYRIE_NETWORK_LINK, "/bin/bash", "-c", script};
}

TEST(NetworkLink, EndsWithTheStatusOfItsCommand) {
    EXPECT_EQ(run(inNetwork("exit 7"), seconds(20)).exit, (Exit{7, 0}));
    EXPECT_EQ(run(inNetwork("kill -KILL $$"), seconds(20)).exit, (Exit{128 + SIGKILL, 0}));
    EXPECT_EQ(run({EYRIE_NETWORK_LINK, "/no/such/program"}, seconds(20)).exit, (Exit{127, 0}));
    EXPECT_EQ(run({EYRIE_NETWORK_LINK}, seconds(20)).exit, (Exit{2, 0}));
}

TEST(NetworkLink, IsOfTwoHostsBesideThisOne) {
    const Outcome outcome = run(inNetwork("readlink /proc/self/ns/net; nsenter "
                                          "--net=$EYRIE_LINK_THERE readlink /proc/self/ns/net"),
                                seconds(20));
    ASSERT_EQ(outcome.exit, (Exit{0, 0})) << outcome.errors;
    std::istringstream lines(outcome.output);
    std::set<std::string> networks{std::filesystem::read_symlink("/proc/self/ns/net")};
    for (std::string line; std::getline(lines, line);) networks.insert(line);
    EXPECT_EQ(networks.size(), 3u) << outcome.output;
}

TEST(NetworkLink, JoinsItsHostsUntilAllIsLost) {
    const std::string script =
        R"(look() { curl -s --noproxy '*' -m 2 -o /dev/null "http://$EYRIE_LINK_ADDRESS:8000/"; }
           nsenter --net=$EYRIE_LINK_THERE \
               python3 -m http.server --bind $EYRIE_LINK_ADDRESS 8000 >/dev/null 2>&1 &
           for i in $(seq 200); do if look; then break; fi; sleep 0.1; done
           look; echo "joined: $?"
           echo 'loss 1' >&$EYRIE_LINK_CONTROL; read -u $EYRIE_LINK_CONTROL said; echo "$said"
           look; echo "parted: $?")";
    const Outcome outcome = run(inNetwork(script), seconds(60));
    EXPECT_EQ(outcome.output, "joined: 0\nok\nparted: 28\n") << outcome.errors;
}

TEST(NetworkLink, SaysWhatIsWrongWithAChange) {
    const Outcome outcome = run(
        inNetwork(
            R"(for said in 'rate 2e7' 'delay 25' 'loss 0.5' 'loss 2' 'delay x' 'rate' 'colour 3' 'loss nan'; do
                         echo "$said" >&$EYRIE_LINK_CONTROL; read -u $EYRIE_LINK_CONTROL answer
                         echo "$answer"
                     done)"),
        seconds(20));
    EXPECT_EQ(outcome.output,
              "ok\nok\nok\n"
              "\"loss 2\": loss is a number from 0 to 1\n"
              "\"delay x\": delay is a number from 0 to 60000\n"
              "\"rate\": rate is a number from 0 to 1000000000000\n"
              "\"colour 3\" is neither rate, delay nor loss\n"
              "\"loss nan\": loss is a number from 0 to 1\n");
}

/// Starts two that stay, one of them in a session of its own and without a parent; tells them.
const std::string kLeaves =
    "sleep 1000 & echo $!; setsid -f sh -c 'echo $$; exec sleep 1000'; sleep 0.5; echo there; ";

std::vector<pid_t> toldIn(const std::string& output) {
    std::vector<pid_t> ids;
    for (std::size_t at = 0; at < output.size() && output[at] != 't';) {
        ids.push_back(static_cast<pid_t>(std::stoi(output.substr(at))));
        at = output.find('\n', at) + 1;
    }
    return ids;
}

void expectNoneAlive(const std::string& output) {
    const std::vector<pid_t> ids = toldIn(output);
    EXPECT_EQ(ids.size(), 2u) << output;
    for (const pid_t id : ids) EXPECT_FALSE(isAlive(id)) << id;
}

TEST(NetworkLink, LeavesNothingBehind) {
    const Outcome outcome = run(inNetwork(kLeaves), seconds(20));
    EXPECT_EQ(outcome.exit, (Exit{0, 0})) << outcome.errors;
    expectNoneAlive(outcome.output);
}

TEST(NetworkLink, LeavesNothingBehindWhenItIsToldToEnd) {
    for (const int signal : {SIGINT, SIGTERM}) {
        Process link(inNetwork(kLeaves + "trap 'exit 3' TERM; while true; do sleep 0.1; done"));
        ASSERT_TRUE(link.waitForOutput("there", seconds(20))) << link.errors();
        pauseBriefly();
        link.send(signal);
        const auto exit = link.waitFor(seconds(20));
        ASSERT_TRUE(exit.has_value());
        expectNoneAlive(link.output());
    }
}

}  // namespace
}  // namespace eyrie::test
