// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace eyrie::terrain {

/// Where a page lies in the file.
struct PageRecord {
    std::uint64_t offset = 0;
    std::uint64_t bytes = 0;     ///< 0: there is nothing in it
    std::uint64_t checksum = 0;  ///< XXH64 of the bytes

    bool operator==(const PageRecord&) const = default;
};

}  // namespace eyrie::terrain
