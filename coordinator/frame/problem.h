// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>

#include "fabric/box.h"

namespace eyrie::coordinator {

/// What decides whether there is a picture.
struct Situation {
    int ready = 0;    ///< renderers that have the scene open
    int opening = 0;  ///< renderers that are opening it
    bool sceneIsEmpty = false;
    std::string openError;  ///< of a renderer that could not open it
    std::string howToJoin;  ///< the command that starts a renderer; empty: they are started here
};

/// Why there is no picture, for a person to read, with what to do; empty while there is one.
std::string problemOf(const Situation& situation);

/// What is missing though there is a picture, for a person to read: renderers that are ready, of
/// those that a configuration has pipes for; empty where nothing is.
std::string noteOf(std::size_t ready, std::size_t wanted);

/// Of a scene so small that the near plane (fabric::kNearMetres) takes away of it where the eye
/// sees it whole; empty of others, and of an empty one.
std::string noteOfSize(const fabric::Box& bounds);

}  // namespace eyrie::coordinator
