// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <functional>
#include <future>
#include <iterator>
#include <mutex>
#include <stop_token>
#include <thread>

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <png.h>
#include <sys/stat.h>
#include <unistd.h>

#include "cli/image_files.h"
#include "cli/log.h"
#include "cli/output_reader.h"
#include "cli/picture_bands.h"
#include "cli/picture_source.h"
#include "cli/progress_bar.h"
#include "cli/several_sources.h"
#include "fabric/frustum.h"
#include "fabric/log.h"
#include "fabric/status.h"
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

/// Rows `bottom` up to, but not with, `top` of an image.
fabric::Image rowsOf(const fabric::Image& image, int bottom, int top) {
    fabric::Image rows;
    rows.area = {0, bottom, image.area.width, top - bottom};
    const auto width = static_cast<std::ptrdiff_t>(image.area.width);
    rows.colour.assign(image.colour.begin() + bottom * width, image.colour.begin() + top * width);
    if (image.hasDepth())
        rows.depth.assign(image.depth.begin() + bottom * width, image.depth.begin() + top * width);
    return rows;
}

/// The rows of `image` in a picture of its size, `bandRows` at a time.
absl::Status writePicture(const fabric::Image& image, const std::string& path, int bandRows = 1) {
    ASSIGN_OR_RETURN(const auto file,
                     PictureFile::create(path, image.area.width, image.area.height));
    for (int top = image.area.height; top > 0; top -= bandRows)
        RETURN_IF_ERROR(file->append(rowsOf(image, std::max(0, top - bandRows), top)));
    return file->commit();
}

TEST(PictureFile, WritesAPngWithTheTopRowFirst) {
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

TEST(PictureFile, WritesAJpegForEitherEndingInAnyCase) {
    const test::TemporaryFolder folder;
    const fabric::Image grey = fabric::makeImage({0, 0, 16, 8}, {120, 120, 120, 255}, false);
    for (const char* name : {"a.jpg", "a.JPEG"}) {
        ASSERT_TRUE(writePicture(grey, folder.path(name), 3).ok());
        const std::string bytes = contents(folder.path(name));
        const auto image = wire::decodeJpeg(std::as_bytes(std::span(bytes)));
        ASSERT_TRUE(image.ok()) << image.status();
        EXPECT_EQ(image->area.width, 16);
        EXPECT_NEAR(image->colour.front().g, 120, 2);
    }
}

TEST(PictureFile, RefusesOtherEndingsAndWritesNothing) {
    const test::TemporaryFolder folder;
    for (const char* name : {"a.gif", "a", "png"})
        EXPECT_TRUE(absl::IsInvalidArgument(writePicture(sample(), folder.path(name)))) << name;
    EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

/// A picture that is given up, or cannot be written to its end, is no file.
TEST(PictureFile, AppearsWithItsLastRowOnly) {
    const test::TemporaryFolder folder;
    for (const char* name : {"a.png", "a.jpg"}) {
        const auto file = PictureFile::create(folder.path(name), 3, 2);
        ASSERT_TRUE(file.ok()) << file.status();
        ASSERT_TRUE((*file)->append(rowsOf(sample(), 1, 2)).ok());
        EXPECT_FALSE(std::filesystem::exists(folder.path(name)));
    }
    EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
    EXPECT_TRUE(absl::IsNotFound(PictureFile::create("/nowhere/a.png", 3, 2).status()));
}

TEST(DepthFile, IsALittleEndianPfmOfViewSpaceMetresWhateverOrderRowsComeIn) {
    const test::TemporaryFolder folder;
    const std::string path = folder.path("a.pfm");
    auto file = DepthFile::create(path, 3, 2);
    ASSERT_TRUE(file.ok()) << file.status();
    ASSERT_TRUE(file->put(rowsOf(sample(), 1, 2)).ok());
    ASSERT_TRUE(file->put(rowsOf(sample(), 0, 1)).ok());
    ASSERT_TRUE(file->commit().ok());
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

/// Draws the sample, whatever part of it is asked for, and remembers what was.
class SamplePictures final : public PictureSource {
public:
    absl::StatusOr<coordinator::RenderedFrame> draw(
        const coordinator::FrameRequest& request) override {
        {
            const std::lock_guard lock(mutex_);
            parts.push_back(request.part);
            shown.push_back(request.shown.front());
        }
        coordinator::RenderedFrame frame;
        frame.image = rowsOf(sample(), request.part.y, request.part.y + request.part.height);
        frame.statistics.triangles = 5;
        frame.statistics.tauAchievedPixels = request.part.y == 0 ? 0.25 : 0.5;
        frame.statistics.milliseconds.total = 10;
        frame.device.vendor = "sample";
        return frame;
    }
    int framesAtOnce() const override { return atOnce; }
    fabric::SceneInfo sceneInfo() const override { return {}; }
    fabric::Rgba background() const override { return {}; }

    int atOnce = 1;
    std::vector<fabric::PixelViewport> parts;
    std::vector<coordinator::Shown> shown;

private:
    std::mutex mutex_;  ///< guards parts and shown while pictures are drawn
};

coordinator::FrameRequest sampleRequest() {
    coordinator::FrameRequest request;
    request.width = 3;
    request.height = 2;
    return request;
}

TEST(DrawInBands, SeveralAtOnceStillComeFromTheTopDown) {
    SamplePictures pictures;
    pictures.atOnce = 3;
    std::vector<int> tops;
    const auto drawn = drawInBands(pictures, sampleRequest(), 3, [&](const fabric::Image& rows) {
        tops.push_back(rows.area.y);
        return absl::OkStatus();
    });
    ASSERT_TRUE(drawn.ok()) << drawn.status();
    EXPECT_THAT(tops, testing::ElementsAre(1, 0));
    EXPECT_EQ(drawn->statistics.triangles, 10U);
}

TEST(DrawInBands, DrawsWholeRowsFromTheTopDownAndAddsUpWhatTheyTook) {
    for (const int pixels : {1, 3, 5}) {
        SamplePictures pictures;
        fabric::Image picture = fabric::makeImage({0, 0, 3, 2}, {}, true);
        const auto drawn =
            drawInBands(pictures, sampleRequest(), pixels, [&](const fabric::Image& rows) {
                fabric::paste(rows, picture);
                return absl::OkStatus();
            });
        ASSERT_TRUE(drawn.ok()) << drawn.status();
        EXPECT_THAT(pictures.parts, testing::ElementsAre(fabric::PixelViewport{0, 1, 3, 1},
                                                         fabric::PixelViewport{0, 0, 3, 1}));
        EXPECT_TRUE(picture == sample());
        EXPECT_EQ(drawn->statistics.triangles, 10U);
        EXPECT_EQ(drawn->statistics.tauAchievedPixels, 0.5);
        EXPECT_EQ(drawn->statistics.milliseconds.total, 20);
        EXPECT_EQ(drawn->device.vendor, "sample");
    }
}

TEST(DrawInBands, DrawsAPictureThatFitsAtOnce) {
    SamplePictures pictures;
    const auto take = [](const fabric::Image&) { return absl::OkStatus(); };
    ASSERT_TRUE(drawInBands(pictures, sampleRequest(), 6, take).ok());
    EXPECT_THAT(pictures.parts, testing::ElementsAre(fabric::PixelViewport{0, 0, 3, 2}));
}

TEST(DrawInBands, DrawsTwoEyesOneAboveTheOtherFromTheTopDown) {
    SamplePictures pictures;
    coordinator::FrameRequest request = sampleRequest();
    request.shown = {{"wall", "", {}, compound::Stereo::TopBottom}};
    EXPECT_EQ(wholeSize(request), (PictureSize{3, 4}));
    fabric::Image picture = fabric::makeImage({0, 0, 3, 4}, {}, true);
    std::vector<int> bottoms;
    const auto drawn = drawInBands(pictures, request, 3, [&](const fabric::Image& rows) {
        bottoms.push_back(rows.area.y);
        fabric::paste(rows, picture);
        return absl::OkStatus();
    });
    ASSERT_TRUE(drawn.ok()) << drawn.status();
    EXPECT_THAT(bottoms, testing::ElementsAre(3, 2, 1, 0));
    EXPECT_EQ(rowsOf(picture, 0, 2), sample());
    EXPECT_EQ(rowsOf(picture, 2, 4).colour, sample().colour);
    const coordinator::Shown left{"wall", "", compound::Eye::Left, compound::Stereo::Configured};
    const coordinator::Shown right{"wall", "", compound::Eye::Right, compound::Stereo::Configured};
    EXPECT_THAT(pictures.shown, testing::ElementsAre(left, left, right, right));
    EXPECT_EQ(drawn->statistics.triangles, 20U);
}

TEST(DrawInBands, LeavesTwoEyesSideBySideInOneRow) {
    SamplePictures pictures;
    coordinator::FrameRequest request = sampleRequest();
    request.shown.front().stereo = compound::Stereo::SideBySide;
    EXPECT_EQ(wholeSize(request), (PictureSize{6, 2}));
    const auto take = [](const fabric::Image&) { return absl::OkStatus(); };
    ASSERT_TRUE(drawInBands(pictures, request, 6, take).ok());
    EXPECT_EQ(pictures.shown, request.shown);
    request.shown.front().eye = compound::Eye::Left;
    EXPECT_EQ(wholeSize(request), (PictureSize{3, 2})) << "of one eye";
}

TEST(DrawInBands, StopsWhereABandIsRefused) {
    SamplePictures pictures;
    const auto take = [](const fabric::Image&) { return absl::CancelledError("stop"); };
    EXPECT_TRUE(absl::IsCancelled(drawInBands(pictures, sampleRequest(), 3, take).status()));
    EXPECT_EQ(pictures.parts.size(), 1U);
}

TEST(WriteFile, SaysThatTheFolderIsMissing) {
    const absl::Status status = writeText("x", "/nowhere/at/all/a.json");
    EXPECT_TRUE(absl::IsNotFound(status)) << status;
    EXPECT_THAT(std::string(status.message()), testing::HasSubstr("/nowhere/at/all/a.json"));
}

TEST(OutputReader, OfAPipeIsWaitedForUntilSomebodyReadsItOrStops) {
    const test::TemporaryFolder folder;
    const std::string pipe = folder.path("pipe");
    ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
    std::stop_source stop;
    std::promise<absl::Status> awaited;
    std::jthread waiting(
        [&] { awaited.set_value(OutputReader::await(pipe, stop.get_token()).status()); });
    stop.request_stop();
    EXPECT_TRUE(absl::IsCancelled(awaited.get_future().get()));
    const int reading = ::open(pipe.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
    ASSERT_GE(reading, 0);
    {
        const auto reader = OutputReader::await(pipe, stop.get_token());
        ASSERT_TRUE(reader.ok()) << reader.status();
        char byte = 0;
        EXPECT_EQ(::read(reading, &byte, 1), -1) << "it has not ended, though nobody wrote";
    }
    ::close(reading);
}

TEST(OutputReader, OfAFileIsNotWaitedFor) {
    const test::TemporaryFolder folder;
    for (const std::string& path : {folder.path("new"), std::string("/dev/null"), std::string()})
        EXPECT_TRUE(OutputReader::await(path, {}).ok()) << path;
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
        bar.show("reading", 1, start + milliseconds(1001));  // the end, however soon, and once
        bar.show("reading", 1, start + milliseconds(1002));
        bar.show("writing", 0, start + milliseconds(1003));
    }
    std::fclose(out);
    const std::string result(text, size);
    std::free(text);
    return result;
}

TEST(ProgressBar, WritesALineAStageWhereThereIsNoTerminal) {
    EXPECT_EQ(written(ProgressBar::Style::Lines), "a.ply: reading\na.ply: writing\n");
}

TEST(ProgressBar, WritesJsonForPrograms) {
    EXPECT_EQ(written(ProgressBar::Style::Json),
              "{\"stage\": \"reading\", \"fraction\": 0}\n"
              "{\"stage\": \"reading\", \"fraction\": 0.5}\n"
              "{\"stage\": \"reading\", \"fraction\": 1}\n"
              "{\"stage\": \"writing\", \"fraction\": 0}\n");
}

/// Writing to a closed one fails; what is at work is to end in order.
TEST(ProgressBar, GoesOnWhereItsTerminalIsGone) {
    for (const auto style : {ProgressBar::Style::Bar, ProgressBar::Style::Lines}) {
        std::FILE* gone = std::fopen("/dev/full", "w");
        std::setvbuf(gone, nullptr, _IONBF, 0);
        {
            ProgressBar bar("a.ply", 10, "MB", style, gone);
            EXPECT_NO_THROW(bar.show("reading", 0, {}));
        }
        std::fclose(gone);
    }
}

/// What is told on standard error while entries of the log are JSON.
std::string toldAsJson(const std::function<void()>& tells) {
    startLog({true, "", "import"});
    testing::internal::CaptureStderr();
    tells();
    const std::string told = testing::internal::GetCapturedStderr();
    startLog();
    return told;
}

TEST(ProgressBar, WritesEntriesOfAJsonLog) {
    EXPECT_THAT(toldAsJson([] {
                    ProgressBar bar("a.ply", 10, "MB", ProgressBar::styleFor(false));
                    bar.show("reading", 0, {});
                }),
                testing::MatchesRegex("\\{.*\"message\": \"a.ply: reading\"\\}\n"));
}

TEST(Tell, WritesEachLineAsAnEntryOfAJsonLog) {
    EXPECT_THAT(toldAsJson([] {
                    tell("one\ntwo\n");
                    tell("");
                    tellErrors("three");
                }),
                testing::MatchesRegex("\\{.*\"info\".*\"one\"\\}\n"
                                      "\\{.*\"info\".*\"two\"\\}\n"
                                      "\\{.*\"error\".*\"three\"\\}\n"));
}

/// Commands that draw silence those who draw for them.
TEST(Tell, WritesEntriesBelowTheLevelOfRenderersButNotBelowWhatIsAskedFor) {
    EXPECT_THAT(toldAsJson([] {
                    quietLog();
                    tell("one");
                }),
                testing::HasSubstr("\"one\""));
    EXPECT_EQ(toldAsJson([] {
                  startLog({true, "warn", "import"});
                  tell("one");
              }),
              "");
}

TEST(Log, IsAsQuietAsACommandWantsWhereNoLevelWasAskedFor) {
    startLog();
    quietLog("error");
    EXPECT_EQ(spdlog::get_level(), spdlog::level::err);
    startLog({false, "info", "pick"});
    quietLog("error");
    EXPECT_EQ(spdlog::get_level(), spdlog::level::info);
    startLog();
}

TEST(Tell, NamesDataAsAnybodyMaySeeThem) {
    const std::string line = "http://joe:sekret@h/a.eyt?sig=sekret: it is gone";
    const auto say = [&] {
        tell(line);
        tellErrors(line);
        logFailure(line);
        spdlog::warn("{}", line);
    };
    testing::internal::CaptureStderr();
    startLog();
    say();
    for (const std::string& told : {testing::internal::GetCapturedStderr(), toldAsJson(say)}) {
        EXPECT_THAT(told, testing::Not(testing::HasSubstr("sekret")));
        EXPECT_EQ(std::ranges::count(told, '\n'), 4) << told;
        EXPECT_THAT(told, testing::HasSubstr("http://…@h/a.eyt?…: it is gone"));
    }
    EXPECT_EQ(titleOf({line.substr(0, line.find(": it"))}), "http://…@h/a.eyt?…");
}

/// Before they find that there is nothing to draw.
TEST(PictureSource, LeavesOfTheLogWarningsWhereNoLevelWasAskedFor) {
    for (const auto& [asked, level] : {std::pair("", spdlog::level::warn),
                                       {"debug", spdlog::level::debug},
                                       {"off", spdlog::level::off}})
        for (const bool quiet : {false, true}) {
            startLog({false, asked, "render"});
            PictureSourceOptions options;
            options.quiet = quiet;
            EXPECT_FALSE(PictureSource::open("/nowhere/a.eym", options, {}).ok());
            EXPECT_EQ(spdlog::get_level(), level) << asked;
        }
    startLog();
}

TEST(Tell, WritesLinesAsTheyAreForPeople) {
    testing::internal::CaptureStderr();
    tell("one\ntwo\n");
    tell("three");
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "one\ntwo\nthree\n");
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
