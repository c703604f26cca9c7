// SPDX-License-Identifier: Apache-2.0
#include "fabric/shown_name.h"

#include <gtest/gtest.h>

namespace eyrie::fabric {
namespace {

TEST(ShownName, HasNeitherUserNorPassword) {
    EXPECT_EQ(shownName("http://joe:sekret@host/a.tif"), "http://…@host/a.tif");
    EXPECT_EQ(shownName("HTTPS://joe:s@ret@host:81"), "HTTPS://…@host:81");
    EXPECT_EQ(shownName("/vsizip/vsicurl/https://token@host/a.zip/b"),
              "/vsizip/vsicurl/https://…@host/a.zip/b");
    EXPECT_EQ(shownName("http://host/a@b.tif"), "http://host/a@b.tif");
}

TEST(ShownName, HasNoQuery) {
    EXPECT_EQ(shownName("https://host/a.eyt?sig=S/x.y"), "https://host/a.eyt?…");
    EXPECT_EQ(shownName("http://joe@host?to=http://sue:pw@other/#?"), "http://…@host?…");
    EXPECT_EQ(shownName("/vsicurl?header.Authorization=S&url=https%3A%2F%2Fh%2Fa.eyt"),
              "/vsicurl?…");
}

TEST(ShownName, LeavesPathsAndStoresAsTheyAre) {
    for (const char* name : {"", "a.tif", "/data/what?.eyt", "me@home.eym", "/vsis3/bucket/key?v",
                             "HDF5:\"a.h5\"://heights", "https://host/a.eyt", "://", "a://"})
        EXPECT_EQ(shownName(name), name);
}

TEST(ShownName, LeavesWhatATextSaysBehindAnAddress) {
    EXPECT_EQ(
        shownName("https://h/a.eyt?sig=S: no answer; see `/vsicurl/http://u:p@h/b?s' (or "
                  "http://h/c?x), me@h"),
        "https://h/a.eyt?…: no answer; see `/vsicurl/http://…@h/b?…' (or http://h/c?…), me@h");
}

TEST(ShownName, StaysAsItIsOnceItIsShown) {
    const std::string shown = shownName("a http://joe:pw@h/a?b: c");
    EXPECT_EQ(shown, "a http://…@h/a?…: c");
    EXPECT_EQ(shownName(shown), shown);
}

}  // namespace
}  // namespace eyrie::fabric
