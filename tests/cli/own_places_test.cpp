// SPDX-License-Identifier: Apache-2.0
#include "cli/own_places.h"

#include <filesystem>
#include <vector>

#include <gmock/gmock.h>

#include "tests/support/temporary_folder.h"

namespace eyrie::cli {
namespace {

using testing::HasSubstr;

class OwnPlaces : public testing::Test {
protected:
    std::string at(const std::string& name) const { return folder_.path(name); }
    static std::string refusal(const std::vector<NamedFile>& written,
                               const std::vector<NamedFile>& read = {}) {
        const absl::Status status = checkOwnPlaces(written, read);
        return {status.message().data(), status.message().size()};
    }

    test::TemporaryFolder folder_;
};

TEST_F(OwnPlaces, AreOfOneFileEach) {
    EXPECT_EQ(refusal({{"-o", at("a.png")}, {"--depth", at("a.pfm")}, {"--stats", ""}}), "");
    EXPECT_THAT(refusal({{"-o", at("a.png")}, {"--depth", at("a.png")}}),
                HasSubstr("--depth is '" + at("a.png") + "', the same file as -o"));
    EXPECT_THAT(refusal({{"-o", at("a.png")}, {"--depth", at("./a.png")}}), HasSubstr("-o"));
    EXPECT_EQ(refusal({{"-o", ""}, {"--depth", ""}}), "");
}

TEST_F(OwnPlaces, AreNotThoseOfWhatIsRead) {
    const std::string scene = folder_.write("dem.eyt", "posts");
    std::filesystem::create_symlink(scene, at("link.eyt"));
    EXPECT_THAT(refusal({{"--depth", scene}}, {{"the scene", scene}}), HasSubstr("the scene"));
    EXPECT_THAT(refusal({{"--depth", scene}}, {{"the scene", at("link.eyt")}}),
                HasSubstr("the scene"));
    EXPECT_EQ(refusal({{"-o", at("a.png")}}, {{"the scene", scene}, {"--look", scene}}), "");
}

TEST_F(OwnPlaces, OfDevicesThereAreNone) {
    EXPECT_EQ(refusal({{"--depth", "/dev/null"}, {"--stats", "/dev/null"}}), "");
}

}  // namespace
}  // namespace eyrie::cli
