// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "fabric/shading.h"
#include "fabric/vec.h"

namespace eyrie::fabric {

/// How one object of a scene is shown.
struct ObjectLook {
    std::int32_t object = 0;  ///< its position in Scene::objects
    /// As displayed, 0 to 1: in place of all colours, textures and opacities of its data.
    std::optional<Vec3> colour = {};
    std::optional<Shading> shading = {};  ///< in place of the picture's

    bool operator==(const ObjectLook&) const = default;
};

/// Those of a scene. Those of objects that it does not have count for nothing.
struct ObjectLooks {
    std::vector<ObjectLook> looks;  ///< ascending by object, none twice

    /// Null: it is shown as the whole picture is.
    const ObjectLook* of(std::size_t object) const;

    /// Of an object in a picture that has `whole`.
    Shading shadingOf(std::size_t object, Shading whole) const;

    bool operator==(const ObjectLooks&) const = default;
};

inline constexpr int kMaxObjectLooks = 1000;

}  // namespace eyrie::fabric
