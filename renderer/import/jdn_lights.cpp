// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/jdn_lights.h"

#include <array>
#include <limits>
#include <span>

#include <fmt/format.h>

#include "renderer/import/jdn_text.h"

namespace eyrie::import {
namespace {

constexpr std::int64_t kDistant = 1;
constexpr std::int64_t kPoint = 2;

/// Not a number where it cannot be read.
double numberIn(std::string_view value) {
    double number = 0;
    return parseNumbers(value, std::span(&number, 1)) ? number
                                                      : std::numeric_limits<double>::quiet_NaN();
}

fabric::Vec3 vectorIn(std::string_view value) {
    std::array<double, 3> xyz{};
    return parseNumbers(value, std::span<double>(xyz))
               ? fabric::Vec3(xyz[0], xyz[1], xyz[2])
               : fabric::Vec3(std::numeric_limits<double>::quiet_NaN());
}

}  // namespace

bool JdnLights::take(std::string_view key, std::string_view value) {
    if (key == "Pos")
        lights_.push_back({.place = vectorIn(value)});
    else if (lights_.empty())
        return false;
    else if (key == "Direction")
        lights_.back().direction = vectorIn(value);
    else if (key == "Colour")
        lights_.back().colour = vectorIn(value);
    else if (key == "Intensity")
        lights_.back().intensity = numberIn(value);
    else if (key == "Type")
        lights_.back().type =
            parseNumbers(value, std::span(&lights_.back().type, 1)) ? lights_.back().type : 0;
    else
        return false;
    return true;
}

fabric::FileLights JdnLights::lights(std::uint64_t expected,
                                     std::vector<std::string>& notes) const {
    if (lights_.size() != expected)
        notes.push_back(fmt::format("found {} lights, expected {}", lights_.size(), expected));
    std::vector<SourceLight> sources;
    std::size_t unknown = 0;
    for (const Light& light : lights_) {
        SourceLight source{.place = light.place, .colour = light.colour * light.intensity};
        if (light.type == kDistant) {
            source.kind = SourceLight::Kind::Distant;
            source.place = light.direction == fabric::Vec3(0) ? -light.place : light.direction;
        }
        unknown += light.type != kDistant && light.type != kPoint ? 1 : 0;
        sources.push_back(source);
    }
    if (unknown > 0)
        notes.push_back(fmt::format(
            "{} of {} lights have a type that is neither 1 nor 2: they shine all around", unknown,
            lights_.size()));
    return lightsFrom(sources, notes);
}

}  // namespace eyrie::import
