// SPDX-License-Identifier: Apache-2.0
#include "tests/support/lossy_link.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <stdexcept>

#include <arpa/inet.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <linux/if_tun.h>
#include <net/if.h>
#include <poll.h>
#include <sched.h>
#include <sys/ioctl.h>
#include <sys/resource.h>
#include <unistd.h>

namespace eyrie::test {
namespace {

constexpr std::size_t kMaxPacketBytes = 65536;
/// How often the carrier looks whether it is to stop, and at changes of what it was told.
constexpr std::chrono::milliseconds kLookAgain{5};
constexpr int kCarrierNiceness = -20;

[[noreturn]] void fail(const char* what) {
    throw std::runtime_error(
        fmt::format("{}: {}; this needs root, network namespaces and /dev/net/tun", what,
                    std::strerror(errno)));
}

ifreq requestFor(const char* device) {
    ifreq request{};
    std::strncpy(request.ifr_name, device, IFNAMSIZ - 1);
    return request;
}

void setAddress(int socket, const char* device, unsigned long what, const char* address) {
    ifreq request = requestFor(device);
    sockaddr_in internet{};
    internet.sin_family = AF_INET;
    inet_pton(AF_INET, address, &internet.sin_addr);
    std::memcpy(&request.ifr_addr, &internet, sizeof internet);
    if (ioctl(socket, what, &request) != 0)
        fail("setting a device's address");
}

void turnOn(int socket, const char* device) {
    ifreq request = requestFor(device);
    request.ifr_flags = IFF_UP | IFF_RUNNING;
    if (ioctl(socket, SIOCSIFFLAGS, &request) != 0)
        fail("turning a device on");
}

/// Of the calling thread's namespace. An address of IPv6 comes to a device a second or two after it
/// is turned on: browsers take that for another network, and let go of their connections. Where
/// this may not be written (or there is no IPv6) it stays as it is.
void turnOffIpv6() {
    for (const char* path : {"/proc/sys/net/ipv6/conf/all/disable_ipv6",
                             "/proc/sys/net/ipv6/conf/default/disable_ipv6"})
        std::ofstream(path) << '1';
}

/// Puts the calling thread into a new namespace with a loopback and a TUN device of this address.
int enterNamespace(const char* address) {
    if (unshare(CLONE_NEWNET) != 0)
        fail("unshare(CLONE_NEWNET)");
    turnOffIpv6();
    const int tun = open("/dev/net/tun", O_RDWR | O_NONBLOCK | O_CLOEXEC);
    if (tun < 0)
        fail("/dev/net/tun");
    ifreq request = requestFor("eyrie0");
    request.ifr_flags = IFF_TUN | IFF_NO_PI;
    if (ioctl(tun, TUNSETIFF, &request) != 0)
        fail("TUNSETIFF");
    const int socket = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
    setAddress(socket, "eyrie0", SIOCSIFADDR, address);
    setAddress(socket, "eyrie0", SIOCSIFNETMASK, "255.255.255.0");
    turnOn(socket, "eyrie0");
    turnOn(socket, "lo");
    close(socket);
    return tun;
}

}  // namespace

LossyLink::LossyLink() : here_(enterNamespace(kHere)) {
    host_ = std::jthread([this](const std::stop_token& stop) { live(stop); });
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return isThere_; });
    if (!error_.empty())
        throw std::runtime_error(error_);
    carrier_ = std::jthread([this](const std::stop_token& stop) { carry(stop); });
}

LossyLink::~LossyLink() {
    host_ = {};  // asks it to stop, and waits
    carrier_ = {};
    close(here_);
    close(there_);
}

void LossyLink::live(const std::stop_token& stop) {
    std::unique_lock lock(mutex_);
    try {
        there_ = enterNamespace(kThere);
    } catch (const std::runtime_error& error) {
        error_ = error.what();
    }
    isThere_ = true;
    changed_.notify_all();
    while (changed_.wait(lock, stop, [this] { return job_ != nullptr; })) {
        (*job_)();
        job_ = nullptr;
        changed_.notify_all();
    }
}

void LossyLink::runThere(const std::function<void()>& job) {
    std::unique_lock lock(mutex_);
    job_ = &job;
    changed_.notify_all();
    changed_.wait(lock, [this] { return job_ == nullptr; });
}

void LossyLink::carry(const std::stop_token& stop) {
    // A network has no share of the processors to wait for. Without the right to it: as it comes.
    [[maybe_unused]] const int favoured =
        setpriority(PRIO_PROCESS, static_cast<id_t>(gettid()), kCarrierNiceness);
    while (!stop.stop_requested()) {
        Clock::time_point until = Clock::now() + kLookAgain;
        for (const LinkQueue* queue : {&toHere_, &toThere_})
            until = std::min(until, queue->next().value_or(until));
        wait(until);
        take(here_, toThere_);
        take(there_, toHere_);
        deliver(toThere_, there_);
        deliver(toHere_, here_);
    }
}

/// For a packet at a device, or for the time at most.
void LossyLink::wait(Clock::time_point until) const {
    const auto left = std::max(Clock::duration::zero(), until - Clock::now());
    const timespec limit{0, std::chrono::nanoseconds(left).count()};
    std::array<pollfd, 2> devices{{{here_, POLLIN, 0}, {there_, POLLIN, 0}}};
    ppoll(devices.data(), devices.size(), &limit, nullptr);
}

void LossyLink::take(int from, LinkQueue& queue) {
    std::array<char, kMaxPacketBytes> bytes;
    ssize_t count = 0;
    while ((count = read(from, bytes.data(), bytes.size())) > 0)
        if (std::uniform_real_distribution<double>(0, 1)(random_) >= loss_)
            queue.put({bytes.begin(), bytes.begin() + count}, line(), Clock::now());
}

void LossyLink::deliver(LinkQueue& queue, int to) const {
    while (const auto packet = queue.take(line(), Clock::now())) {
        // What a device does not take is lost, as on any network.
        [[maybe_unused]] const ssize_t written = write(to, packet->data(), packet->size());
    }
}

}  // namespace eyrie::test
