// SPDX-License-Identifier: Apache-2.0
// Camera paths of older programs, of any bytes: refused, or flights that can be played.
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "fabric/camera_path.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace eyrie::fabric;
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    const auto path = cameraPathFromText(text, {{6, 18, 29}, {14, 22, 31}}, 45);
    if (!path.ok()) {
        if (path.status().code() != absl::StatusCode::kInvalidArgument)
            std::abort();
        return 0;
    }
    const bool isFlight = validate(path->flight).ok() && path->flight.keys.size() <= kMostPathKeys;
    if (!isFlight || path->note.empty())
        std::abort();
    return 0;
}
