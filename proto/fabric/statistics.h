// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "fabric/frame_budget.h"

namespace eyrie::fabric {

/// Wall-clock milliseconds of the stages of a channel or frame.
struct StageMilliseconds {
    double cull = 0;
    double draw = 0;  ///< until the GPU, or llvmpipe, has finished
    double readback = 0;
    double encode = 0;
    double total = 0;
    /// Of draw, only where a task measures stages: how long the same vertices take without pixels,
    /// and the rest. What of the two goes on at once counts as vertices'.
    double vertices = 0;
    double fill = 0;

    bool operator==(const StageMilliseconds&) const = default;
};

/// What of cull, vertices, fill and readback takes longest; empty where stages were not measured.
inline std::string_view limitingStage(const StageMilliseconds& ms) {
    if (!(ms.vertices + ms.fill > 0))
        return "";
    const std::array<std::pair<double, std::string_view>, 4> stages = {{{ms.cull, "cull"},
                                                                        {ms.vertices, "vertices"},
                                                                        {ms.fill, "fill"},
                                                                        {ms.readback, "readback"}}};
    return std::max_element(stages.begin(), stages.end())->second;
}

/// What a channel (or, summed up, a frame) drew and with what error.
struct FrameStatistics {
    double tauAskedPixels = 0;
    /// Bound on the screen-space error of everything drawn. May exceed what was asked for when the
    /// data end (the finest level is drawn) or are missing.
    double tauAchievedPixels = 0;
    bool complete = true;          ///< false when data that the frame needs are not there (yet)
    bool memoryRaisedTau = false;  ///< above what was asked for, of some of what is drawn
    std::uint64_t triangles = 0;
    std::uint64_t points = 0;
    std::uint64_t nodes = 0;        ///< LOD nodes drawn
    std::uint64_t nodesHidden = 0;  ///< left out because others hide them
    std::uint64_t pagesLoaded = 0;
    std::uint64_t bytesLoaded = 0;        ///< of these, as stored
    std::uint64_t pagesMissing = 0;       ///< coarser data stand in for them
    std::uint64_t pagesFailed = 0;        ///< those of the missing that could not be read
    std::uint64_t tilesDecodedOnGpu = 0;  ///< of terrain, in place of the CPU
    /// Of meshes: bound on the angle between the normals of what is drawn, as blended from
    /// vertices', and the source's within the error there; and on its mean over any node that is
    /// drawn.
    double normalErrorDegrees = 0;
    double normalErrorMeanDegrees = 0;
    StageMilliseconds milliseconds;
    std::optional<BudgetUse> budget = {};  ///< where a frame had one to keep

    bool operator==(const FrameStatistics&) const = default;
};

/// Adds what another channel of the same frame did. Times take the maximum (channels run side by
/// side), counts add up, errors are the worst.
inline void accumulate(FrameStatistics& sum, const FrameStatistics& part) {
    sum.tauAskedPixels = std::max(sum.tauAskedPixels, part.tauAskedPixels);
    sum.tauAchievedPixels = std::max(sum.tauAchievedPixels, part.tauAchievedPixels);
    sum.complete = sum.complete && part.complete;
    sum.memoryRaisedTau = sum.memoryRaisedTau || part.memoryRaisedTau;
    sum.triangles += part.triangles;
    sum.points += part.points;
    sum.nodes += part.nodes;
    sum.nodesHidden += part.nodesHidden;
    sum.pagesLoaded += part.pagesLoaded;
    sum.bytesLoaded += part.bytesLoaded;
    sum.pagesMissing += part.pagesMissing;
    sum.pagesFailed += part.pagesFailed;
    sum.tilesDecodedOnGpu += part.tilesDecodedOnGpu;
    sum.normalErrorDegrees = std::max(sum.normalErrorDegrees, part.normalErrorDegrees);
    sum.normalErrorMeanDegrees = std::max(sum.normalErrorMeanDegrees, part.normalErrorMeanDegrees);
    StageMilliseconds& ms = sum.milliseconds;
    ms.cull = std::max(ms.cull, part.milliseconds.cull);
    ms.draw = std::max(ms.draw, part.milliseconds.draw);
    ms.readback = std::max(ms.readback, part.milliseconds.readback);
    ms.encode = std::max(ms.encode, part.milliseconds.encode);
    ms.total = std::max(ms.total, part.milliseconds.total);
    ms.vertices = std::max(ms.vertices, part.milliseconds.vertices);
    ms.fill = std::max(ms.fill, part.milliseconds.fill);
    // All channels foresee the same, of the whole view.
    if (part.budget &&
        (!sum.budget || sum.budget->predictedMilliseconds < part.budget->predictedMilliseconds))
        sum.budget = part.budget;
}

/// The graphics device a renderer chose.
struct DeviceInfo {
    std::string vendor;     ///< GL_VENDOR
    std::string renderer;   ///< GL_RENDERER
    std::string driver;     ///< GL_VERSION
    std::string platform;   ///< "EGL device 0", "EGL surfaceless Mesa"
    bool software = false;  ///< a CPU rasteriser such as llvmpipe

    bool operator==(const DeviceInfo&) const = default;
};

}  // namespace eyrie::fabric
