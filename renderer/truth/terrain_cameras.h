// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <random>
#include <string_view>

#include "fabric/box.h"
#include "fabric/camera.h"
#include "renderer/truth/terrain_ray_caster.h"

namespace eyrie::truth {

/// Makes cameras over one terrain: of one seed always the same ones.
class TerrainCameras {
public:
    enum class Kind {
        Overview,  ///< all of it from afar
        Mid,       ///< a part of it
        Close,     ///< from a tower's to a hill's height above the ground, looking down
        Grazing,   ///< from a rider's to a house's height, along the ground
    };
    static constexpr int kKinds = 4;
    static constexpr std::array<std::string_view, kKinds> kNames = {"overview", "mid", "close",
                                                                    "grazing"};

    /// `bounds` are the terrain's; keeps a reference to `ground`.
    TerrainCameras(const TerrainRayCaster& ground, const fabric::Box& bounds, std::uint32_t seed)
        : ground_(ground), bounds_(bounds), random_(seed) {}

    fabric::Camera make(Kind kind);

private:
    double in(double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(random_);
    }
    fabric::Vec3 groundPoint();
    fabric::Camera around(double distance, double elevation);
    fabric::Camera above(double height, double pitch);

    const TerrainRayCaster& ground_;
    const fabric::Box bounds_;
    std::mt19937 random_;
};

}  // namespace eyrie::truth
