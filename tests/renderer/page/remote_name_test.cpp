// SPDX-License-Identifier: Apache-2.0
#include "renderer/page/remote_name.h"

#include <gtest/gtest.h>

namespace eyrie::page {
namespace {

TEST(RemoteName, IsAnAddressOrAVirtualFileSystemAndNothingElse) {
    for (const char* remote :
         {"http://h/a.eyt", "https://h/a.eyt", "HTTP://h/a.eyt", "Https://h/a.eyt",
          "/vsicurl/https://h/a.eyt", "/vsis3/bucket/a.eyt", "/vsigs/bucket/a.eyt",
          "/vsizip/vsicurl/https://h/a.zip/a.eyt", "/vsicurl?url=https%3A%2F%2Fh%2Fa.eyt"})
        EXPECT_TRUE(isRemote(remote)) << remote;
    for (const char* local : {"a.eyt", "/data/a.eyt", "https:/h/a.eyt", "/vsi", "/vsi/a.eyt",
                              "/vsibility-study.eyt", "./http://h/a.eyt", "", "ftp"})
        EXPECT_FALSE(isRemote(local)) << local;
}

TEST(RemoteName, IsNoneOfArchivesOfThisMachine) {
    for (const char* local :
         {"/vsizip/data/a.zip/b.tif", "/vsizip//data/a.zip/b.eyt", "/vsizip/{/data/a.zip}/b.eyt",
          "/vsitar/a.tar/b.eyt", "/vsigzip//data/a.eyt.gz"}) {
        EXPECT_FALSE(isRemote(local)) << local;
        EXPECT_TRUE(isVirtual(local) && !isPlainPath(local)) << local;
        EXPECT_TRUE(AllowedUrls().check(local).ok()) << local;
    }
    for (const char* remote :
         {"/vsizip//vsicurl/https://h/a.zip/b", "/vsizip/vsis3/bucket/a.zip/b",
          "/vsizip/{/vsis3/bucket/a.zip}/b", "/vsizip/{vsigs/bucket/a.zip}/b",
          "/vsitar//vsizip//VSICURL/h/a.zip/b.tar/c", "/vsizip/data/..//vsiaz/b/a.zip/c",
          "/vsigzip/http://h/a.gz", "/vsizip?/data/a.zip/b", "/vsisubfile/0_9,/data/a.eyt"}) {
        EXPECT_TRUE(isRemote(remote)) << remote;
        EXPECT_TRUE(absl::IsPermissionDenied(AllowedUrls().check(remote))) << remote;
    }
}

TEST(RemoteName, IsAPlainPathWhereNoAddressIsMeant) {
    for (const char* plain : {"a.ply", "/data/a.ply", "./s3://b/x", "C:/x"})
        EXPECT_TRUE(isPlainPath(plain)) << plain;
    for (const char* other : {"https://h/a.ply", "/vsis3/b/a.ply", "s3://b/a.ply", "ftp://h/a"})
        EXPECT_FALSE(isPlainPath(other)) << other;
}

TEST(RemoteName, OfAnAddressIsThatOfGdalsHttpFileSystem) {
    EXPECT_EQ(gdalName("https://h/a.eyt"), "/vsicurl/https://h/a.eyt");
    EXPECT_EQ(gdalName("HttpS://H/a.eyt"), "/vsicurl/https://H/a.eyt");
    EXPECT_EQ(gdalName("/vsicurl/HTTPS://h/a.eyt"), "/vsicurl/https://h/a.eyt");
    EXPECT_EQ(gdalName("/vsis3/b/a.eyt"), "/vsis3/b/a.eyt");
}

TEST(RemoteName, EndsBeforeTheQuery) {
    EXPECT_EQ(withoutQuery("https://h/a.eyt?signature=x.y#z"), "https://h/a.eyt");
    EXPECT_EQ(withoutQuery("/vsicurl/https://h/a.eyt?s=1"), "/vsicurl/https://h/a.eyt");
    EXPECT_EQ(withoutQuery("what?.eyt"), "what?.eyt");
}

TEST(RemoteName, OfAnotherKindIsRefusedWithWhatToWrite) {
    const auto saidOf = [](const char* name) { return checkScheme(name).ToString(); };
    EXPECT_NE(saidOf("s3://bucket/x.eyt").find("write /vsis3/bucket/x.eyt (docs/"),
              std::string::npos);
    EXPECT_NE(saidOf("GS://b/x").find("write /vsigs/b/x (docs/"), std::string::npos);
    EXPECT_NE(saidOf("ftp://h/x.eyt").find("ftp:// is not; download"), std::string::npos);
    EXPECT_TRUE(absl::IsInvalidArgument(checkScheme("s3://bucket/x.eyt")));
    for (const char* name : {"http://h/x", "HTTPS://h/x", "/vsis3/b/x", "a.eyt", "./s3://b/x",
                             "://x", "HDF5:\"a.h5\"://heights", "/vsicurl/ftp://h/x", "C:/x"})
        EXPECT_TRUE(checkScheme(name).ok()) << name;
}

TEST(AllowedUrls, AreNoneUnlessSaid) {
    EXPECT_TRUE(AllowedUrls().check("/data/a.eyt").ok());
    const absl::Status status = AllowedUrls().check("https://h/a.eyt");
    EXPECT_TRUE(absl::IsPermissionDenied(status));
    EXPECT_NE(status.ToString().find("https://h/a.eyt"), std::string::npos);
    EXPECT_NE(status.ToString().find("--allow-url"), std::string::npos);
    EXPECT_TRUE(AllowedUrls({"any"}).check("/vsis3/bucket/a.eyt").ok());
}

TEST(AllowedUrls, AreThoseBelowAPrefix) {
    const AllowedUrls allowed({"https://h/dem", "/vsis3/bucket/"});
    for (const char* good :
         {"https://h/dem/a.eyt", "https://h/dem", "/vsicurl/https://h/dem/a.eyt",
          "HTTPS://h/dem/a.eyt", "/vsicurl/HTTPS://h/dem/a.eyt", "/vsis3/bucket/x/a.eyt"})
        EXPECT_TRUE(allowed.check(good).ok()) << good;
    for (const char* bad :
         {"https://h/demo.eyt", "https://h/a.eyt", "http://h/dem/a.eyt", "HTTP://h/dem/a.eyt",
          "https://h.evil/dem/a.eyt", "https://h/dem/../a.eyt", "https://h/dem/%2E%2e/a.eyt",
          "/vsis3/bucket2/a.eyt", "/vsicurl?url=https://h/dem/a.eyt"})
        EXPECT_FALSE(allowed.check(bad).ok()) << bad;
    EXPECT_FALSE(AllowedUrls({"https://h"}).check("https://h.evil/a.eyt").ok());
    EXPECT_FALSE(AllowedUrls({"https://h"}).check("https://h@evil/a.eyt").ok());
}

}  // namespace
}  // namespace eyrie::page
