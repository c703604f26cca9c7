// SPDX-License-Identifier: Apache-2.0
#include "fabric/object_look.h"

#include <algorithm>

namespace eyrie::fabric {

const ObjectLook* ObjectLooks::of(std::size_t object) const {
    const auto position = static_cast<std::int64_t>(object);
    const auto found = std::ranges::lower_bound(
        looks, position, {}, [](const ObjectLook& one) { return std::int64_t{one.object}; });
    return found != looks.end() && found->object == position ? &*found : nullptr;
}

Shading ObjectLooks::shadingOf(std::size_t object, Shading whole) const {
    const ObjectLook* look = of(object);
    return look == nullptr ? whole : look->shading.value_or(whole);
}

}  // namespace eyrie::fabric
