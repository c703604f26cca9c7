// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <limits>
#include <random>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "cli/bound_text.h"
#include "cli/exit_status.h"
#include "cli/json_object.h"
#include "cli/values.h"

namespace eyrie::cli {
namespace {

std::string messageOf(const absl::Status& status) { return std::string(status.message()); }

TEST(ParseHostPort, TakesNamesAddressesAndBracketedIpv6) {
    EXPECT_EQ(*parseHostPort("127.0.0.1:8080", "--listen"), (HostPort{"127.0.0.1", 8080}));
    EXPECT_EQ(*parseHostPort("viz.example:0", "--listen"), (HostPort{"viz.example", 0}));
    EXPECT_EQ(*parseHostPort("[::1]:65535", "--listen"), (HostPort{"::1", 65535}));
}

TEST(ParseHostPort, TakesNoHostForAllAddresses) {
    EXPECT_EQ(*parseHostPort(":80", "--listen"), (HostPort{"0.0.0.0", 80}));
}

TEST(ParseHostPort, NamesTheOptionAndWhatItFound) {
    for (const char* wrong : {"", "8080", "host:", "host:port", "host:-1", "host:65536", "host:80 ",
                              "host:0x50", "::1:80"}) {
        const auto result = parseHostPort(wrong, "--listen");
        ASSERT_TRUE(absl::IsInvalidArgument(result.status())) << wrong;
        EXPECT_THAT(messageOf(result.status()),
                    testing::HasSubstr("--listen is '" + std::string(wrong) + "'"));
    }
}

TEST(ParsePictureSize, TakesWidthAndHeightUpToTheLargestView) {
    EXPECT_EQ(*parsePictureSize("1280x720", "--size"), (PictureSize{1280, 720}));
    EXPECT_EQ(*parsePictureSize("1x16384", "--size"), (PictureSize{1, 16384}));
}

TEST(ParsePictureSize, RefusesEverythingElse) {
    for (const char* wrong : {"", "x", "1280", "1280x", "x720", "0x720", "-1x720", "1280x16385",
                              "1280X720", "1280x720x3", "12.5x7", " 1x1"})
        EXPECT_TRUE(absl::IsInvalidArgument(parsePictureSize(wrong, "--size").status())) << wrong;
}

TEST(ParsePixel, TakesThoseOfThePictureOnly) {
    EXPECT_EQ(*parsePixel("0,0", {640, 480}, "--pixel"), (PixelPlace{0, 0}));
    EXPECT_EQ(*parsePixel("639,479", {640, 480}, "--pixel"), (PixelPlace{639, 479}));
    for (const char* wrong :
         {"", ",", "5", "5,", "640,0", "0,480", "-1,0", "nan,0", "1,2,3", "1.5,2"})
        EXPECT_TRUE(absl::IsInvalidArgument(parsePixel(wrong, {640, 480}, "--pixel").status()))
            << wrong;
}

TEST(ParseShard, CountsFromZero) {
    EXPECT_EQ(*parseShard("0/1", 8, "--shard"), (ShardNumber{0, 1}));
    EXPECT_EQ(*parseShard("7/8", 8, "--shard"), (ShardNumber{7, 8}));
}

TEST(ParseShard, RefusesEverythingElse) {
    for (const char* wrong : {"", "/", "1", "1/", "/1", "0/0", "1/1", "8/8", "0/9", "-1/4", "1/-4",
                              "0x1/4", "1/4 ", "1/4/8", "4294967296/4294967297"})
        EXPECT_TRUE(absl::IsInvalidArgument(parseShard(wrong, 8, "--shard").status())) << wrong;
}

TEST(ParseBytes, CountsInPowersOf1024) {
    EXPECT_EQ(*parseBytes("1", "--memory"), 1U);
    EXPECT_EQ(*parseBytes("3K", "--memory"), 3U << 10);
    EXPECT_EQ(*parseBytes("2G", "--memory"), std::uint64_t{2} << 30);
    EXPECT_EQ(*parseBytes("16777215T", "--memory"), std::uint64_t{16777215} << 40);
}

TEST(ParseBytes, RefusesNothingFractionsAndOverflow) {
    for (const char* wrong :
         {"", "0", "0G", "G", "-1", "1.5G", "2GB", "2g", "16777216T", "18446744073709551616"})
        EXPECT_TRUE(absl::IsInvalidArgument(parseBytes(wrong, "--memory").status())) << wrong;
}

TEST(ExitStatusOf, BlamesTheInputOnlyForWhatTheCallerCanPutRight) {
    EXPECT_EQ(exitStatusOf(absl::OkStatus()), ExitStatus::Done);
    EXPECT_EQ(exitStatusOf(absl::InvalidArgumentError("")), ExitStatus::WrongInput);
    EXPECT_EQ(exitStatusOf(absl::NotFoundError("")), ExitStatus::WrongInput);
    EXPECT_EQ(exitStatusOf(absl::DataLossError("")), ExitStatus::WrongInput);
    for (const absl::Status& status :
         {absl::FailedPreconditionError(""), absl::ResourceExhaustedError(""),
          absl::UnavailableError(""), absl::CancelledError(""), absl::InternalError("")})
        EXPECT_EQ(exitStatusOf(status), ExitStatus::Failed) << status;
}

TEST(JsonObject, KeepsTheOrderOfItsFields) {
    EXPECT_EQ(JsonObject().text("b", "x").number("a", 0.5).count("c", 7).str(),
              R"({"b": "x", "a": 0.5, "c": 7})");
    EXPECT_EQ(JsonObject().str(), "{}");
}

TEST(JsonObject, EscapesWhatJsonDoesNotAllowInText) {
    EXPECT_EQ(JsonObject().text("t", "say \"hi\"\\\n\x01 å").str(),
              "{\"t\": \"say \\\"hi\\\"\\\\\\u000a\\u0001 å\"}");
}

TEST(JsonObject, WritesInfinityAsProtobufDoesAndNullForNone) {
    const double infinity = std::numeric_limits<double>::infinity();
    EXPECT_EQ(JsonObject().number("a", infinity).number("b", -infinity / infinity).str(),
              R"({"a": "Infinity", "b": null})");
}

TEST(JsonObject, WritesDoublesThatReadBackTheSame) {
    EXPECT_EQ(JsonObject().number("x", 0.1).number("y", 5163515.466987492).str(),
              R"({"x": 0.1, "y": 5163515.466987492})");
}

TEST(JsonObject, Nests) {
    const fabric::Box box{{0, 1, 2}, {3, 4, 5.5}};
    EXPECT_EQ(JsonObject().box("b", box).object("o", JsonObject().count("n", 1)).str(),
              R"({"b": {"min": [0, 1, 2], "max": [3, 4, 5.5]}, "o": {"n": 1}})");
    EXPECT_EQ(JsonObject().objects("l", {JsonObject(), JsonObject().count("n", 2)}).str(),
              R"({"l": [{}, {"n": 2}]})");
}

TEST(BoundText, IsNeverBelowTheBoundNorFarAboveIt) {
    EXPECT_EQ(boundText(0.12341), "0.124");
    EXPECT_EQ(boundText(0.1239), "0.124");
    EXPECT_EQ(boundText(0.999), "0.999");
    EXPECT_EQ(boundText(0.9991), "1");
    EXPECT_EQ(boundText(0), "0");
    EXPECT_EQ(boundText(std::numeric_limits<double>::infinity()), "inf");
    std::mt19937 random(5);
    std::uniform_real_distribution<double> magnitude(-12, 12);
    for (int i = 0; i < 10000; ++i) {
        const double bound = std::pow(10, magnitude(random));
        const double told = std::stod(boundText(bound));
        EXPECT_GE(told, bound);
        EXPECT_LE(told, bound * 1.0101);
    }
}

}  // namespace
}  // namespace eyrie::cli
