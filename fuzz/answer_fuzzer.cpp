// SPDX-License-Identifier: Apache-2.0
// What renderers say, of any bytes: values that hold what they promise, pictures as large as was
// asked for, or a message. The first byte says which of their messages it is. Of pictures there are
// several, each with its length, two bytes, before it.
#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <optional>
#include <string_view>

#include <google/protobuf/stubs/logging.h>

#include "coordinator/farm/picture_assembly.h"
#include "coordinator/farm/program_assembly.h"
#include "eyrie/v1/registry_service.pb.h"
#include "eyrie/v1/render_service.pb.h"
#include "wire/jpeg.h"
#include "wire/pick.h"
#include "wire/picture_header.h"
#include "wire/scene_info.h"
#include "wire/statistics.h"

namespace {

using namespace eyrie;

constexpr fabric::PixelViewport kArea{10, 5, 40, 20};

template <typename Message>
bool parse(std::string_view bytes, Message& message) {
    return message.ParseFromArray(bytes.data(), static_cast<int>(bytes.size()));
}

/// Calls `take` with each message until it fails.
template <typename Message, typename Take>
void forEach(std::string_view bytes, const Take& take) {
    while (bytes.size() >= 2) {
        const std::size_t size = static_cast<std::uint8_t>(bytes[0]) |
                                 static_cast<std::size_t>(static_cast<std::uint8_t>(bytes[1])) << 8;
        bytes.remove_prefix(2);
        Message message;
        if (!parse(bytes.substr(0, size), message) || !take(message).ok())
            return;
        bytes.remove_prefix(std::min(size, bytes.size()));
    }
}

void checkPicture(const fabric::Image& image, const fabric::PixelViewport& asked, bool wantsDepth) {
    const fabric::PixelViewport& area = image.area;
    const auto pixels = static_cast<std::size_t>(area.area());
    if (!(area.isEmpty() || asked.contains(area)) || image.colour.size() != pixels ||
        image.depth.size() != (image.hasDepth() ? pixels : 0) ||
        (wantsDepth && !area.isEmpty() && !image.hasDepth()))
        std::abort();
}

/// The answer to a task.
void takeChannel(std::string_view bytes) {
    const fabric::ChannelTask task{1, 1, 100, 50, kArea, {}, true};
    coordinator::PictureAssembly assembly(task);
    forEach<v1::RenderChannelResponse>(bytes, [&](const v1::RenderChannelResponse& message) {
        return message.has_header() ? assembly.takeHeader(message.header())
                                    : assembly.takeChunk(message.chunk());
    });
    if (const auto result = assembly.finish(); result.ok())
        checkPicture(result->image, kArea, true);
}

/// The same of a task that is answered with a JPEG.
void takeCodedChannel(std::string_view bytes) {
    fabric::ChannelTask task{1, 1, 100, 50, kArea, {}, false};
    task.jpegQuality = 80;
    coordinator::PictureAssembly assembly(task);
    forEach<v1::RenderChannelResponse>(bytes, [&](const v1::RenderChannelResponse& message) {
        return message.has_header() ? assembly.takeHeader(message.header())
                                    : assembly.takeChunk(message.chunk());
    });
    const auto result = assembly.finish();
    if (!result.ok())
        return;
    const auto size = wire::jpegSize(result->jpeg);
    if (!size.ok() || size->width != kArea.width || size->height != kArea.height)
        std::abort();
    static_cast<void>(wire::decodeJpeg(result->jpeg));
}

/// The answer to a program of two pictures.
void takeProgram(std::string_view bytes) {
    fabric::ChannelProgram program;
    program.area = kArea;
    program.stages.resize(1);
    program.stages[0].outputs = {{3, kArea, true, ""}, {4, kArea, false, ""}};
    coordinator::ProgramAssembly assembly(program);
    forEach<v1::RunProgramResponse>(bytes, [&](const v1::RunProgramResponse& message) {
        if (message.has_header())
            return assembly.takeHeader(message.header());
        return message.has_statistics() ? assembly.takeStatistics(message.statistics())
                                        : assembly.takeChunk(message.chunk());
    });
    const auto result = assembly.finish();
    if (!result.ok())
        return;
    if (result->pictures.size() != 2)
        std::abort();
    checkPicture(result->pictures[0].image, kArea, true);
    checkPicture(result->pictures[1].image, kArea, false);
}

/// A picture from one renderer to another.
void takeFrame(std::string_view bytes) {
    fabric::Image image;
    std::optional<wire::PictureReader> pixels;
    forEach<v1::PutFrameRequest>(bytes, [&](const v1::PutFrameRequest& message) {
        if (pixels)
            return pixels->take(message.chunk());
        const auto picture = wire::announcedPicture(message.header(), kArea, true);
        if (picture.ok()) {
            image = picture->blank();
            pixels.emplace(image, picture->encoding);
        }
        return picture.status();
    });
    if (pixels && pixels->finish().ok())
        checkPicture(image, kArea, true);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    // It tells of each text that is none.
    static const auto kUsualLog = google::protobuf::SetLogHandler(nullptr);
    static_cast<void>(kUsualLog);
    if (size == 0)
        return 0;
    const std::string_view bytes(reinterpret_cast<const char*>(data) + 1, size - 1);
    switch (data[0] % 7) {
        case 0:
            if (v1::OpenSceneResponse message; parse(bytes, message))
                static_cast<void>(wire::fromMessage(message));
            break;
        case 1:
            if (v1::PickResponse message; parse(bytes, message))
                static_cast<void>(wire::fromMessage(message.point()));
            break;
        case 2:
            if (v1::RegisterRendererRequest message; parse(bytes, message))
                static_cast<void>(wire::fromMessage(message.device()));
            break;
        case 3:
            takeChannel(bytes);
            break;
        case 4:
            takeProgram(bytes);
            break;
        case 5:
            takeFrame(bytes);
            break;
        default:
            takeCodedChannel(bytes);
    }
    return 0;
}
