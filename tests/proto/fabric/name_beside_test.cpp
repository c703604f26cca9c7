// SPDX-License-Identifier: Apache-2.0
#include "fabric/name_beside.h"

#include <string>

#include <gtest/gtest.h>

namespace eyrie::fabric {
namespace {

constexpr std::size_t kLongest = 255;

TEST(NameBeside, IsThePathAndTheEndingAsLongAsNamesMayBe) {
    EXPECT_EQ(nameBeside("folder/a.eyt", ".source"), "folder/a.eyt.source");
    const std::string path = "folder/" + std::string(kLongest - 7, 'a');
    EXPECT_EQ(nameBeside(path, ".source"), path + ".source");
}

TEST(NameBeside, IsShorterAndStillItsOwnWhereThePathsNameIsLong) {
    for (const std::size_t length : {kLongest - 6, kLongest}) {
        const std::string name(length - 1, 'a');
        const std::string of = nameBeside("folder/" + name + "b", ".source");
        EXPECT_EQ(of.size(), std::string("folder/").size() + kLongest);
        EXPECT_TRUE(of.starts_with("folder/aaaa") && of.ends_with(".source")) << of;
        EXPECT_EQ(of, nameBeside("folder/" + name + "b", ".source"));
        EXPECT_NE(of, nameBeside("folder/" + name + "c", ".source"));
        EXPECT_EQ(nameBeside(name + "b", ".source"), of.substr(7));
    }
}

TEST(NameBeside, HasNoPartOfACharacter) {
    for (int before = 0; before < 3; ++before) {
        std::string name(static_cast<std::size_t>(before), 'a');
        while (name.size() + 3 <= kLongest) name += "山";
        const std::string of = nameBeside(name, ".source");
        const std::string kept = of.substr(0, of.find('~'));
        EXPECT_EQ((kept.size() - static_cast<std::size_t>(before)) % 3, 0U) << of;
        EXPECT_GT(of.size(), kLongest - 3);
    }
}

}  // namespace
}  // namespace eyrie::fabric
