// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include <absl/status/statusor.h>

/// Values as the command line spells them. InvalidArgument names the option, what was found and
/// what is expected.
namespace eyrie::cli {

struct HostPort {
    std::string host;
    std::uint16_t port = 0;

    bool operator==(const HostPort&) const = default;
};

/// "HOST:PORT", "[IPv6]:PORT" or ":PORT" (all addresses of this machine). Port 0 is allowed.
absl::StatusOr<HostPort> parseHostPort(std::string_view text, std::string_view option);

struct PictureSize {
    int width = 0;
    int height = 0;

    bool operator==(const PictureSize&) const = default;
};

/// "WIDTHxHEIGHT", each from 1 to fabric::kMaxViewPixels.
absl::StatusOr<PictureSize> parsePictureSize(std::string_view text, std::string_view option);

struct PixelPlace {
    int x = 0;
    int y = 0;

    bool operator==(const PixelPlace&) const = default;
};

/// "X,Y", a pixel of a picture of that size: from 0,0 on.
absl::StatusOr<PixelPlace> parsePixel(std::string_view text, const PictureSize& size,
                                      std::string_view option);

struct ShardNumber {
    std::uint32_t index = 0;
    std::uint32_t count = 1;

    bool operator==(const ShardNumber&) const = default;
};

/// "I/N", N from 1 to `most`, I from 0 to N - 1.
absl::StatusOr<ShardNumber> parseShard(std::string_view text, std::uint32_t most,
                                       std::string_view option);

/// A count of bytes: digits, or digits with K, M, G or T (powers of 1024). More than 0.
absl::StatusOr<std::uint64_t> parseBytes(std::string_view text, std::string_view option);

}  // namespace eyrie::cli
