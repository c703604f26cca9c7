// SPDX-License-Identifier: Apache-2.0
#include "fabric/status.h"

#include <fmt/format.h>

namespace eyrie::fabric {

absl::Status withContext(const absl::Status& status, std::string_view context) {
    if (status.ok())
        return status;
    const auto message = status.message();
    return {status.code(),
            fmt::format("{}: {}", context, std::string_view(message.data(), message.size()))};
}

}  // namespace eyrie::fabric
