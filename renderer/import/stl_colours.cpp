// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/stl_colours.h"

#include <cstdint>
#include <cstring>
#include <string_view>

namespace eyrie::import {

std::optional<std::string> stlForAssimp(std::span<const std::byte> file) {
    constexpr std::size_t kCountAt = 80, kTrianglesAt = 84, kTriangleBytes = 50;
    const std::string_view text(reinterpret_cast<const char*>(file.data()), file.size());
    if (text.substr(0, kCountAt).find("COLOR=") == std::string_view::npos ||
        file.size() < kTrianglesAt)
        return std::nullopt;
    std::uint32_t count = 0;
    std::memcpy(&count, file.data() + kCountAt, sizeof count);
    if (file.size() != kTrianglesAt + std::uint64_t{count} * kTriangleBytes)
        return std::nullopt;
    std::string result(text);
    for (std::size_t end = kTrianglesAt + kTriangleBytes; end <= result.size();
         end += kTriangleBytes) {
        const bool isOwn = result[end - 2] != 0 || (result[end - 1] & 0x7F) != 0;
        result[end - 1] = static_cast<char>((result[end - 1] & 0x7F) | (isOwn ? 0x80 : 0));
    }
    return result;
}

}  // namespace eyrie::import
