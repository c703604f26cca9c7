// SPDX-License-Identifier: Apache-2.0
#include "access/tokens.h"

#include <filesystem>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "access/ticket.h"
#include "tests/support/temporary_folder.h"

namespace eyrie::access {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::Not;

constexpr char kView[] = "view-0123456789abcdef0123456789";
constexpr char kAdmin[] = "admin-0123456789abcdef0123456789";

Tokens sample() {
    return *Tokens::parse(std::string("# two\n\nview ") + kView + "\r\n\tadmin\t" + kAdmin, "t");
}

TEST(Tokens, HaveTheRoleOfTheirLine) {
    const Tokens tokens = sample();
    EXPECT_EQ(tokens.roleOf(kView), Role::View);
    EXPECT_EQ(tokens.roleOf(kAdmin), Role::Admin);
    EXPECT_EQ(tokens.first(Role::Admin), kAdmin);
    EXPECT_EQ(tokens.first(Role::Control), "");
    for (const char* wrong :
         {"", "view", "view-0123456789abcdef012345678", "view-0123456789abcdef01234567890",
          "VIEW-0123456789abcdef0123456789"})
        EXPECT_EQ(tokens.roleOf(wrong), std::nullopt) << wrong;
}

TEST(Tokens, AFileThatIsWrongSaysWhereAndNeverQuotesASecret) {
    const std::string secret = "0123456789abcdef0123456789abcdef";
    const std::vector<std::string> texts = {secret,
                                            "view " + secret + "\nowner " + secret,
                                            "view " + secret + "!",
                                            "view 0123456789abcdef",
                                            "view " + secret + "\nadmin " + secret,
                                            "view " + std::string(257, 'a'),
                                            "view",
                                            "view " + secret + " " + secret};
    for (const std::string& text : texts) {
        const auto tokens = Tokens::parse(text, "token file t");
        ASSERT_TRUE(absl::IsInvalidArgument(tokens.status())) << text;
        EXPECT_THAT(std::string(tokens.status().message()), HasSubstr("token file t: line "));
        EXPECT_THAT(std::string(tokens.status().message()), Not(HasSubstr("89abcdef")));
    }
    EXPECT_TRUE(absl::IsInvalidArgument(Tokens::parse("# nobody\n", "t").status()));
}

TEST(Tokens, AFileThatOthersCanReadIsRefused) {
    const test::TemporaryFolder folder;
    const std::string file = folder.write("tokens", std::string("view ") + kView);
    for (const unsigned mode : {0644U, 0604U, 0660U, 0602U, 0601U}) {
        fs::permissions(file, static_cast<fs::perms>(mode));
        const auto tokens = Tokens::read(file);
        EXPECT_TRUE(absl::IsPermissionDenied(tokens.status())) << std::oct << mode;
        EXPECT_THAT(std::string(tokens.status().message()), HasSubstr("chmod 600"));
    }
    for (const unsigned mode : {0600U, 0400U, 0640U, 0440U}) {
        fs::permissions(file, static_cast<fs::perms>(mode));
        EXPECT_TRUE(Tokens::read(file).ok()) << std::oct << mode;
    }
    EXPECT_TRUE(absl::IsNotFound(Tokens::read(folder.path("none")).status()));
    EXPECT_TRUE(absl::IsInvalidArgument(Tokens::read(folder.path()).status()));
}

TEST(Ticket, StandsForItsSecretUntilItExpires) {
    const Tokens tokens = sample();
    const std::string ticket = makeTicket(kView, 1000);
    EXPECT_EQ(tokens.roleOfTicket(ticket, 999), Role::View);
    EXPECT_EQ(tokens.roleOfTicket(ticket, 1000), std::nullopt);
    EXPECT_THAT(ticket, Not(HasSubstr(kView)));
    for (std::size_t i = 0; i < ticket.size(); ++i) {
        std::string forged = ticket;
        forged[i] = forged[i] == '9' ? '8' : '9';
        EXPECT_EQ(tokens.roleOfTicket(forged, 0), std::nullopt) << forged;
    }
    for (const std::string& forged :
         {std::string(), std::string("."), std::string("9999."),
          std::string("99999999999999999999.0"), "2000" + ticket.substr(4),
          makeTicket("another-secret-0123456789", 2000), ticket + "0"})
        EXPECT_EQ(tokens.roleOfTicket(forged, 0), std::nullopt) << forged;
}

TEST(Ticket, MarksTellSecretsApartAndNothingOfThem) {
    const std::string mark = markOf(kView);
    EXPECT_EQ(mark, markOf(kView));
    EXPECT_NE(mark, markOf(std::string(kView) + "x"));
    EXPECT_EQ(mark.size(), 8U);
    EXPECT_EQ(mark.find_first_not_of("0123456789abcdef"), std::string::npos);
    EXPECT_THAT(makeTicket(kView, 1000), Not(HasSubstr(mark)));
}

}  // namespace
}  // namespace eyrie::access
