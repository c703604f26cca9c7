// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <stop_token>
#include <vector>

#include <absl/status/statusor.h>

#include "cli/bench/frame_error.h"
#include "cli/bench/reference_sources.h"
#include "cli/picture_source.h"
#include "fabric/flight.h"
#include "renderer/page/page_source.h"
#include "renderer/truth/depth_comparison.h"

namespace eyrie::cli::bench {

/// At which colours are drawn that pictures' are compared with, where none of these is finer.
inline constexpr double kFinestTauPixels = 0.125;

struct JudgedFrames {
    int width = 1280;  ///< of the pictures, pixels
    int height = 720;
    int played = 120;  ///< frames of one pass along the flight
    int judged = 6;    ///< of these, one of each equal part; all where there are fewer
    int keptRuns = 0;  ///< runs whose pictures are kept until they are judged
    /// At which colours are drawn that pictures' are compared with: finer, or as fine, as all of
    /// them, so that what is said of one depends on no other.
    double finestTauPixels = kFinestTauPixels;
};

/// Which of a pass's frames are judged, ascending: of each part another place.
std::vector<int> judgedFrames(const JudgedFrames& frames);

/// What FlightJudge takes: of each frame 20 bytes a pixel, which it keeps, and while it judges one
/// another 130, FLIP's planes for the most part; of each picture that a run keeps for it 8 bytes a
/// pixel.
std::uint64_t neededBytes(const JudgedFrames& frames);

/// Holds frames of one flight against the full-resolution source, at any tau. What the source shows
/// is cast once a frame and kept, but of pictures that are smaller than asked for.
class FlightJudge {
public:
    /// `remote`: how the drawn terrain is read again, for pixels of triangles seen edge-on.
    FlightJudge(ReferenceScene reference, const fabric::Flight& flight, const JudgedFrames& frames,
                page::SourceOptions remote);

    /// Draws the frames by `pictures` as `request` says, and measures them; by `finest` colours to
    /// compare with. `frameDone` is called after each. Where memory makes a frame coarser than
    /// asked for, nobody says which triangles it is made of: all of its pixels are judged by their
    /// depths. Errors: those of PictureSource::draw, naming the second; Cancelled.
    absl::StatusOr<MeasuredErrors> judge(PictureSource& pictures, PictureSource& finest,
                                         coordinator::FrameRequest request,
                                         const std::function<void()>& frameDone,
                                         const std::stop_token& stop);

    /// The same of pictures that were shown when the flight was played, Played::kept of the frames
    /// judgedFrames; `request` is for `finest`. Those that show coarser data in place of some that
    /// were not loaded are judged by their depths, too.
    absl::StatusOr<MeasuredErrors> judge(std::vector<coordinator::RenderedFrame> shown,
                                         PictureSource& finest, coordinator::FrameRequest request,
                                         const std::function<void()>& frameDone,
                                         const std::stop_token& stop);

    const ReferenceScene& reference() const { return reference_; }
    std::vector<fabric::Camera> cameras() const;
    double frames() const { return static_cast<double>(frames_.size()); }

private:
    /// What a frame ought to show, at some size.
    struct Expected {
        truth::ReferenceView view;
        fabric::Image finest;
    };
    struct Frame {
        double seconds = 0;
        fabric::Camera camera;
        std::optional<Expected> expected;  ///< at the size asked for, once it was judged
    };
    struct Judged {
        FrameError error;
        fabric::Image picture;
        std::vector<float> displacements;  ///< pixels of the picture
    };
    /// Of a frame: its place among those judged, and what is asked for.
    using Draw = std::function<absl::StatusOr<coordinator::RenderedFrame>(
        std::size_t, const coordinator::FrameRequest&)>;

    absl::StatusOr<MeasuredErrors> judgeAll(const Draw& draw, PictureSource& finest,
                                            coordinator::FrameRequest request,
                                            const std::function<void()>& frameDone,
                                            const std::stop_token& stop);
    absl::StatusOr<Judged> judge(Frame& frame, coordinator::RenderedFrame drawn,
                                 PictureSource& finest,
                                 const coordinator::FrameRequest& request) const;
    Judged judge(const Frame& frame, const Expected& expected, coordinator::RenderedFrame drawn,
                 double tauPixels) const;
    absl::StatusOr<Expected> expect(PictureSource& finest, coordinator::FrameRequest request) const;

    ReferenceScene reference_;
    JudgedFrames how_;
    page::SourceOptions remote_;
    std::vector<Frame> frames_;
};

}  // namespace eyrie::cli::bench
