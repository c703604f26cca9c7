// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include <absl/status/statusor.h>

namespace eyrie::simulator {

/// What tasks cost, processor milliseconds (milliseconds of one core), and machines give.
struct Costs {
    double taskMs = 0;               ///< any draw task, whatever it draws
    double millionTrianglesMs = 0;   ///< vertices and rasterisation
    double megapixelMs = 0;          ///< shading what is seen, by the pixels of the view's part
    double readbackMegapixelMs = 0;  ///< reading back, packing and sending
    double assembleMegapixelMs = 0;  ///< receiving and pasting
    double mergeMegapixelMs = 0;     ///< receiving and merging by depth
    double threads = 1;              ///< of a draw task
    double overlap = 0;  ///< side of an LOD node, as a share of the picture's: what a cut doubles
    double packed = 1;   ///< bytes sent for each of a picture's, with depth
};

struct Machines {
    int renderersPerHost = 1;
    double cores = 1;                 ///< of each host
    bool isOneMachine = false;        ///< renderers and coordinator all on one host
    double gigabitsPerSecond = 10;    ///< of each host's link, each way
    double latencyMilliseconds = .1;  ///< one way
};

/// "name,value" a line, '#' before a remark. Errors: NotFound, InvalidArgument, with the line or
/// the costs that are missing.
absl::StatusOr<Costs> readCosts(const std::string& path);

/// The triangles of each frame of the measured passes, drawn whole, of the frames.csv that
/// `eyrie bench` writes. Errors: NotFound, InvalidArgument, naming the column that is missing.
absl::StatusOr<std::vector<double>> readTriangles(const std::string& path);

}  // namespace eyrie::simulator
