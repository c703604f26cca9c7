// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <iterator>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <png.h>

#include "cli/image_files.h"
#include "cli/progress_bar.h"
#include "fabric/frustum.h"
#include "tests/support/temporary_folder.h"
#include "wire/jpeg.h"

namespace eyrie::cli {
namespace {

using fabric::Rgba;

std::string contents(const std::string& path) {
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

/// 3 x 2: red, green, blue below; grey shades above.
fabric::Image sample() {
    fabric::Image image = fabric::makeImage({0, 0, 3, 2}, {}, true);
    image.colour = {{255, 0, 0, 255}, {0, 255, 0, 255},  {0, 0, 255, 255},
                    {9, 9, 9, 255},   {99, 99, 99, 255}, {199, 199, 199, 255}};
    image.depth = {1.0F, 0.5F, 0.25F, 0.0F, 1e-6F, 2e-6F};
    return image;
}

TEST(WritePicture, WritesAPngWithTheTopRowFirst) {
    const test::TemporaryFolder folder;
    const std::string path = folder.path("a.png");
    ASSERT_TRUE(writePicture(sample(), path).ok());
    png_image png{};
    png.version = PNG_IMAGE_VERSION;
    ASSERT_NE(png_image_begin_read_from_file(&png, path.c_str()), 0);
    png.format = PNG_FORMAT_RGB;
    ASSERT_EQ(png.width, 3U);
    ASSERT_EQ(png.height, 2U);
    std::vector<std::uint8_t> rgb(PNG_IMAGE_SIZE(png));
    ASSERT_NE(png_image_finish_read(&png, nullptr, rgb.data(), 0, nullptr), 0);
    EXPECT_THAT(rgb, testing::ElementsAre(9, 9, 9, 99, 99, 99, 199, 199, 199,  //
                                          255, 0, 0, 0, 255, 0, 0, 0, 255));
}

TEST(WritePicture, WritesAJpegForEitherEndingInAnyCase) {
    const test::TemporaryFolder folder;
    const fabric::Image grey = fabric::makeImage({0, 0, 16, 8}, {120, 120, 120, 255}, false);
    for (const char* name : {"a.jpg", "a.JPEG"}) {
        ASSERT_TRUE(writePicture(grey, folder.path(name)).ok());
        const std::string bytes = contents(folder.path(name));
        const auto image = wire::decodeJpeg(std::as_bytes(std::span(bytes)));
        ASSERT_TRUE(image.ok()) << image.status();
        EXPECT_EQ(image->area.width, 16);
        EXPECT_NEAR(image->colour.front().g, 120, 2);
    }
}

TEST(WritePicture, RefusesOtherEndingsAndWritesNothing) {
    const test::TemporaryFolder folder;
    for (const char* name : {"a.gif", "a", "png"})
        EXPECT_TRUE(absl::IsInvalidArgument(writePicture(sample(), folder.path(name)))) << name;
    EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(WriteDepth, WritesALittleEndianPfmOfViewSpaceMetres) {
    const test::TemporaryFolder folder;
    const std::string path = folder.path("a.pfm");
    ASSERT_TRUE(writeDepth(sample(), path).ok());
    const std::string bytes = contents(path);
    const std::string header = "Pf\n3 2\n-1.0\n";
    ASSERT_EQ(bytes.size(), header.size() + 6 * sizeof(float));
    EXPECT_EQ(bytes.substr(0, header.size()), header);
    std::array<float, 6> metres{};
    std::memcpy(metres.data(), bytes.data() + header.size(), sizeof metres);
    const auto near = static_cast<float>(fabric::kNearMetres);
    EXPECT_FLOAT_EQ(metres[0], near);
    EXPECT_FLOAT_EQ(metres[1], 2 * near);
    EXPECT_FLOAT_EQ(metres[2], 4 * near);
    EXPECT_EQ(metres[3], INFINITY);
    EXPECT_FLOAT_EQ(metres[4], 1000);
}

TEST(WriteFile, SaysThatTheFolderIsMissing) {
    const absl::Status status = writeText("x", "/nowhere/at/all/a.json");
    EXPECT_TRUE(absl::IsNotFound(status)) << status;
    EXPECT_THAT(std::string(status.message()), testing::HasSubstr("/nowhere/at/all/a.json"));
}

TEST(ProgressLine, ShowsRateAndTimeLeft) {
    EXPECT_EQ(progressLine("dem.tif", "reading", 0.5, 2, 60, "MB"),
              "dem.tif: reading [############            ]  50 %, 15.0 MB/s, 2 s left");
}

TEST(ProgressLine, GuessesNoRateBeforeItHasSettled) {
    EXPECT_EQ(progressLine("a", "b", 0, 5, 60, "MB"), "a: b [                        ]   0 %");
    EXPECT_EQ(progressLine("a", "b", 1, 0.1, 60, "MB"), "a: b [########################] 100 %");
}

TEST(ProgressLine, LeavesTheRateOutWhereThereIsNothingToCount) {
    EXPECT_THAT(progressLine("a", "b", 0.25, 1, 0, "MB"), testing::EndsWith(" 25 %, 3 s left"));
}

/// What a bar of `style` writes for two stages.
std::string written(ProgressBar::Style style) {
    char* text = nullptr;
    std::size_t size = 0;
    std::FILE* out = open_memstream(&text, &size);
    {
        ProgressBar bar("a.ply", 10, "MB", style, out);
        const ProgressBar::Clock::time_point start{};
        using std::chrono::milliseconds;
        bar.show("reading", 0, start);
        bar.show("reading", 0.25, start + milliseconds(1));  // too soon to be drawn again
        bar.show("reading", 0.5, start + milliseconds(1000));
        bar.show("writing", 0, start + milliseconds(1001));
    }
    std::fclose(out);
    const std::string result(text, size);
    std::free(text);
    return result;
}

TEST(ProgressBar, WritesALineAStageWhereThereIsNoTerminal) {
    EXPECT_EQ(written(ProgressBar::Style::Lines), "a.ply: reading\na.ply: writing\n");
}

TEST(ProgressBar, WritesNothingWhenQuiet) { EXPECT_EQ(written(ProgressBar::Style::Quiet), ""); }

TEST(ProgressBar, RedrawsAtMostTenTimesASecondAndEndsOnAnEmptyLine) {
    const std::string text = written(ProgressBar::Style::Bar);
    EXPECT_EQ(text.find("25 %"), std::string::npos);
    EXPECT_THAT(text, testing::HasSubstr(" 50 %, 5.0 MB/s, 1 s left"));
    EXPECT_THAT(text, testing::HasSubstr("writing"));
    EXPECT_THAT(text, testing::EndsWith("\r\x1b[K"));
}

}  // namespace
}  // namespace eyrie::cli
