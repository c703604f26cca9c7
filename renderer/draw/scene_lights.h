// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "fabric/lights.h"
#include "renderer/draw/open_object.h"

namespace eyrie::draw {

/// What a frame is lit by: the scene's lights or, where it has none, those that the files of the
/// objects it shows bring along, of which the brightest in their middle.
fabric::Lights lightsOf(const fabric::Scene& scene, std::span<const OpenObject> objects,
                        const fabric::Look& look);

}  // namespace eyrie::draw
