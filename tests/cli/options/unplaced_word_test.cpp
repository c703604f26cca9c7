// SPDX-License-Identifier: Apache-2.0
#include "cli/options/unplaced_word.h"

#include <algorithm>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace eyrie::cli {
namespace {

/// Of a program with the commands `info` and `import mesh`.
std::string about(std::vector<std::string> line) {
    CLI::App app("", "eyrie");
    bool isFlag = false;
    std::string text;
    for (CLI::App* command :
         {app.add_subcommand("info"), app.add_subcommand("import")->add_subcommand("mesh")}) {
        command->add_flag("--json", isFlag);
        command->add_option("-o,--output", text);
    }
    std::ranges::reverse(line);
    try {
        app.parse(std::move(line));
    } catch (const CLI::ParseError&) {
        return aboutUnplacedWord(app);
    }
    return "parsed";
}

TEST(UnplacedWord, IsNamedWithWhatIsLikelyMeant) {
    EXPECT_EQ(about({"info", "--jsom"}),
              "'--jsom' is nothing that eyrie info knows, did you mean '--json'?");
    EXPECT_EQ(about({"import", "mesh", "--outptu=a.eym"}),
              "'--outptu=a.eym' is nothing that eyrie import mesh knows, did you mean '--output'?");
    EXPECT_EQ(about({"imprt", "mesh"}),
              "'imprt' is nothing that eyrie knows, did you mean 'import'?");
    EXPECT_EQ(about({"info", "--elephants"}), "'--elephants' is nothing that eyrie info knows");
}

TEST(UnplacedWord, IsToldToGoBehindItsCommandWhereItStandsBeforeIt) {
    EXPECT_EQ(about({"--output=a", "info"}),
              "'--output=a' stands before the command; write `eyrie info --output=a ...`");
    EXPECT_EQ(about({"import", "--json", "mesh"}),
              "'--json' stands before the command; write `eyrie import mesh --json ...`");
}

TEST(UnplacedWord, IsNotToldToGoWhereItIsUnknownToo) {
    EXPECT_EQ(about({"--jsom", "info"}),
              "'--jsom' is nothing that eyrie info knows, did you mean '--json'?");
    EXPECT_EQ(about({"improt", "import", "mesh"}),
              "'improt' is nothing that eyrie knows, did you mean 'import'?");
}

TEST(UnplacedWord, IsNoneWhereSomethingElseIsWrong) {
    EXPECT_EQ(about({"info", "--"}), "parsed");
    EXPECT_EQ(about({"info", "--", "a.eyt"}), "'a.eyt' is nothing that eyrie knows");
    EXPECT_EQ(about({"info", "--output"}), "");
    EXPECT_EQ(about({"info", "--json"}), "parsed");
}

}  // namespace
}  // namespace eyrie::cli
