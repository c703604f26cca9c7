// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "coordinator/compound/equalizer/load_map.h"

namespace eyrie::equalizer {

/// Why the parts of a picture, or of a range of the data, take as long as they do: where the load
/// lies and, where that does not explain it, how slow each child is.
///
/// The time of a part tells neither. Two explanations learn from the same frames: one puts all down
/// to the place (a LoadMap), the other most of each surprise down to the child that drew and the
/// rest to the place. Among equal renderers the first foretells the next frame better, noise
/// included, and is believed; where a renderer is far slower than others, cuts made by it move load
/// away and find less of it there, again and again, and the second is believed for as long as it
/// foretells better (docs/decisions/0040). Which does is told by frames whose parts are new: either
/// foretells well what the same parts take again.
class LoadModel {
public:
    /// Even load in cells (LoadMap), children that are equally quick.
    LoadModel(int columns, int rows, std::size_t children);

    struct Measured {
        std::size_t child = 0;
        Area part;                ///< within [0, 1] x [0, 1]
        Area region;              ///< of the part that was covered
        double milliseconds = 0;  ///< finite, above 0
    };
    /// `parts` cover the whole once, but for what cost nothing. Where they stay as they were though
    /// they are not balanced, the best that places know of is not good enough.
    void record(std::span<const Measured> parts, bool areBalanced);

    const LoadMap& map() const { return believed().map; }

    /// What `child` takes for each millisecond of load on the map; above 0.
    double slowness(std::size_t child) const { return believed().slowness[child]; }

private:
    struct Explanation {
        LoadMap map;
        std::vector<double> slowness;  ///< by child
        double wrong = 0;  ///< of new parts' times of late, what share was foretold elsewhere
    };
    static void learn(std::span<const Measured> parts, double ofChildren, bool areNew,
                      Explanation& explanation);
    const Explanation& believed() const { return believesChildren_ ? children_ : places_; }

    Explanation places_;
    Explanation children_;
    bool believesChildren_ = false;
    std::vector<Area> parts_;  ///< of the last frame
};

}  // namespace eyrie::equalizer
