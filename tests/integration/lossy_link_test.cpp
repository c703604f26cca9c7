// SPDX-License-Identifier: Apache-2.0
// The emulated network itself: what two hosts see of its rate, its delay and its packets.
#include "tests/support/lossy_link.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstring>
#include <fstream>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include <arpa/inet.h>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

namespace eyrie::test {
namespace {

using std::chrono::milliseconds;
using Clock = std::chrono::steady_clock;

constexpr int kHeaderBytes = 28;  // of IP and UDP
constexpr int kPacketBytes = 1500;

double millisecondsBetween(Clock::time_point from, Clock::time_point to) {
    return std::chrono::duration<double, std::milli>(to - from).count();
}

/// A socket, closed with it.
class Socket {
public:
    explicit Socket(int type) : id_(::socket(AF_INET, type | SOCK_CLOEXEC, 0)) {
        const timeval patience{5, 0};  // for what does not come
        setsockopt(id_, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
    }
    explicit Socket(const Socket& listener, std::nullptr_t)
        : id_(accept(listener.id_, nullptr, nullptr)) {}
    ~Socket() { close(id_); }
    Socket(const Socket&) = delete;
    Socket& operator=(const Socket&) = delete;

    int id() const { return id_; }

private:
    int id_;
};

sockaddr_in at(const char* address, std::uint16_t port) {
    sockaddr_in place{};
    place.sin_family = AF_INET;
    place.sin_port = htons(port);
    inet_pton(AF_INET, address, &place.sin_addr);
    return place;
}

int bindTo(const Socket& socket, const sockaddr_in& place) {
    return bind(socket.id(), reinterpret_cast<const sockaddr*>(&place), sizeof place);
}

int connectTo(const Socket& socket, const sockaddr_in& place) {
    return connect(socket.id(), reinterpret_cast<const sockaddr*>(&place), sizeof place);
}

/// Bytes and packets that the calling thread's host has got from the network.
struct Received {
    double bytes = 0;
    double packets = 0;
};
Received received() {
    std::ifstream file("/proc/thread-self/net/dev");
    for (std::string line; std::getline(file, line);)
        if (const std::size_t name = line.find("eyrie0:"); name != std::string::npos) {
            std::istringstream numbers(line.substr(name + 7));
            Received all;
            numbers >> all.bytes >> all.packets;
            return all;
        }
    return {};
}

class LossyLinkHosts : public testing::Test {
protected:
    /// When each of `count` packets came here that were sent from there at once.
    std::vector<double> burst(int count) {
        Socket here(SOCK_DGRAM);
        const int room = 4 << 20;
        setsockopt(here.id(), SOL_SOCKET, SO_RCVBUFFORCE, &room, sizeof room);
        EXPECT_EQ(bindTo(here, at(LossyLink::kHere, kPort)), 0);
        const auto start = Clock::now();
        link_.runThere([count] {
            const Socket there(SOCK_DGRAM);
            EXPECT_EQ(connectTo(there, at(LossyLink::kHere, kPort)), 0);
            const std::array<char, kPacketBytes - kHeaderBytes> bytes{};
            for (int i = 0; i < count; ++i)
                EXPECT_EQ(send(there.id(), bytes.data(), bytes.size(), 0),
                          static_cast<ssize_t>(bytes.size()));
        });
        std::vector<double> times;
        std::array<char, kPacketBytes> bytes;
        while (static_cast<int>(times.size()) < count &&
               recv(here.id(), bytes.data(), bytes.size(), 0) > 0)
            times.push_back(millisecondsBetween(start, Clock::now()));
        return times;
    }

    static constexpr std::uint16_t kPort = 4000;
    LossyLink link_;
};

/// One test: the namespaces are those of all threads of this process.
TEST_F(LossyLinkHosts, SeeItsRateItsDelayAndPacketsOf1500Bytes) {
    constexpr double kBitsPerSecond = 20e6;
    constexpr double kDelay = 25;
    constexpr int kCount = 150;  // which the queue has room for
    link_.limit(kBitsPerSecond);
    link_.delay(milliseconds(25));
    const double asked = 8.0 * kPacketBytes * kCount / kBitsPerSecond * 1000;
    // However busy the machine is, packets never come too soon, and once in a while in time.
    double nearest = 1e9;
    for (int i = 0; i < 20 && nearest > 0.03 * asked; ++i) {
        const std::vector<double> times = burst(kCount);
        ASSERT_EQ(times.size(), kCount);
        EXPECT_GE(times.back(), kDelay + asked);
        nearest = std::min(nearest, times.back() - (kDelay + asked));
        EXPECT_GE(times.front(), kDelay + asked / kCount);
    }
    fmt::print("{} packets at 20 Mbit/s and 25 ms: {:.1f} ms, {:.2f} later than is asked\n", kCount,
               kDelay + asked + nearest, nearest);
    EXPECT_LE(nearest, 0.03 * asked);

    // A transfer over TCP from there, without a rate.
    link_.limit(0);
    link_.delay(milliseconds(5));
    constexpr std::size_t kTransfer = 4 << 20;
    const Received before = received();
    std::thread host;
    Socket listener(SOCK_STREAM);
    ASSERT_EQ(bindTo(listener, at(LossyLink::kHere, kPort)), 0);
    ASSERT_EQ(listen(listener.id(), 1), 0);
    link_.runThere([&host] {
        host = std::thread([] {
            const Socket there(SOCK_STREAM);
            EXPECT_EQ(connectTo(there, at(LossyLink::kHere, kPort)), 0);
            const std::vector<char> bytes(kTransfer);
            EXPECT_EQ(send(there.id(), bytes.data(), bytes.size(), MSG_NOSIGNAL),
                      static_cast<ssize_t>(bytes.size()));
        });
    });
    std::size_t got = 0;
    {
        const Socket here(listener, nullptr);
        std::vector<char> bytes(1 << 16);
        for (ssize_t count = 0; (count = recv(here.id(), bytes.data(), bytes.size(), 0)) > 0;)
            got += static_cast<std::size_t>(count);
    }
    host.join();
    EXPECT_EQ(got, kTransfer);
    const Received after = received();
    const double mean = (after.bytes - before.bytes) / (after.packets - before.packets);
    EXPECT_LE(mean, kPacketBytes);
    EXPECT_GE(after.packets - before.packets, static_cast<double>(kTransfer) / kPacketBytes);
}

}  // namespace
}  // namespace eyrie::test
