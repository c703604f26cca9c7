// SPDX-License-Identifier: Apache-2.0
// What browsers and coordinators send, of any bytes: values that hold what they promise,
// or a message. The first byte says which of them it is.
#include <cstdint>
#include <span>
#include <string_view>

#include "coordinator/stream/sessions.h"
#include "coordinator/stream/viewer_messages.h"
#include "eyrie/v1/render_service.pb.h"
#include "wire/channel_program.h"
#include "wire/frame.h"
#include "wire/pick.h"
#include "wire/scene.h"

namespace {

using namespace eyrie;

template <typename Message, typename Read>
void parse(const std::uint8_t* data, std::size_t size, const Read& read) {
    Message message;
    if (message.ParseFromArray(data, static_cast<int>(size)))
        static_cast<void>(read(message));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size == 0)
        return 0;
    const std::uint8_t kind = *data++;
    --size;
    switch (kind % 7) {
        case 0:
            static_cast<void>(stream::parseRequest(std::as_bytes(std::span(data, size))));
            break;
        case 1:
            parse<v1::OpenSceneRequest>(
                data, size, [](const auto& message) { return wire::fromMessage(message.scene()); });
            break;
        case 2:
            parse<v1::SetFrameDataRequest>(data, size, [](const auto& message) {
                return wire::fromMessage(message.frame_data());
            });
            break;
        case 3:
            parse<v1::RenderChannelRequest>(
                data, size, [](const auto& message) { return wire::fromMessage(message.task()); });
            break;
        case 4:
            parse<v1::RunProgramRequest>(data, size, [](const auto& message) {
                return wire::fromMessage(message.program());
            });
            break;
        case 5:
            parse<v1::PickRequest>(data, size,
                                   [](const auto& message) { return wire::fromMessage(message); });
            break;
        default:  // the address of a viewer's stream
            static_cast<void>(stream::joiningOf({reinterpret_cast<const char*>(data), size}));
    }
    return 0;
}
