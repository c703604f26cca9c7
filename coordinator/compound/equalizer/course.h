// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <optional>

namespace eyrie::equalizer {

/// Where a place is going that is looked up frame after frame.
///
/// Times tell of frames that are over, and of some of them only when several have told the same: a
/// cut that goes to where the load was is always late where the load moves. A place that went the
/// same way in each of the last frames is taken to go on so, in each frame as far as in the slowest
/// of those: what comes to rest is carried on less and less, what noise shakes turns and is not.
class Course {
public:
    /// How far it has gone on, 0 as a rule, when the frame that is planned now is drawn. `place`, a
    /// share of the whole, is where it is by all that is known now; once for each frame.
    double ahead(double place);

private:
    static constexpr std::size_t kFrames = 4;

    std::optional<double> last_;
    std::array<double, kFrames> steps_{};  ///< of the last frames
    std::size_t next_ = 0;                 ///< of these, to be replaced
};

}  // namespace eyrie::equalizer
