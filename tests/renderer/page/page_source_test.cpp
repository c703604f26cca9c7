// SPDX-License-Identifier: Apache-2.0
// Files on a server that misbehaves in every way a server can.
#include "renderer/page/page_source.h"

#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>
#include <thread>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <xxhash.h>

#include "fabric/log.h"
#include "tests/support/page_server.h"
#include "tests/support/temporary_folder.h"

namespace eyrie::page {
namespace {

using std::chrono::seconds;
using std::chrono::steady_clock;
using test::Mood;

constexpr std::size_t kHead = 100;
constexpr std::size_t kFileBytes = 3'000'000;

std::string contentOf(unsigned seed, std::size_t bytes = kFileBytes) {
    std::mt19937 random(seed);
    std::string content(bytes, '\0');
    for (char& c : content) c = static_cast<char>(random());
    return content;
}

class RemotePages : public testing::Test {
protected:
    static void SetUpTestSuite() { spdlog::set_level(spdlog::level::err); }

    Block block(std::uint64_t offset, std::uint64_t bytes) const {
        return {offset, bytes, XXH64(content_.data() + offset, bytes, 0)};
    }
    SourceOptions cached() const { return sourceOptions(folder_.path() / "cache", 100 << 20); }
    std::string url() const { return server_.url("a.eyt"); }

    std::unique_ptr<PageSource> open(const SourceOptions& options = {}) const {
        auto source = PageSource::open(url(), kHead, options);
        EXPECT_TRUE(source.ok()) << source.status();
        return source.ok() ? *std::move(source) : nullptr;
    }
    /// Reads a part and compares it with the file.
    absl::Status read(const PageSource& source, const Block& wanted) const {
        std::vector<std::byte> bytes(wanted.bytes);
        const absl::Status status = source.read(wanted, bytes, "page 7");
        if (status.ok()) {
            EXPECT_EQ(std::memcmp(bytes.data(), content_.data() + wanted.offset, bytes.size()), 0);
        }
        return status;
    }

    test::TemporaryFolder folder_;
    std::string content_ = contentOf(1);
    test::PageServer server_{content_};
};

TEST_F(RemotePages, AreWhatTheFileHas) {
    const auto source = open();
    ASSERT_NE(source, nullptr);
    EXPECT_EQ(source->sizeBytes(), kFileBytes);
    EXPECT_EQ(std::memcmp(source->head().data(), content_.data(), kHead), 0);
    EXPECT_TRUE(read(*source, block(kFileBytes - 10, 10)).ok());
    const int before = server_.gets();
    EXPECT_TRUE(read(*source, block(123'456, 70'000)).ok());
    EXPECT_EQ(server_.gets(), before + 1) << "one page, one request";
    EXPECT_TRUE(read(*source, block(5, 2'500'000)).ok()) << "in several requests";
}

TEST_F(RemotePages, OfOneSourceMayBeReadByManyThreads) {
    const auto source = open(cached());
    std::vector<std::thread> threads;
    for (unsigned i = 0; i < 8; ++i)
        threads.emplace_back([&, i] {
            for (unsigned k = 0; k < 10; ++k)
                EXPECT_EQ(read(*source, block(1000 * ((7 * i + 3 * k) % 20), 900)),
                          absl::OkStatus());
        });
    for (std::thread& thread : threads) thread.join();
}

struct Failing {
    Mood mood;
    absl::StatusCode code;
    std::string says;
};
class FailingServer : public RemotePages, public testing::WithParamInterface<Failing> {
protected:
    // A second where it is five by default: the tests should not take longer than they must.
    FailingServer() {
        setenv("GDAL_HTTP_LOW_SPEED_TIME", "1", 1);
        setenv("GDAL_HTTP_CONNECTTIMEOUT", "1", 1);
    }
    // The other tests' server answers, however busy the machine is.
    ~FailingServer() override {
        unsetenv("GDAL_HTTP_LOW_SPEED_TIME");
        unsetenv("GDAL_HTTP_CONNECTTIMEOUT");
    }
};

TEST_P(FailingServer, IsAClearErrorInABoundedTimeAndHealsByItself) {
    const Failing& failing = GetParam();
    const auto source = open();
    server_.set(failing.mood);
    for (int attempt = 0; attempt < 2; ++attempt) {
        const auto begin = steady_clock::now();
        const absl::Status status = read(*source, block(1000, 50'000));
        EXPECT_LT(steady_clock::now() - begin, seconds(5));
        EXPECT_EQ(status.code(), failing.code) << status;
        EXPECT_NE(status.ToString().find(url() + ": page 7: "), std::string::npos) << status;
        EXPECT_NE(status.ToString().find(failing.says), std::string::npos) << status;
    }
    server_.set(Mood::Good);
    const absl::Status healed = read(*source, block(1000, 50'000));
    EXPECT_TRUE(healed.ok()) << healed;
}

TEST_P(FailingServer, KeepsAFileFromOpeningUntilItHeals) {
    const Failing& failing = GetParam();
    server_.set(failing.mood);
    const auto begin = steady_clock::now();
    const auto source = PageSource::open(url(), kHead, {});
    EXPECT_LT(steady_clock::now() - begin, seconds(5));
    // A server that ignores ranges has sent enough when the beginning is all that is asked for.
    if (failing.mood != Mood::IgnoresRange || !source.ok()) {
        EXPECT_EQ(source.status().code(), failing.code) << source.status();
        EXPECT_NE(source.status().ToString().find(url()), std::string::npos) << source.status();
    }
    server_.set(Mood::Good);
    EXPECT_NE(open(), nullptr) << "nothing of the failure is remembered";
}

using absl::StatusCode;
INSTANTIATE_TEST_SUITE_P(
    Moods, FailingServer,
    testing::Values(Failing{Mood::Stalls, StatusCode::kUnavailable, "too slow"},
                    Failing{Mood::NotFound, StatusCode::kNotFound, "404"},
                    Failing{Mood::ServerError, StatusCode::kUnavailable, "500"},
                    Failing{Mood::Busy, StatusCode::kUnavailable, "503"},
                    Failing{Mood::HangsUp, StatusCode::kUnavailable, "CURL error"},
                    Failing{Mood::ClosesMidway, StatusCode::kUnavailable, "of 50000 bytes"},
                    Failing{Mood::IgnoresRange, StatusCode::kInvalidArgument, "range"}));

TEST_F(RemotePages, OfAFileThatHasChangedOnTheServerAreRefused) {
    const auto source = open(cached());
    EXPECT_TRUE(read(*source, block(2000, 500)).ok());
    server_.setContent(contentOf(2));
    const absl::Status changed = read(*source, block(9000, 500));
    EXPECT_TRUE(absl::IsDataLoss(changed)) << changed;
    EXPECT_NE(changed.ToString().find("has changed on the server"), std::string::npos) << changed;
    const absl::Status kept = read(*source, block(2000, 500));
    EXPECT_FALSE(kept.ok()) << "what was kept of the file is gone, too";

    content_ = contentOf(2);
    const auto again = open(cached());
    EXPECT_TRUE(read(*again, block(2000, 500)).ok()) << "the new one, never the old one's page";
}

TEST_F(RemotePages, OfAFileThatGotShorterAreRefused) {
    const auto source = open();
    server_.setContent(content_.substr(0, 5000));
    const absl::Status status = read(*source, block(9000, 500));
    EXPECT_TRUE(absl::IsDataLoss(status)) << status;
    EXPECT_NE(status.ToString().find("has changed on the server"), std::string::npos) << status;
}

TEST(LocalPages, OfAFileThatGotShorterAreRefusedByWhereItHasToGoOn) {
    const test::TemporaryFolder folder;
    std::ofstream(folder.path("a.eyt"), std::ios::binary) << contentOf(1, 10'000);
    const auto source = PageSource::open(folder.path("a.eyt"), kHead, {});
    ASSERT_TRUE(source.ok()) << source.status();
    std::filesystem::resize_file(folder.path("a.eyt"), 5000);
    std::vector<std::byte> bytes(500);
    const absl::Status status = (*source)->read({9000, bytes.size(), 0}, bytes, "page 7");
    EXPECT_TRUE(absl::IsDataLoss(status)) << status;
    EXPECT_NE(status.ToString().find("page 7: the file ends before byte 9000"), std::string::npos)
        << status;
}

TEST_F(RemotePages, DamagedOnTheServerAreSaidToBe) {
    const auto source = open(cached());
    Block wrong = block(3000, 500);
    ++wrong.checksum;
    const absl::Status status = read(*source, wrong);
    EXPECT_TRUE(absl::IsDataLoss(status));
    EXPECT_NE(status.ToString().find("its checksum is wrong"), std::string::npos) << status;
}

TEST_F(RemotePages, ComeFromTheCacheTheNextTimeAlsoWithoutAServer) {
    EXPECT_TRUE(read(*open(cached()), block(1000, 500)).ok());
    const int before = server_.gets();
    EXPECT_TRUE(read(*open(cached()), block(1000, 500)).ok());
    EXPECT_EQ(server_.gets(), before + 1) << "the head alone";
    server_.set(Mood::HangsUp);
    const auto offline = open(cached());
    ASSERT_NE(offline, nullptr);
    EXPECT_EQ(offline->sizeBytes(), kFileBytes);
    EXPECT_TRUE(read(*offline, block(1000, 500)).ok());
    EXPECT_TRUE(absl::IsUnavailable(read(*offline, block(7000, 500))));
    server_.set(Mood::Good);
    EXPECT_TRUE(read(*offline, block(7000, 500)).ok()) << "the server is back";
}

TEST_F(RemotePages, DamagedInTheCacheAreReadAgain) {
    EXPECT_TRUE(read(*open(cached()), block(1000, 500)).ok());
    for (const auto& entry :
         std::filesystem::recursive_directory_iterator(folder_.path() / "cache"))
        if (entry.path().filename() == "1000-500")
            std::ofstream(entry.path(), std::ios::in | std::ios::out | std::ios::binary) << "oops";
    const auto source = open(cached());
    const int before = server_.gets();
    EXPECT_TRUE(read(*source, block(1000, 500)).ok());
    EXPECT_EQ(server_.gets(), before + 1);
    EXPECT_TRUE(read(*source, block(1000, 500)).ok());
    EXPECT_EQ(server_.gets(), before + 1) << "and kept again";
}

}  // namespace
}  // namespace eyrie::page
