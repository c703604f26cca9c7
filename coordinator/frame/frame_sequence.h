// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <optional>

#include <absl/status/statusor.h>

#include "coordinator/frame/frame_source.h"

namespace eyrie::coordinator {

/// Frames of known views, one after another: a flight's, or the bands of a poster.
struct FrameSequence {
    using Clock = std::chrono::steady_clock;

    struct Frame {
        std::size_t index = 0;      ///< 0 the first
        Clock::time_point begun;    ///< when its view was asked for, after its turn had come
        Clock::time_point arrived;  ///< in the order of the frames
        absl::StatusOr<RenderedFrame> drawn;
    };

    /// How a frame is drawn: FrameSource::renderLatest. Called from `atOnce` threads; from the
    /// caller's alone where that is 1.
    std::function<absl::StatusOr<RenderedFrame>(const FrameSource::ChooseFrame&)> draw;
    int atOnce = 1;  ///< frames that are asked for at the same time
    /// The view of each frame; nothing: there are no more. One call at a time.
    std::function<std::optional<FrameRequest>(std::size_t index)> view;
    /// Gets every frame, in order, one call at a time; an error ends the sequence.
    std::function<absl::Status(Frame frame)> take;
};

/// Draws all frames of `sequence`: as many pictures are held as are asked for at the same time.
/// Returns the first error of `take`.
absl::Status drawSequence(const FrameSequence& sequence);

}  // namespace eyrie::coordinator
