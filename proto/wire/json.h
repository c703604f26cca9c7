// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include <absl/status/statusor.h>

#include "fabric/camera.h"
#include "fabric/flight.h"
#include "fabric/look.h"
#include "fabric/statistics.h"

namespace google::protobuf {
class Message;
}
namespace eyrie::v1 {
class Scene;
}

/// Files and answers as protobuf JSON. `name` is the file's, used in messages only.
/// Errors: InvalidArgument, naming the file and what is wrong in it; a field that the message does
/// not have is an error, so that a misspelt option is not silently ignored.
namespace eyrie::wire {

/// A scene file. Still a message: its paths may be relative or name files to import first.
absl::StatusOr<v1::Scene> sceneMessageFromJson(std::string_view text, std::string_view name);

/// A camera file: {"eye":[x,y,z],"target":[x,y,z],"up":[0,0,1],"fovyDegrees":45}.
absl::StatusOr<fabric::Camera> cameraFromJson(std::string_view text, std::string_view name);

/// A flight file: {"keys":[{"seconds":0,"camera":{...}},...]}.
absl::StatusOr<fabric::Flight> flightFromJson(std::string_view text, std::string_view name);

/// A look file: {"exaggeration":2,"contours":{"intervalMetres":100}}.
absl::StatusOr<fabric::Look> lookFromJson(std::string_view text, std::string_view name);

/// Indented protobuf JSON. 64-bit integers become strings and infinity "Infinity", as protobuf has
/// it.
std::string toJson(const google::protobuf::Message& message);

/// What `eyrie render --stats` writes: one object of plain JSON numbers, counts included. A
/// tauAchieved without bound is "Infinity", as toJson has it.
std::string statisticsJson(const fabric::FrameStatistics& statistics, int width, int height,
                           const fabric::DeviceInfo& device);

}  // namespace eyrie::wire
