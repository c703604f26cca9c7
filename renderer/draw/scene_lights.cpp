// SPDX-License-Identifier: Apache-2.0
#include "renderer/draw/scene_lights.h"

#include <cstddef>

#include "fabric/box.h"

namespace eyrie::draw {

fabric::Lights lightsOf(const fabric::Scene& scene, std::span<const OpenObject> objects,
                        const fabric::Look& look) {
    fabric::FileLights ofFiles;
    fabric::Box shown;
    for (std::size_t i = 0; i < objects.size(); ++i) {
        if (look.hidden.contains(i))
            continue;
        const auto& [object, drawable] = objects[i];
        fabric::append(ofFiles, drawable->lights(), object.worldFromObject);
        shown.grow(fabric::transformed(drawable->bounds(), object.worldFromObject));
    }
    fabric::keepBrightest(ofFiles, shown.centre());
    return fabric::lightsOf(scene, ofFiles, look);
}

}  // namespace eyrie::draw
