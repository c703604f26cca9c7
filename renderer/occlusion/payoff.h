// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace eyrie::occlusion {

/// Decides by measurement whether looking for hidden pieces pays.
///
/// While it does, every frame looks. While it does not, one frame in kPause does, so that a view
/// that changes is noticed, at a price too small to see.
class Payoff {
public:
    static constexpr int kPause = 32;  ///< frames from a look that did not pay to the next
    /// What a hidden triangle costs, at least, as a share of what a drawn one does: it is shaded
    /// only when it comes before what hides it. Measured: docs/benchmarks/meshes.md#occlusion.
    static constexpr double kHiddenShare = 0.5;
    /// By how much a look has to pay before frames go on looking.
    static constexpr double kToStart = 1.25;

    /// A frame that looked.
    struct Look {
        double milliseconds = 0;      ///< that looking took
        double drawMilliseconds = 0;  ///< that drawing took
        std::uint64_t drawn = 0;      ///< triangles
        /// Triangles that were left out or, in a frame that drew all, could have been.
        std::uint64_t hidden = 0;
    };

    bool pays() const { return pays_; }
    /// Whether the next frame is to look. Call it once a frame.
    bool isDue();
    void add(const Look& look);

private:
    bool pays_ = false;
    int pause_ = 0;            ///< frames until the next look
    double gain_ = 0;          ///< milliseconds a frame, over the last frames that looked
    double milliseconds_ = 0;  ///< what looking took, over the same
};

}  // namespace eyrie::occlusion
