// SPDX-License-Identifier: Apache-2.0
#include "access/data_folder.h"

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "access/printable.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/ways_out.h"

namespace eyrie::access {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::Not;

/// A data folder with a secret beside it, and links of every kind.
class Traversal : public testing::Test {
protected:
    Traversal() {
        fs::create_directories(root_.path() / "data/survey/2026");
        fs::create_directories(root_.path() / "data-two");
        write("secret.txt");
        write("data-two/secret.txt");
        write("data/dem.eyt");
        write("data/survey/scan.eym");
        write("data/survey/2026/ö λ.eym");
        link("/etc/passwd", "data/passwd");
        link("/etc", "data/etc");
        link("/", "data/survey/root");
        link("../secret.txt", "data/up.txt");
        link("..", "data/parent");
        link("../data-two", "data/two");
        link("../../secret.txt", "data/survey/far.txt");
        link("loop", "data/loop");
        link("missing", "data/dangling");
        link("../new.txt", "data/new.txt");
        link("survey/scan.eym", "data/inside.eym");
        link("survey", "data/folder");
        link("/proc/self", "data/self");
        link("/dev/fd", "data/fd");
        folder_ = std::make_unique<DataFolder>(*DataFolder::open(root_.path() / "data"));
    }

    void write(const std::string& name) { std::ofstream(root_.path() / name) << "SECRET"; }
    void link(const std::string& to, const std::string& name) {
        fs::create_symlink(to, root_.path() / name);
    }

    /// Neither read nor write reaches anything outside by `name`.
    void expectHeld(const std::string& name) const {
        for (const auto& path : {folder_->existing(name), folder_->place(name)}) {
            if (!path.ok()) {
                EXPECT_THAT(std::string(path.status().message()),
                            Not(HasSubstr(root_.path().string())))
                    << "the message tells where the folder is";
                continue;
            }
            const std::string real = fs::weakly_canonical(*path).string();
            EXPECT_TRUE(real.starts_with(folder_->path().string() + "/"))
                << printable(name) << " -> " << real;
        }
    }

    test::TemporaryFolder root_;
    std::unique_ptr<DataFolder> folder_;
};

TEST_F(Traversal, NothingOutsideIsReached) {
    const std::vector<std::string> names = test::waysOut();
    EXPECT_GE(names.size(), 400u);
    for (const std::string& name : names) expectHeld(name);
}

/// A name is none of a request's targets: one in absolute form leads nowhere either.
TEST_F(Traversal, NothingIsNamedByAnAddress) {
    for (const std::string& way : test::waysOut())
        for (const char* server :
             {"http://127.0.0.1:8080/", "https://localhost/", "HTTP://[::1]/"}) {
            expectHeld(server + way);
            EXPECT_TRUE(absl::IsInvalidArgument(folder_->existing(server + way).status()))
                << printable(way);
        }
}

TEST_F(Traversal, LinksThatLeadOutsideAreRefusedAndToldFromWhatIsMissing) {
    for (const char* name : {"passwd", "etc/passwd", "survey/root/etc/passwd", "up.txt",
                             "parent/secret.txt", "two/secret.txt", "survey/far.txt", "loop"})
        EXPECT_TRUE(absl::IsPermissionDenied(folder_->existing(name).status())) << name;
    for (const char* name : {"dangling", "missing.eyt", "survey/none/x", "dem.eyt/x"})
        EXPECT_TRUE(absl::IsNotFound(folder_->existing(name).status())) << name;
    for (const char* name : {"../dem.eyt", "/etc/passwd", "survey/", "C:/x", ""})
        EXPECT_TRUE(absl::IsInvalidArgument(folder_->existing(name).status())) << name;
}

TEST_F(Traversal, NamesBelowTheFolderAreFound) {
    EXPECT_EQ(*folder_->existing("dem.eyt"), folder_->path() / "dem.eyt");
    EXPECT_EQ(*folder_->existing("survey/2026/ö λ.eym"), folder_->path() / "survey/2026/ö λ.eym");
    EXPECT_EQ(*folder_->existing("inside.eym"), folder_->path() / "survey/scan.eym");
    EXPECT_EQ(*folder_->existing("folder/scan.eym"), folder_->path() / "survey/scan.eym");
    EXPECT_EQ(*folder_->existing("survey"), folder_->path() / "survey");
}

TEST_F(Traversal, FilesAreWrittenBelowTheFolderAndNeverThroughALink) {
    EXPECT_EQ(*folder_->place("new.eyt"), folder_->path() / "new.eyt");
    EXPECT_EQ(*folder_->place("folder/new.eyt"), folder_->path() / "survey/new.eyt");
    EXPECT_EQ(*folder_->place("dem.eyt"), folder_->path() / "dem.eyt");
    const absl::Status missing = folder_->place("none/new.eyt").status();
    EXPECT_TRUE(absl::IsNotFound(missing));
    EXPECT_EQ(missing.message(), "data 'none': No such file or directory");
    const absl::Status inFile = folder_->place("dem.eyt/new.eyt").status();
    EXPECT_TRUE(absl::IsNotFound(inFile));
    EXPECT_EQ(inFile.message(), "data 'dem.eyt': Not a directory");
    EXPECT_TRUE(absl::IsPermissionDenied(folder_->place("two/new.eyt").status()));
    for (const char* name : {"survey", "new.txt", "inside.eym", "dangling", "loop"})
        EXPECT_TRUE(absl::IsFailedPrecondition(folder_->place(name).status())) << name;
}

TEST_F(Traversal, AFolderThatHasGoneIsToldFromNamesThatAreMissing) {
    EXPECT_TRUE(folder_->check().ok());
    fs::rename(root_.path() / "data", root_.path() / "elsewhere");
    EXPECT_TRUE(absl::IsUnavailable(folder_->check()));
    EXPECT_TRUE(absl::IsUnavailable(folder_->existing("dem.eyt").status()));
    EXPECT_TRUE(absl::IsUnavailable(folder_->place("new.eyt").status()));
    EXPECT_THAT(std::string(folder_->check().message()), Not(HasSubstr(root_.path().string())));
}

TEST_F(Traversal, AFolderThatIsNoneIsRefused) {
    EXPECT_TRUE(absl::IsNotFound(DataFolder::open(root_.path() / "none").status()));
    EXPECT_TRUE(absl::IsInvalidArgument(DataFolder::open(root_.path() / "secret.txt").status()));
}

RC_GTEST_PROP(DataName, OfAnyBytesStaysBelowTheFolder, (const std::vector<std::string>& parts)) {
    std::string name;
    for (const std::string& part : parts) name += (name.empty() ? "" : "/") + part;
    if (checkDataName(name).ok()) {
        const fs::path path = (fs::path("/data") / name).lexically_normal();
        RC_ASSERT(path.string().starts_with("/data/"));
        RC_ASSERT(isUtf8(name));
    }
}

}  // namespace
}  // namespace eyrie::access
