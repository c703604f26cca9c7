// SPDX-License-Identifier: Apache-2.0
#include "cli/values.h"

#include <charconv>
#include <limits>
#include <optional>

#include <fmt/format.h>

#include "fabric/channel_task.h"
#include "fabric/status.h"

namespace eyrie::cli {
namespace {

absl::Status wrong(std::string_view option, std::string_view found, std::string_view expected) {
    return absl::InvalidArgumentError(
        fmt::format("{} is '{}'; expected {}", option, found, expected));
}

/// All of `text` as a number from `min` to `max`.
template <typename T>
std::optional<T> number(std::string_view text, T min, T max) {
    T value{};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() || value < min || value > max)
        return std::nullopt;
    return value;
}

}  // namespace

absl::StatusOr<HostPort> parseHostPort(std::string_view text, std::string_view option) {
    constexpr std::string_view kExpected = "HOST:PORT, such as 127.0.0.1:8080";
    const std::size_t colon = text.rfind(':');
    if (colon == std::string_view::npos)
        return wrong(option, text, kExpected);
    const auto port = number<std::uint16_t>(text.substr(colon + 1), 0, 65535);
    std::string_view host = text.substr(0, colon);
    if (host.size() >= 2 && host.front() == '[' && host.back() == ']')
        host = host.substr(1, host.size() - 2);
    else if (host.find(':') != std::string_view::npos)
        return wrong(option, text, "an IPv6 address in brackets, such as [::1]:8080");
    if (!port)
        return wrong(option, text, kExpected);
    return HostPort{host.empty() ? "0.0.0.0" : std::string(host), *port};
}

absl::StatusOr<PictureSize> parsePictureSize(std::string_view text, std::string_view option) {
    const std::size_t cross = text.find('x');
    if (cross != std::string_view::npos) {
        const auto width = number<int>(text.substr(0, cross), 1, fabric::kMaxViewPixels);
        const auto height = number<int>(text.substr(cross + 1), 1, fabric::kMaxViewPixels);
        if (width && height)
            return PictureSize{*width, *height};
    }
    return wrong(
        option, text,
        fmt::format("WIDTHxHEIGHT, each from 1 to {}, such as 1280x720", fabric::kMaxViewPixels));
}

absl::StatusOr<PixelPlace> parsePixel(std::string_view text, const PictureSize& size,
                                      std::string_view option) {
    const std::size_t comma = text.find(',');
    if (comma != std::string_view::npos) {
        const auto x = number<int>(text.substr(0, comma), 0, size.width - 1);
        const auto y = number<int>(text.substr(comma + 1), 0, size.height - 1);
        if (x && y)
            return PixelPlace{*x, *y};
    }
    return wrong(
        option, text,
        fmt::format("X,Y, a pixel of the picture: 0,0 to {},{}", size.width - 1, size.height - 1));
}

absl::StatusOr<ShardNumber> parseShard(std::string_view text, std::uint32_t most,
                                       std::string_view option) {
    const std::size_t slash = text.find('/');
    if (slash != std::string_view::npos) {
        const auto count = number<std::uint32_t>(text.substr(slash + 1), 1, most);
        const auto index = number<std::uint32_t>(text.substr(0, slash), 0, count.value_or(1) - 1);
        if (count && index)
            return ShardNumber{*index, *count};
    }
    return wrong(option, text,
                 fmt::format("I/N, N from 1 to {} and I from 0 to N-1, such as 0/4 to 3/4", most));
}

absl::StatusOr<std::uint64_t> parseBytes(std::string_view text, std::string_view option) {
    constexpr std::string_view kUnits = "KMGT";
    std::string_view digits = text;
    unsigned shift = 0;
    if (!text.empty())
        if (const std::size_t unit = kUnits.find(text.back()); unit != std::string_view::npos) {
            digits.remove_suffix(1);
            shift = 10 * (static_cast<unsigned>(unit) + 1);
        }
    const auto count =
        number<std::uint64_t>(digits, 1, std::numeric_limits<std::uint64_t>::max() >> shift);
    if (!count)
        return wrong(option, text, "a count of bytes, such as 1500000000 or 2G");
    return *count << shift;
}

}  // namespace eyrie::cli
