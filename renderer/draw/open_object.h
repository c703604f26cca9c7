// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "fabric/look.h"
#include "fabric/scene.h"
#include "renderer/draw/drawable.h"

namespace eyrie::draw {

/// An object of the scene that is open.
struct OpenObject {
    fabric::SceneObject object;
    std::unique_ptr<Drawable> drawable;
};

/// A terrain's heights are drawn exaggerated; a mesh is not.
inline fabric::Mat4 drawnWorldFromObject(const fabric::SceneObject& object,
                                         const fabric::Look& look) {
    return object.kind == fabric::ObjectKind::Terrain
               ? fabric::exaggerated(object.worldFromObject, look.exaggeration)
               : object.worldFromObject;
}

}  // namespace eyrie::draw
