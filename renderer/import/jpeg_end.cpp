// SPDX-License-Identifier: Apache-2.0
// ITU-T T.81, B.1.1: what is coded has a zero or a restart behind each byte of ones, so that other
// markers are found by their two bytes.
#include "renderer/import/jpeg_end.h"

#include <algorithm>
#include <iterator>

namespace eyrie::import {
namespace {

constexpr std::string_view kStart = "\xFF\xD8\xFF", kScan = "\xFF\xDA", kEnd = "\xFF\xD9",
                           kRestarts = "\xFF\xDD";

std::string_view textOf(std::span<const std::byte> bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

}  // namespace

bool lacksJpegEnd(std::span<const std::byte> bytes) {
    const std::string_view text = textOf(bytes);
    if (!text.starts_with(kStart))
        return false;
    const std::size_t scan = text.rfind(kScan);
    return scan == std::string_view::npos || text.find(kEnd, scan) == std::string_view::npos;
}

bool isOneJpegScan(std::span<const std::byte> bytes) {
    const std::string_view text = textOf(bytes);
    return text.find(kScan) == text.rfind(kScan) && text.find(kRestarts) == std::string_view::npos;
}

std::vector<std::byte> withJpegEnd(std::span<const std::byte> bytes, std::string_view between) {
    std::vector<std::byte> whole(bytes.begin(), bytes.end());
    for (const std::string_view more : {between, kEnd})
        std::ranges::copy(std::as_bytes(std::span(more)), std::back_inserter(whole));
    return whole;
}

}  // namespace eyrie::import
