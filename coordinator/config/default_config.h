// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include "coordinator/config/configuration.h"

/// The configuration where none is given, made of the renderers there are.
namespace eyrie::config {

/// What a renderer process says of itself.
struct RendererFacts {
    std::string id;
    std::string host;    ///< or name of the node that it is to be; empty: any
    std::string device;  ///< its name, such as that of a GPU or of a software rasteriser
    int threads = 0;     ///< that draw, where its device is the processor; else 0

    bool operator==(const RendererFacts&) const = default;
};

/// Most renderers that one direct-send layout has: n of them exchange n (n - 1) pictures.
inline constexpr std::size_t kMostDirectSend = 16;

/// A node and a pipe for each renderer, in their order, the first the application's; one canvas of
/// one segment, in the first renderer's channel; no walls, so that what is seen is the camera's
/// own. A layout for each way to share the work, of one view each:
///
/// - 2D: parts of the picture, balanced by load; what is used without a choice
/// - Simple: the first renderer alone
/// - DB static: ranges of the data
/// - DB dynamic: ranges of the data, balanced by load
/// - direct-send: ranges of the data, and each renderer merges a strip of the picture; of 2 to
///   kMostDirectSend renderers
/// - DB-2D: ranges of the data, each for a group that shares the picture; of 4 renderers or more
///
/// Of one renderer there is Simple only, of none nothing at all. Static shares are as the
/// renderers' threads where all draw with theirs, else equal. The picture's parts lie on multiples
/// of 2^-20, so that sums of their sizes are exact.
Configuration defaultConfiguration(std::span<const RendererFacts> renderers);

/// Of its layouts, the first is that used without a choice.
std::vector<std::string> layoutNames(const Configuration& configuration);

}  // namespace eyrie::config
