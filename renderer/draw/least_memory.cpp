// SPDX-License-Identifier: Apache-2.0
#include "renderer/draw/least_memory.h"

#include <string>

#include <fmt/format.h>

namespace eyrie::draw {

absl::Status checkHolds(const MemoryUse& share, const MemoryUse& least, std::string_view path,
                        std::uint64_t textureBytes) {
    const std::string textures =
        textureBytes > 0 ? fmt::format(" beside {} bytes of textures", textureBytes) : "";
    if (share.deviceBytes < least.deviceBytes)
        return absl::ResourceExhaustedError(fmt::format(
            "{}: it needs {} bytes on the device at least{}, and its share of memory there is {}; "
            "raise --memory, or open fewer objects",
            path, least.deviceBytes - textureBytes, textures, share.deviceBytes));
    if (share.hostBytes < least.hostBytes)
        return absl::ResourceExhaustedError(fmt::format(
            "{}: its pages need {} bytes on the host at least, and its share of memory there is "
            "{}; raise --host-memory, or open fewer objects",
            path, least.hostBytes, share.hostBytes));
    return absl::OkStatus();
}

}  // namespace eyrie::draw
