// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "renderer/gl/fence.h"

namespace eyrie::draw {

/// What a frame hands to the device, batch by batch, and how far the device is with it.
///
/// What is drawn so far is handed over, so that llvmpipe fills pixels on other cores while this
/// thread prepares more triangles: it waits for a frame's end, or megabytes of them, by itself.
class Batches {
public:
    static constexpr std::uint64_t kTriangles = 8192;

    /// An eighth of the triangles is left to draw when awaitMost returns, and at most a batch more.
    /// A task that takes no longer to come than those do is there before the device idles.
    static constexpr std::uint64_t kLeftOf = 8;

    /// A new frame; `isWatched`: awaitMost will be called.
    void begin(bool isWatched);

    /// Triangles were drawn: a batch that they complete is handed over.
    void add(std::uint64_t triangles);

    /// All is drawn: hands over the rest and waits until little of it is left.
    void awaitMost();

private:
    struct Batch {
        std::uint64_t end;  ///< triangles of the frame up to here
        gl::Fence fence;
    };

    bool isWatched_ = false;
    std::uint64_t triangles_ = 0;   ///< of the frame
    std::uint64_t handedOver_ = 0;  ///< of these
    std::vector<Batch> batches_;
};

}  // namespace eyrie::draw
