// SPDX-License-Identifier: Apache-2.0
#include "wire/shading.h"

#include <fmt/format.h>

namespace eyrie::wire {

v1::Shading toMessage(fabric::Shading shading) {
    switch (shading) {
        case fabric::Shading::Smooth:
            return v1::SHADING_SMOOTH;
        case fabric::Shading::Gouraud:
            return v1::SHADING_GOURAUD;
        case fabric::Shading::Flat:
            return v1::SHADING_FLAT;
        case fabric::Shading::Wireframe:
            return v1::SHADING_WIREFRAME;
    }
    return v1::SHADING_UNSPECIFIED;
}

absl::StatusOr<fabric::Shading> shadingFrom(v1::Shading shading, std::string_view field) {
    switch (shading) {
        case v1::SHADING_UNSPECIFIED:
        case v1::SHADING_SMOOTH:
            return fabric::Shading::Smooth;
        case v1::SHADING_GOURAUD:
            return fabric::Shading::Gouraud;
        case v1::SHADING_FLAT:
            return fabric::Shading::Flat;
        case v1::SHADING_WIREFRAME:
            return fabric::Shading::Wireframe;
        default:
            return absl::InvalidArgumentError(fmt::format(
                "{} is {}, which this version does not know", field, static_cast<int>(shading)));
    }
}

}  // namespace eyrie::wire
