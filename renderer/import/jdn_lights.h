// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "fabric/lights.h"
#include "renderer/import/source_lights.h"

/// What a .jdn scene (jdn_reader.h) says of lights.
namespace eyrie::import {

/// The lights of a scene, each begun by its place. Those at a place reach everywhere; a distant one
/// without a direction shines from its place to the origin.
class JdnLights {
public:
    /// Takes a line, if `key` is one of a light. Values that cannot be read make it none.
    bool take(std::string_view key, std::string_view value);

    /// All that have been read. `notes` says what was odd (source_lights.h), and where the scene
    /// said another number.
    fabric::FileLights lights(std::uint64_t expected, std::vector<std::string>& notes) const;

private:
    struct Light {
        fabric::Vec3 place{0};
        fabric::Vec3 direction{0};
        fabric::Vec3 colour{1};
        double intensity = 1;
        std::int64_t type = 2;
    };

    std::vector<Light> lights_;
};

}  // namespace eyrie::import
