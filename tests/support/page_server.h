// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace eyrie::test {

/// What a page server does with every request from now on.
enum class Mood {
    Good,          ///< answers ranges
    Stalls,        ///< takes the request and says nothing
    NotFound,      ///< 404
    ServerError,   ///< 500
    Busy,          ///< 503
    HangsUp,       ///< closes the connection before the headers
    ClosesMidway,  ///< promises the range, sends half of it, and closes the connection
    IgnoresRange,  ///< answers 200 with the whole file
};

/// Serves one file at every path of http://127.0.0.1:port, as well or as badly as it is told.
class PageServer {
public:
    explicit PageServer(std::string content);
    ~PageServer();
    PageServer(const PageServer&) = delete;
    PageServer& operator=(const PageServer&) = delete;

    std::string url(const std::string& name) const;
    void set(Mood mood) { mood_ = mood; }
    void setContent(std::string content);
    /// Answers 503 to the next request for a range with this byte.
    void refuseOnce(std::int64_t byte) { refused_ = byte; }

    /// Requests for contents (GET) so far, and those for size alone (HEAD).
    int gets() const { return gets_; }
    int heads() const { return heads_; }

private:
    void accept();
    void serve(int connection);
    bool answer(int connection, const std::string& request);
    std::string content() const;

    mutable std::mutex contentMutex_;
    std::string content_;
    std::atomic<Mood> mood_{Mood::Good};
    std::atomic<std::int64_t> refused_{-1};
    std::atomic<bool> isStopping_{false};
    std::atomic<int> gets_{0};
    std::atomic<int> heads_{0};
    int listener_ = -1;
    std::uint16_t port_ = 0;
    std::vector<std::thread> connections_;
    std::thread acceptor_;
};

}  // namespace eyrie::test
