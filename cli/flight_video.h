// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stop_token>
#include <string>

#include <absl/status/status.h>

#include "cli/bench/flights.h"
#include "cli/picture_source.h"
#include "coordinator/frame/frame_source.h"

namespace eyrie::cli {

struct FlightVideo {
    bench::NamedFlight flight;
    int framesPerSecond = 30;
    std::string out;  ///< .mp4, .mkv (H.264) or .webm (VP9)
    bool quiet = false;
};

/// Whether `path` ends as videos do.
bool isVideoName(const std::string& path);

/// Draws the flight in full, picture by picture, as `request` says but for the camera, and puts the
/// pictures into a file that appears under its name only when it is complete. The module for video
/// is asked before anything is drawn. Errors: those of video::load, video::Module::makeMovie,
/// bench::NamedFlight::over, bench::framesOf, PictureSource::draw and mesh::OutputFile; Cancelled.
absl::Status writeFlightVideo(const FlightVideo& video, const std::string& scene,
                              const PictureSourceOptions& pictures,
                              const coordinator::FrameRequest& request,
                              const std::stop_token& stop);

}  // namespace eyrie::cli
