// SPDX-License-Identifier: Apache-2.0
#include "cli/bench/flights.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <xxhash.h>

#include "cli/text_file.h"
#include "fabric/status.h"
#include "wire/json.h"

namespace eyrie::cli::bench {
namespace {

constexpr double kSeconds = 12;
constexpr int kIntervals = 48;
constexpr double kTurn = 2 * std::numbers::pi;

/// The camera that `at` gives for each of kIntervals + 1 shares of the flight.
template <typename CameraAt>
fabric::Flight sampled(const CameraAt& at) {
    fabric::Flight flight;
    for (int i = 0; i <= kIntervals; ++i) {
        const double share = static_cast<double>(i) / kIntervals;
        flight.keys.push_back({kSeconds * share, at(share)});
    }
    return flight;
}

/// Of data that are flat in some direction, enough to fly along; of a point, a metre.
fabric::Vec3 extent(const fabric::Box& bounds) {
    const double length = glm::length(bounds.size());
    return glm::max(bounds.size(), fabric::Vec3(length > 0 ? 1e-3 * length : 1));
}

bool isJson(const std::string& text) {
    const std::size_t first = text.find_first_not_of(" \t\r\n");
    return first != std::string::npos && text[first] == '{';
}

}  // namespace

fabric::Flight orbit(const fabric::Box& bounds) {
    const double radius = 0.75 * glm::length(extent(bounds));
    const double elevation = kTurn / 12;
    return sampled([&](double share) {
        const double azimuth = kTurn * share;
        fabric::Camera camera;
        camera.target = bounds.centre();
        camera.eye = camera.target + radius * fabric::Vec3(std::cos(azimuth) * std::cos(elevation),
                                                           std::sin(azimuth) * std::cos(elevation),
                                                           std::sin(elevation));
        return camera;
    });
}

fabric::Flight walkthrough(const fabric::Box& bounds) {
    const fabric::Vec3 size = extent(bounds);
    const auto place = [&](double share) {
        return bounds.min + fabric::Vec3(size.x * (0.1 + 0.8 * share),
                                         size.y * (0.5 + 0.3 * std::sin(kTurn * share)),
                                         size.z + 0.02 * size.x);
    };
    return sampled([&](double share) {
        fabric::Camera camera;
        camera.eye = place(share);
        camera.target = place(share + 0.05) - fabric::Vec3(0, 0, 0.03 * size.x);
        return camera;
    });
}

namespace {

using MakeFlight = fabric::Flight (*)(const fabric::Box&);

/// None of another name.
MakeFlight builtIn(std::string_view name) {
    if (name == "orbit")
        return orbit;
    if (name == "walkthrough")
        return walkthrough;
    return name == "worst" ? worst : nullptr;
}

}  // namespace

absl::StatusOr<NamedFlight> NamedFlight::read(std::string name) {
    if (builtIn(name) != nullptr)
        return NamedFlight(std::move(name), "");
    ASSIGN_OR_RETURN(std::string text, readText(name));
    return NamedFlight(std::move(name), std::move(text));
}

std::uint64_t NamedFlight::hash() const { return XXH64(text_.data(), text_.size(), 0); }

absl::StatusOr<fabric::CameraPath> NamedFlight::over(const fabric::Box& bounds) const {
    if (const auto made = builtIn(name_))
        return fabric::CameraPath{made(bounds), ""};
    if (isJson(text_)) {
        ASSIGN_OR_RETURN(fabric::Flight flight, wire::flightFromJson(text_, name_));
        return fabric::CameraPath{std::move(flight), ""};
    }
    auto path = fabric::cameraPathFromText(text_, bounds, fabric::Camera{}.fovYDegrees);
    if (!path.ok())
        return fabric::withContext(
            path.status(),
            name_ + ": neither a flight as JSON, {\"keys\":[...]}, nor a camera path");
    return path;
}

absl::StatusOr<std::vector<fabric::FlightKey>> framesOf(const fabric::Flight& flight, int count) {
    std::vector<fabric::FlightKey> frames;
    for (int i = 0; i < count; ++i) {
        const double seconds = count == 1 ? 0 : flight.seconds() * i / (count - 1);
        frames.push_back({seconds, flight.at(seconds)});
        if (const absl::Status status = fabric::validate(frames.back().camera); !status.ok()) {
            const auto next =
                std::ranges::upper_bound(flight.keys, flight.keys.front().seconds + seconds, {},
                                         &fabric::FlightKey::seconds);
            const auto key = next - flight.keys.begin();
            return fabric::withContext(
                status, fmt::format("second {:.3f} of the flight, between keys[{}] and keys[{}]",
                                    seconds, key - 1, key));
        }
    }
    return frames;
}

}  // namespace eyrie::cli::bench
