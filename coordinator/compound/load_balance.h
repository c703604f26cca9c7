// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

namespace eyrie::coordinator {

/// Chooses where to cut the next frame so that its channels take equally long, from how long the
/// last frame's took: the load equalizer of Equalizer (Eilemann, Makhinya, Pajarola 2009).
///
/// Each channel's time is taken as spread evenly over its share; the cuts go where equal parts of
/// the sum lie, half of the way at a time, since it is not spread evenly. Times within a twentieth
/// of each other are left alone: moving a cut costs, because what lies there has to be loaded by
/// another renderer.
class LoadBalance {
public:
    /// Positions in (0, 1), ascending, that cut a frame into `channels` parts; equal ones when the
    /// number is not that of the frame before. Precondition: channels >= 1.
    const std::vector<double>& cuts(int channels);

    /// The times of the channels of the last cuts, in order. Another number of times (parts that
    /// had no pixels) changes nothing.
    void record(std::span<const double> milliseconds);

    /// Frames of another kind (scene, size) come next.
    void forget() { cuts_.clear(); }

private:
    std::vector<double> cuts_;
};

}  // namespace eyrie::coordinator
