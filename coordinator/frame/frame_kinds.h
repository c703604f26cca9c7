// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <list>

#include "coordinator/frame/frame_source.h"

namespace eyrie::coordinator {

/// Numbers for frames that differ in nothing but the camera and how they are encoded: those take
/// about as long. The latest few are remembered.
class FrameKinds {
public:
    /// `revision` is that of the scene.
    std::uint64_t of(const FrameRequest& request, std::uint64_t revision);

private:
    static constexpr std::size_t kRemembered = 8;

    struct Kind {
        FrameRequest request;  ///< but for those
        std::uint64_t revision;
        std::uint64_t number;
    };
    std::list<Kind> kinds_;  ///< the one asked for last comes first
    std::uint64_t last_ = 0;
};

}  // namespace eyrie::coordinator
