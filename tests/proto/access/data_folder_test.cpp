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

/// Ways out that have worked somewhere: each step up in each spelling, in each place, and more.
std::vector<std::string> attempts() {
    std::vector<std::string> result;
    const std::vector<std::string> ups = {"..",
                                          "%2e%2e",
                                          "%2E%2E",
                                          ".%2e",
                                          "%2e.",
                                          "%252e%252e",
                                          "..%00",
                                          "%c0%ae%c0%ae",
                                          "\xc0\xae\xc0\xae",
                                          "..;",
                                          "....",
                                          "...",
                                          ".. ",
                                          " ..",
                                          "..\t",
                                          "%u002e%u002e",
                                          "%uff0e%uff0e",
                                          "\xef\xbc\x8e\xef\xbc\x8e",
                                          "\xe2\x80\xa5",
                                          "..\r\n",
                                          "\xe0\x80\xae\xe0\x80\xae",
                                          "..\x7f",
                                          "%%32%65%%32%65",
                                          ".\xe2\x80\x8b.",
                                          "..%0a"};
    const std::vector<std::string> slashes = {"/",     "\\",       "%2f",    "%5c",
                                              "%252f", "\xc0\xaf", "%c0%af", "//"};
    for (const std::string& up : ups)
        for (const std::string& slash : slashes) {
            result.push_back(up + slash + "secret.txt");
            result.push_back("survey" + slash + up + slash + up + slash + "secret.txt");
        }
    for (const char* path : {"/etc/passwd",
                             "//etc/passwd",
                             "///etc/passwd",
                             "\\\\server\\share\\file",
                             "//server/share",
                             "C:\\windows\\win.ini",
                             "C:/windows/win.ini",
                             "c:secret",
                             "file:///etc/passwd",
                             "file:/etc/passwd",
                             "http://127.0.0.1/x",
                             "https://169.254.169.254/latest",
                             "s3://bucket/x",
                             "/vsicurl/http://127.0.0.1/",
                             "/vsizip//etc/x.zip/y",
                             "/vsistdin/",
                             "/vsimem/x",
                             "NETCDF:/etc/passwd",
                             "ZARR:\"/etc\"",
                             "GTIFF_DIR:1:/etc/passwd",
                             "/proc/self/environ",
                             "/proc/self/fd/0",
                             "/dev/stdin",
                             "/dev/zero",
                             "~/secret.txt",
                             "~root/.ssh/id_rsa",
                             "$HOME/secret.txt",
                             "${HOME}",
                             "`id`",
                             "|id",
                             "-o",
                             "--config=/etc/passwd",
                             "",
                             ".",
                             "..",
                             "./secret.txt",
                             "survey/.",
                             "survey/..",
                             "survey/./../..",
                             "survey/",
                             "survey//scan.eym",
                             "/survey",
                             "dem.eyt/",
                             "dem.eyt/..",
                             "dem.eyt/../../secret.txt",
                             "../data-two/secret.txt",
                             "../data/dem.eyt",
                             "..\\data-two\\secret.txt",
                             "passwd",
                             "etc",
                             "etc/passwd",
                             "survey/root",
                             "survey/root/etc/passwd",
                             "survey/root/proc/self/root/etc/passwd",
                             "up.txt",
                             "parent",
                             "parent/secret.txt",
                             "parent/data/dem.eyt",
                             "two",
                             "two/secret.txt",
                             "survey/far.txt",
                             "loop",
                             "loop/x",
                             "dangling",
                             "new.txt",
                             "folder/../../secret.txt",
                             "folder/root/etc/passwd",
                             "self",
                             "self/environ",
                             "self/root/etc/passwd",
                             "self/cwd",
                             "fd",
                             "fd/0",
                             "con",
                             "nul",
                             "aux",
                             "com1",
                             "dem.eyt::$DATA",
                             "dem.eyt:stream",
                             "survey\n/../../secret.txt",
                             "secret.txt\r\nX: y",
                             "\xff\xfe",
                             "\xed\xa0\x80",
                             "\xf4\x90\x80\x80",
                             "\xf8\x88\x80\x80\x80"})
        result.emplace_back(path);
    result.push_back(std::string("dem.eyt\0.txt", 12));
    result.push_back(std::string("..\0/secret.txt", 14));
    result.push_back(std::string("\0", 1));
    result.push_back(std::string("up.txt\0", 7));
    result.push_back(std::string(5000, 'a'));
    result.push_back(std::string(256, 'a'));
    std::string deep;
    for (int i = 0; i < 300; ++i) deep += "../";
    result.push_back(deep + "etc/passwd");
    result.push_back("survey/" + deep + "etc/passwd");
    result.push_back(std::string(1000, '/') + "etc/passwd");
    return result;
}

TEST_F(Traversal, NothingOutsideIsReached) {
    const std::vector<std::string> names = attempts();
    EXPECT_GE(names.size(), 200u);
    for (const std::string& name : names) expectHeld(name);
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
    EXPECT_TRUE(absl::IsNotFound(folder_->place("none/new.eyt").status()));
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
