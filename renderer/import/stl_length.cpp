// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/stl_length.h"

#include <algorithm>
#include <cstdint>
#include <cstring>

#include <fmt/format.h>

namespace eyrie::import {

std::optional<std::string> wrongLengthOfStl(std::span<const std::byte> file) {
    constexpr std::size_t kCountAt = 80, kTrianglesAt = 84, kTriangleBytes = 50;
    if (file.size() < kTrianglesAt)
        return std::nullopt;
    if (std::ranges::count(file.first(kTrianglesAt), std::byte{0}) == 0)
        return std::nullopt;  // text has no such bytes, and a header or a count hardly has none
    std::uint32_t count = 0;
    std::memcpy(&count, file.data() + kCountAt, sizeof count);
    const std::uint64_t bytes = kTrianglesAt + std::uint64_t{count} * kTriangleBytes;
    if (bytes == file.size())
        return std::nullopt;
    return fmt::format("its header counts {} triangles, which take {} bytes, and it has {}; {}",
                       count, bytes, file.size(),
                       bytes > file.size() ? "it is cut off or damaged: copy or export it again"
                                           : "there is more in it than it counts: export it again");
}

}  // namespace eyrie::import
