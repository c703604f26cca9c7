// SPDX-License-Identifier: Apache-2.0
#include "access/token_file.h"

#include <filesystem>
#include <string>

#include <gtest/gtest.h>

#include "access/gate.h"
#include "tests/support/temporary_folder.h"

namespace eyrie::access {
namespace {

namespace fs = std::filesystem;

constexpr char kFirst[] = "first-0123456789abcdef0123456789";
constexpr char kSecond[] = "second-0123456789abcdef0123456789";
const Gate::Clock::time_point kNow{std::chrono::hours(500'000)};

class ChangingTokens : public testing::Test {
protected:
    /// In the place of what was there, as programs replace files that others read.
    void write(const std::string& text, fs::perms mode = fs::perms::owner_read) const {
        const std::string fresh = folder_.write("fresh", text);
        fs::permissions(fresh, mode);
        fs::rename(fresh, path_);
    }

    static std::string admin(const std::string& secret) { return "admin " + secret + "\n"; }

    test::TemporaryFolder folder_;
    std::string path_ = folder_.path("tokens");
};

TEST_F(ChangingTokens, AreThoseThatTheFileHas) {
    write(admin(kFirst));
    const auto file = *TokenFile::open(path_);
    const auto before = file->current();
    EXPECT_EQ(file->current(), before) << "a file that rests is not read again";
    write(admin(kSecond) + "view " + kFirst + "\n");
    const auto after = file->current();
    EXPECT_EQ(after->roleOf(kSecond), Role::Admin);
    EXPECT_EQ(after->roleOf(kFirst), Role::View);
    EXPECT_EQ(before->roleOf(kFirst), Role::Admin) << "who holds the former ones keeps them";
}

TEST_F(ChangingTokens, StayWhileTheFileIsOfNoUse) {
    write(admin(kFirst));
    const auto file = *TokenFile::open(path_);
    const auto isFirst = [&] { return file->current()->roleOf(kFirst) == Role::Admin; };
    write("admin");
    EXPECT_TRUE(isFirst()) << "half a file";
    write("");
    EXPECT_TRUE(isFirst()) << "an empty file";
    write(admin(kSecond), fs::perms::owner_read | fs::perms::others_read);
    EXPECT_TRUE(isFirst()) << "a file that everybody reads";
    fs::permissions(path_, fs::perms::owner_read);
    EXPECT_FALSE(isFirst()) << "it is of use now";
    fs::remove(path_);
    EXPECT_EQ(file->current()->roleOf(kSecond), Role::Admin) << "no file";
}

TEST_F(ChangingTokens, LetInAndTurnAwayAtTheGate) {
    write(admin(kFirst));
    Gate gate(*TokenFile::open(path_));
    const std::string first = std::string("Bearer ") + kFirst;
    const std::string second = std::string("Bearer ") + kSecond;
    const std::string ticket = Gate::ticketFor(first, kNow);
    EXPECT_TRUE(gate.admit({first, ""}, "10.0.0.1", Role::Admin, kNow).ok());
    EXPECT_TRUE(gate.admit({"", ticket}, "10.0.0.1", Role::Admin, kNow).ok());
    EXPECT_EQ(gate.tokenOf(Role::Admin), kFirst);

    write(admin(kSecond));
    EXPECT_TRUE(
        absl::IsUnauthenticated(gate.admit({first, ""}, "10.0.0.1", Role::View, kNow).status()));
    EXPECT_TRUE(
        absl::IsUnauthenticated(gate.admit({"", ticket}, "10.0.0.1", Role::View, kNow).status()))
        << "a cookie for a token that was taken away";
    EXPECT_TRUE(gate.admit({second, ""}, "10.0.0.1", Role::Admin, kNow).ok());
    EXPECT_EQ(gate.tokenOf(Role::Admin), kSecond);
}

TEST_F(ChangingTokens, HaveToBeThereAtFirst) {
    EXPECT_TRUE(absl::IsNotFound(TokenFile::open(path_).status()));
}

}  // namespace
}  // namespace eyrie::access
