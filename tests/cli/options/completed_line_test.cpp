// SPDX-License-Identifier: Apache-2.0
#include "cli/options/completed_line.h"

#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "cli/options/common_options.h"
#include "cli/options/print_config.h"

namespace eyrie::cli {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using Arguments = std::vector<std::string>;

/// A program with a command `serve` and one within another, `import terrain`.
class Program : public testing::Test {
protected:
    Program() {
        CLI::App* serve = app_.add_subcommand("serve");
        serve->add_option("data", data_)->required();
        serve->add_option("--listen", listen_)->capture_default_str();
        serve->add_option("--renderers", renderers_)->check(CLI::Range(1, 64));
        serve->add_option("--allow-url", urls_)->allow_extra_args(false);
        serve->add_flag("--quiet", quiet_);
        CLI::App* terrain = app_.add_subcommand("import")->add_subcommand("terrain");
        terrain->add_option("-o,--output", output_)->required();
        terrain->add_option("--memory", memory_);
        addCommonOptions(app_, common_);
    }
    ~Program() override { std::filesystem::remove(file_); }

    void write(const std::string& text) const { std::ofstream(file_) << text; }

    /// Completes the line and parses it, as main does.
    absl::Status run(const Arguments& arguments) {
        auto completedLine = completed(app_, arguments, [this](const std::string& name) {
            const auto found = environment_.find(name);
            return found == environment_.end() ? std::nullopt : std::optional(found->second);
        });
        if (!completedLine.ok())
            return completedLine.status();
        line_ = *std::move(completedLine);
        try {
            app_.parse(Arguments(line_.arguments.rbegin(), line_.arguments.rend()));
        } catch (const CLI::ParseError& error) {
            return absl::InvalidArgumentError(error.what());
        }
        return absl::OkStatus();
    }

    std::string errorOf(const Arguments& arguments) {
        const absl::Status status = run(arguments);
        return {status.message().data(), status.message().size()};
    }

    const std::string file_ = testing::TempDir() + "eyrie-options-" + std::to_string(getpid());
    std::map<std::string, std::string> environment_;
    CompletedLine line_;
    CLI::App app_{"test", "eyrie"};
    CommonOptions common_;
    Arguments data_;
    std::string listen_ = "default:1";
    int renderers_ = 0;
    Arguments urls_;
    bool quiet_ = false;
    std::string output_;
    std::string memory_;
};

TEST_F(Program, ReadsListsOfSeveralLinesAndHashesInQuotes) {
    write(
        "[serve]  # of this command\n"
        "allow-url = [\"https://a/#x\",\n"
        "\"https://b/\"]  # two\n"
        "listen = \"file:1\"\n");
    ASSERT_EQ(errorOf({"serve", "dem.tif", "--options", file_}), "");
    EXPECT_THAT(urls_, ElementsAre("https://a/#x", "https://b/"));
    EXPECT_EQ(listen_, "file:1");
}

TEST_F(Program, TakesTheDefaultWhereNobodySaysAnything) {
    ASSERT_TRUE(run({"serve", "dem.tif"}).ok());
    EXPECT_EQ(listen_, "default:1");
    EXPECT_THAT(line_.origins, IsEmpty());
}

TEST_F(Program, TakesTheFileBeforeTheDefault) {
    write("listen = \"file:2\"\nquiet = true\n");
    ASSERT_TRUE(run({"serve", "dem.tif", "--options", file_}).ok());
    EXPECT_EQ(listen_, "file:2");
    EXPECT_TRUE(quiet_);
}

TEST_F(Program, TakesTheEnvironmentBeforeTheFile) {
    write("listen = \"file:2\"\n");
    environment_ = {{"EYRIE_LISTEN", "environment:3"}, {"EYRIE_OPTIONS", file_}};
    ASSERT_TRUE(run({"serve", "dem.tif"}).ok());
    EXPECT_EQ(listen_, "environment:3");
}

TEST_F(Program, TakesTheCommandLineBeforeTheEnvironmentAndTheFile) {
    write("listen = \"file:2\"\nrenderers = 2\n");
    environment_ = {{"EYRIE_LISTEN", "environment:3"}, {"EYRIE_RENDERERS", "3"}};
    for (const Arguments& given : {Arguments{"--listen", "flag:4"}, Arguments{"--listen=flag:4"}}) {
        Arguments arguments = {"serve", "dem.tif", "--options=" + file_};
        arguments.insert(arguments.end(), given.begin(), given.end());
        ASSERT_TRUE(run(arguments).ok());
        EXPECT_EQ(listen_, "flag:4");
        EXPECT_EQ(renderers_, 3);
    }
}

TEST_F(Program, TakesASectionBeforeTheTopOfTheFile) {
    write(
        "listen = \"top:1\"\nmemory = \"1G\"\n[serve]\nlisten = \"section:2\"\n"
        "[import.terrain]\nmemory = \"2G\"\noutput = \"out.eyt\"\n");
    ASSERT_TRUE(run({"serve", "dem.tif", "--options", file_}).ok());
    EXPECT_EQ(listen_, "section:2");
    ASSERT_TRUE(run({"import", "terrain", "--options", file_}).ok());
    EXPECT_EQ(memory_, "2G");
    EXPECT_EQ(output_, "out.eyt");
}

TEST_F(Program, MeetsARequirementFromTheEnvironmentAndKnowsShortNames) {
    environment_ = {{"EYRIE_OUTPUT", "environment.eyt"}};
    ASSERT_TRUE(run({"import", "terrain"}).ok());
    EXPECT_EQ(output_, "environment.eyt");
    ASSERT_TRUE(run({"import", "terrain", "-o", "given.eyt"}).ok());
    EXPECT_EQ(output_, "given.eyt");
}

TEST_F(Program, TakesListsFromEverywhere) {
    write("allow-url = [\"https://a/\", \"https://b/\"]\n");
    ASSERT_TRUE(run({"serve", "dem.tif", "--options", file_}).ok());
    EXPECT_THAT(urls_, ElementsAre("https://a/", "https://b/"));
    environment_ = {{"EYRIE_ALLOW_URL", "https://c/  https://d/"}};
    ASSERT_TRUE(run({"serve", "dem.tif"}).ok());
    EXPECT_THAT(urls_, ElementsAre("https://c/", "https://d/"));
}

TEST_F(Program, TakesFlagsAsTrueOrFalseOnly) {
    environment_ = {{"EYRIE_QUIET", "no"}};
    ASSERT_TRUE(run({"serve", "dem.tif"}).ok());
    EXPECT_FALSE(quiet_);
    environment_ = {{"EYRIE_QUIET", "perhaps"}};
    EXPECT_THAT(errorOf({"serve", "dem.tif"}), HasSubstr("EYRIE_QUIET"));
}

TEST_F(Program, ChecksWhatComesFromElsewhereAsIfItWereGiven) {
    environment_ = {{"EYRIE_RENDERERS", "65"}};
    EXPECT_THAT(errorOf({"serve", "dem.tif"}), HasSubstr("--renderers"));
}

TEST_F(Program, RefusesUnknownKeysWithWhatComesNear) {
    write("lsten = \"x:1\"\n");
    EXPECT_THAT(errorOf({"serve", "dem.tif", "--options", file_}),
                HasSubstr("did you mean 'listen'?"));
    write("[serv]\nlisten = \"x:1\"\n");
    EXPECT_THAT(errorOf({"serve", "dem.tif", "--options", file_}),
                HasSubstr("did you mean 'serve'?"));
    write("[serve]\nmemory = \"1G\"\n");  // another command's
    EXPECT_THAT(errorOf({"serve", "dem.tif", "--options", file_}),
                HasSubstr("'memory' is no option of eyrie serve"));
    write("print-config = true\n");
    EXPECT_THAT(errorOf({"serve", "dem.tif", "--options", file_}),
                HasSubstr("for the command line only"));
}

TEST_F(Program, RefusesAFileThatIsNotThereOrSaysThingsTwice) {
    EXPECT_THAT(errorOf({"serve", "dem.tif", "--options", "/nowhere.toml"}),
                HasSubstr("/nowhere.toml: cannot be read"));
    write("listen = \"a:1\"\nquiet = true\nlisten = \"b:2\"\n");
    EXPECT_THAT(errorOf({"serve", "dem.tif", "--options", file_}), HasSubstr("set twice"));
}

TEST_F(Program, RefusesAFolderOfOptions) {
    EXPECT_THAT(errorOf({"serve", "dem.tif", "--options", testing::TempDir()}),
                HasSubstr("this is a folder"));
}

TEST_F(Program, ReadsOptionsBehindAByteOrderMark) {
    write("\xEF\xBB\xBFlisten = \"a:1\"\r\n");
    ASSERT_TRUE(run({"serve", "dem.tif", "--options", file_}).ok());
    EXPECT_EQ(listen_, "a:1");
}

TEST_F(Program, LeavesWhatComesAfterTwoDashesAlone) {
    environment_ = {{"EYRIE_LISTEN", "environment:3"}};
    ASSERT_TRUE(run({"serve", "--", "--listen"}).ok());
    EXPECT_THAT(data_, ElementsAre("--listen"));
    EXPECT_EQ(listen_, "environment:3");
}

TEST_F(Program, PrintsEveryValueWithItsOriginAsAFileThatSaysTheSame) {
    write("quiet = true\n");
    environment_ = {{"EYRIE_RENDERERS", "3"}};
    ASSERT_TRUE(run({"serve", "dem.tif", "--options", file_, "--allow-url", "https://a/"}).ok());
    const std::string printed = printedConfig(line_);
    EXPECT_THAT(printed, HasSubstr("[serve]\n"));
    EXPECT_THAT(printed, HasSubstr("\n# listen = \"default:1\"  # default\n"));
    EXPECT_THAT(printed, HasSubstr("renderers = 3  # EYRIE_RENDERERS\n"));
    EXPECT_THAT(printed, HasSubstr("quiet = true  # " + file_ + "\n"));
    EXPECT_THAT(printed, HasSubstr("allow-url = \"https://a/\"  # the command line\n"));
    write(printed);
    environment_.clear();
    ASSERT_TRUE(run({"serve", "dem.tif", "--options", file_}).ok());
    EXPECT_EQ(renderers_, 3);
    EXPECT_THAT(urls_, ElementsAre("https://a/"));
}

TEST_F(Program, NamesTheVariablesOfAllCommands) {
    const Arguments variables = variablesOf(app_);
    for (const char* name : {"EYRIE_OPTIONS", "EYRIE_ALLOW_URL", "EYRIE_QUIET", "EYRIE_OUTPUT"})
        EXPECT_THAT(variables, testing::Contains(name));
    EXPECT_THAT(variables, testing::Not(testing::Contains("EYRIE_HELP")));
}

}  // namespace
}  // namespace eyrie::cli
