// SPDX-License-Identifier: Apache-2.0
#include "coordinator/farm/picture_assembly.h"

#include <algorithm>
#include <cstring>
#include <limits>
#include <span>
#include <string>

#include <gmock/gmock.h>
#include <rapidcheck/gtest.h>

#include "coordinator/farm/program_assembly.h"
#include "eyrie/v1/render_service.pb.h"
#include "wire/jpeg.h"
#include "wire/picture_header.h"

namespace eyrie::coordinator {
namespace {

const fabric::ChannelTask kTask{1, 1, 100, 50, {10, 5, 40, 20}, {}, true};

v1::ChannelHeader header(int x, int y, int width, int height, bool hasDepth = true) {
    v1::ChannelHeader message;
    message.mutable_area()->set_x(x);
    message.mutable_area()->set_y(y);
    message.mutable_area()->set_width(width);
    message.mutable_area()->set_height(height);
    message.set_has_depth(hasDepth);
    message.set_pixel_bytes(static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height) *
                            (hasDepth ? 8 : 4));
    return message;
}

std::string refusal(const v1::ChannelHeader& message) {
    PictureAssembly assembly(kTask);
    const absl::Status status = assembly.takeHeader(message);
    EXPECT_EQ(status.code(), absl::StatusCode::kInternal);
    return std::string(status.message());
}

RC_GTEST_PROP(PictureAssembly, AnyCutIntoChunksGivesThePixels, ()) {
    std::string pixels(7 * 3 * 8, ' ');
    for (std::size_t i = 0; i < pixels.size(); ++i) pixels[i] = static_cast<char>(i * 7);
    PictureAssembly assembly(kTask);
    RC_ASSERT(assembly.takeHeader(header(12, 6, 7, 3)).ok());
    for (std::size_t sent = 0; sent < pixels.size();) {
        const auto size = static_cast<std::size_t>(*rc::gen::inRange(1, 60));
        const std::string chunk = pixels.substr(sent, size);
        RC_ASSERT(assembly.takeChunk(chunk).ok());
        sent += chunk.size();
    }
    const fabric::ChannelResult result = assembly.finish().value();
    RC_ASSERT(std::memcmp(result.image.colour.data(), pixels.data(), 7 * 3 * 4) == 0);
    RC_ASSERT(std::memcmp(result.image.depth.data(), pixels.data() + 7 * 3 * 4, 7 * 3 * 4) == 0);
}

v1::ChannelHeader inMemory(v1::ChannelHeader message) {
    message.set_is_in_memory(true);
    return message;
}

TEST(PictureAssembly, APictureInMemoryIsCompleteWithItsHeader) {
    const auto memory = wire::PictureMemory::create(40 * 20 * 8).value();
    fabric::Image picture = fabric::makeImage({12, 6, 7, 3}, {1, 2, 3, 4}, true);
    picture.depth[5] = 0.25F;
    ASSERT_TRUE(wire::PictureMemory::open(memory->offer()).value()->put(picture));
    PictureAssembly assembly(kTask, memory.get());
    ASSERT_TRUE(assembly.takeHeader(inMemory(header(12, 6, 7, 3))).ok());
    ASSERT_TRUE(assembly.inMemory().has_value());
    EXPECT_TRUE(fabric::copied(*assembly.inMemory()) == picture);
    const fabric::Image image = assembly.finish().value().image;
    EXPECT_EQ(image.area, picture.area);
    EXPECT_TRUE(image.colour.empty());
}

TEST(PictureAssembly, APictureInMemoryThatWasNotOfferedOrIsSmallerIsRefused) {
    PictureAssembly none(kTask);
    EXPECT_EQ(none.takeHeader(inMemory(header(10, 5, 4, 4))).code(), absl::StatusCode::kInternal);
    const auto memory = wire::PictureMemory::create(4 * 4 * 8 - 1).value();
    PictureAssembly small(kTask, memory.get());
    EXPECT_EQ(small.takeHeader(inMemory(header(10, 5, 4, 4))).code(), absl::StatusCode::kInternal);
    EXPECT_FALSE(small.inMemory().has_value());
    EXPECT_EQ(small.finish().status().code(), absl::StatusCode::kInternal);
}

TEST(PictureAssembly, NothingMayComeAfterAPictureInMemory) {
    const auto memory = wire::PictureMemory::create(40 * 20 * 8).value();
    PictureAssembly assembly(kTask, memory.get());
    ASSERT_TRUE(assembly.takeHeader(inMemory(header(10, 5, 4, 4))).ok());
    EXPECT_EQ(assembly.takeChunk("1234").code(), absl::StatusCode::kInternal);
    EXPECT_EQ(assembly.takeHeader(header(10, 5, 4, 4)).code(), absl::StatusCode::kInternal);
}

TEST(PictureAssembly, MemoryThatWasOfferedNeedNotBeUsed) {
    const auto memory = wire::PictureMemory::create(40 * 20 * 8).value();
    PictureAssembly assembly(kTask, memory.get());
    ASSERT_TRUE(assembly.takeHeader(header(10, 5, 2, 1)).ok());
    ASSERT_TRUE(assembly.takeChunk(std::string(16, 'x')).ok());
    EXPECT_FALSE(assembly.inMemory().has_value());
    EXPECT_TRUE(assembly.finish().ok());
}

/// That is answered with a JPEG.
fabric::ChannelTask codedTask() {
    fabric::ChannelTask task = kTask;
    task.wantsDepth = false;
    task.jpegQuality = 80;
    return task;
}

v1::ChannelHeader jpegHeader() {
    v1::ChannelHeader message = header(12, 6, 7, 3, false);
    message.set_is_jpeg(true);
    return message;
}

std::string jpegOf(int width, int height) {
    const fabric::Image image = fabric::makeImage({0, 0, width, height}, {1, 2, 3, 255}, false);
    const auto bytes = wire::encodeJpeg(image, 80, wire::ChromaSubsampling::Half).value();
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

TEST(PictureAssembly, AJpegOfTheWholeTaskIsTakenAsItIs) {
    const fabric::ChannelTask task = codedTask();
    PictureAssembly assembly(task);
    ASSERT_TRUE(assembly.takeHeader(jpegHeader()).ok());
    const std::string jpeg = jpegOf(40, 20);
    ASSERT_TRUE(assembly.takeChunk(jpeg.substr(0, 100)).ok());
    ASSERT_TRUE(assembly.takeChunk(jpeg.substr(100)).ok());
    const auto result = assembly.finish();
    ASSERT_TRUE(result.ok()) << result.status();
    EXPECT_TRUE(std::ranges::equal(result->jpeg, std::as_bytes(std::span(jpeg))));
    EXPECT_EQ(result->image.area, (fabric::PixelViewport{12, 6, 7, 3}));
    EXPECT_TRUE(result->image.colour.empty());
}

TEST(PictureAssembly, AJpegInPlaceOfPixelsIsRefusedAndPixelsInPlaceOfAJpeg) {
    v1::ChannelHeader unasked = header(12, 6, 7, 3);
    unasked.set_is_jpeg(true);
    EXPECT_THAT(refusal(unasked), testing::HasSubstr("a JPEG, where pixels were asked for"));
    const fabric::ChannelTask task = codedTask();
    PictureAssembly assembly(task);
    EXPECT_THAT(std::string(assembly.takeHeader(header(10, 5, 2, 1, false)).message()),
                testing::HasSubstr("pixels, where a JPEG was asked for"));
}

TEST(PictureAssembly, AJpegOfAnotherSizeOrTooLargeOrNoneIsRefused) {
    const fabric::ChannelTask task = codedTask();
    const auto refusalOf = [&](const std::string& bytes) {
        PictureAssembly assembly(task);
        EXPECT_TRUE(assembly.takeHeader(jpegHeader()).ok());
        const absl::Status taken = assembly.takeChunk(bytes);
        const absl::Status status = taken.ok() ? assembly.finish().status() : taken;
        EXPECT_EQ(status.code(), absl::StatusCode::kInternal);
        return std::string(status.message());
    };
    EXPECT_THAT(refusalOf(jpegOf(41, 20)), testing::HasSubstr("a JPEG of 41x20 pixels"));
    EXPECT_THAT(refusalOf(std::string(40 * 20 * 4 + 70'000, 'x')),
                testing::HasSubstr("a JPEG of more than"));
    EXPECT_THAT(refusalOf("no JPEG"), testing::HasSubstr("jpeg: "));
    EXPECT_THAT(refusalOf(""), testing::HasSubstr("jpeg: "));
}

TEST(PictureAssembly, AnAreaOutsideTheTaskIsRefused) {
    EXPECT_THAT(refusal(header(9, 5, 10, 10)),
                testing::HasSubstr("outside the task's 40x20 at 10,5"));
    EXPECT_THAT(refusal(header(10, 5, 41, 20)), testing::HasSubstr("outside the task's"));
    EXPECT_THAT(refusal(header(10, 5, -4, 20)), testing::HasSubstr("pixel_viewport.width"));
    EXPECT_THAT(refusal(header(10, 5, std::numeric_limits<int>::max(), 20)),
                testing::HasSubstr("pixel_viewport.width"));
}

TEST(PictureAssembly, SizesThatDoNotMatchAreRefused) {
    v1::ChannelHeader wrong = header(10, 5, 4, 4);
    wrong.set_pixel_bytes(std::numeric_limits<std::uint64_t>::max());
    EXPECT_THAT(refusal(wrong), testing::HasSubstr("pixel_bytes"));
    EXPECT_THAT(refusal(header(10, 5, 4, 4, false)), testing::HasSubstr("has_depth"));
}

TEST(PictureAssembly, StatisticsThatAreNoNumbersAreRefused) {
    v1::ChannelHeader odd = header(10, 5, 4, 4);
    odd.mutable_statistics()->set_tau_achieved(std::numeric_limits<double>::quiet_NaN());
    EXPECT_THAT(refusal(odd), testing::HasSubstr("tau_achieved"));
}

TEST(PictureAssembly, TooFewAndTooManyPixelsAreRefused) {
    PictureAssembly few(kTask);
    ASSERT_TRUE(few.takeHeader(header(10, 5, 4, 4)).ok());
    ASSERT_TRUE(few.takeChunk(std::string(127, 'x')).ok());
    EXPECT_EQ(few.finish().status().code(), absl::StatusCode::kInternal);
    PictureAssembly many(kTask);
    ASSERT_TRUE(many.takeHeader(header(10, 5, 4, 4)).ok());
    EXPECT_EQ(many.takeChunk(std::string(129, 'x')).code(), absl::StatusCode::kInternal);
}

TEST(PictureAssembly, TheHeaderComesFirstAndOnce) {
    PictureAssembly headless(kTask);
    EXPECT_EQ(headless.takeChunk("x").code(), absl::StatusCode::kInternal);
    EXPECT_EQ(headless.finish().status().code(), absl::StatusCode::kInternal);
    PictureAssembly twice(kTask);
    ASSERT_TRUE(twice.takeHeader(header(10, 5, 4, 4)).ok());
    EXPECT_EQ(twice.takeHeader(header(10, 5, 4, 4)).code(), absl::StatusCode::kInternal);
}

TEST(PictureAssembly, NothingDrawnNeedsNoPixels) {
    PictureAssembly assembly(kTask);
    ASSERT_TRUE(assembly.takeHeader(header(0, 0, 0, 0, false)).ok());
    EXPECT_TRUE(assembly.finish().value().image.area.isEmpty());
}

TEST(PictureAssembly, BandsThatAreNoneAreRefused) {
    PictureAssembly assembly(kTask);
    v1::ChannelHeader runs = header(10, 5, 4, 4);
    runs.set_encoding(v1::PIXEL_ENCODING_ACTIVE_RUNS);
    ASSERT_TRUE(assembly.takeHeader(runs).ok());
    EXPECT_EQ(assembly.finish().status().code(), absl::StatusCode::kInternal);
    EXPECT_EQ(assembly.takeChunk("nonsense").code(), absl::StatusCode::kInternal);
    runs.set_encoding(static_cast<v1::PixelEncoding>(9));
    EXPECT_THAT(refusal(runs), testing::HasSubstr("encoding is 9"));
}

/// Two outputs go into the answer, one elsewhere; there is one draw.
const fabric::ChannelProgram kProgram{1,
                                      1,
                                      {0, 0, 40, 20},
                                      true,
                                      {},
                                      {{kTask,
                                        {},
                                        {{5, {0, 0, 4, 4}, true, ""},
                                         {6, {0, 0, 4, 4}, true, "unix:/run/r1"},
                                         {7, {4, 0, 4, 4}, false, ""}}}}};

v1::ProgramPictureHeader pictureHeader(std::uint32_t frame, const fabric::Image& image) {
    v1::ProgramPictureHeader message;
    message.set_frame(frame);
    wire::describe(image, wire::PixelEncoding::Raw, message);
    return message;
}

TEST(ProgramAssembly, PicturesComeInTheirOrderThenStatistics) {
    ProgramAssembly assembly(kProgram);
    const fabric::Image first = fabric::makeImage({1, 1, 2, 2}, {1, 2, 3, 4}, true);
    ASSERT_TRUE(assembly.takeHeader(pictureHeader(5, first)).ok());
    ASSERT_TRUE(assembly.takeChunk({reinterpret_cast<const char*>(first.colour.data()), 16}).ok());
    ASSERT_TRUE(assembly.takeChunk({reinterpret_cast<const char*>(first.depth.data()), 16}).ok());
    ASSERT_TRUE(assembly.takeHeader(pictureHeader(7, {})).ok());
    v1::ProgramStatistics statistics;
    statistics.add_draws()->set_triangles(12);
    ASSERT_TRUE(assembly.takeStatistics(statistics).ok());
    const auto result = assembly.finish();
    ASSERT_TRUE(result.ok()) << result.status();
    EXPECT_TRUE(result->pictures.at(0).image == first);
    EXPECT_EQ(result->pictures.at(1).frame, 7U);
    EXPECT_EQ(result->draws.at(0).triangles, 12U);
}

TEST(ProgramAssembly, AnswersThatAreNotTheProgramsAreRefused) {
    const fabric::Image image = fabric::makeImage({1, 1, 2, 2}, {}, true);
    const auto refused = [](const absl::Status& status) { return absl::IsInternal(status); };
    ProgramAssembly assembly(kProgram);
    EXPECT_TRUE(refused(assembly.finish().status()));
    EXPECT_TRUE(refused(assembly.takeChunk("x")));
    EXPECT_TRUE(refused(assembly.takeHeader(pictureHeader(6, image))));
    EXPECT_TRUE(
        refused(assembly.takeHeader(pictureHeader(5, fabric::makeImage({3, 3, 2, 2}, {}, true)))));
    EXPECT_TRUE(
        refused(assembly.takeHeader(pictureHeader(5, fabric::makeImage({1, 1, 2, 2}, {}, false)))));
    EXPECT_TRUE(refused(assembly.takeStatistics({})));
    ProgramAssembly few(kProgram);
    ASSERT_TRUE(few.takeHeader(pictureHeader(5, image)).ok());
    EXPECT_TRUE(refused(few.takeHeader(pictureHeader(7, {}))));
}

}  // namespace
}  // namespace eyrie::coordinator
