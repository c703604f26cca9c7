// SPDX-License-Identifier: Apache-2.0
// Scenes, cameras, flights and looks as JSON of any bytes: values that hold what they promise, or a
// message.
#include <cstdint>
#include <string_view>

#include "eyrie/v1/scene.pb.h"
#include "wire/json.h"
#include "wire/scene.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace eyrie;
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    if (const auto scene = wire::sceneMessageFromJson(text, "fuzzed"); scene.ok())
        static_cast<void>(wire::fromMessage(*scene));
    static_cast<void>(wire::cameraFromJson(text, "fuzzed"));
    static_cast<void>(wire::flightFromJson(text, "fuzzed"));
    static_cast<void>(wire::lookFromJson(text, "fuzzed"));
    return 0;
}
