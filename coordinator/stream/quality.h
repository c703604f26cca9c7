// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <optional>

#include "coordinator/stream/pacer.h"

namespace eyrie::stream {

/// How a moving picture is made: of which share of the sides asked for, and as which JPEG. Its
/// chroma is always halved: whole, it takes a quarter more bytes where nobody sees it.
struct Level {
    double scale = 1;
    int quality = 75;
};

/// Chooses levels so that a frame has the link for about 14 ms, and up to 45 ms where that would
/// cost too much of the picture: worse levels may take longer, and the best whose time is kept is
/// taken. Worse ones at once, better ones one by one and only with room to spare, or the picture
/// would flicker. What a level takes is told from the frames before. Not thread-safe.
class QualityControl {
public:
    QualityControl() = default;

    /// Chooses the level of the next frame, of a view of `pixels`, on a link that carries so much;
    /// absent: not known.
    void adapt(std::optional<double> bytesPerSecond, double pixels, Clock::time_point now);

    /// A frame of a view of `pixels` at the level number `index` took `bytes`.
    void encoded(int index, std::size_t bytes, double pixels);

    int index() const { return index_; }  ///< 0 is the best
    static int levelCount();
    static const Level& level(int index);

private:
    int index_ = 0;
    std::optional<double> bytesPerPixel_;  ///< as the best level would take
    std::optional<Clock::time_point> changedAt_;
};

}  // namespace eyrie::stream
