// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace eyrie::bench {

/// What a decomposition's pictures are to equal.
enum class Meaning {
    OneChannel,   ///< the picture of one channel, colour and depth
    EveryFourth,  ///< of each 2 x 2 pixels one is of each of four pictures of a quarter of them
    MeanOfFour,   ///< the mean of four pictures at the jitter's places
    TwiceAsFine,  ///< each pixel the mean of four
    HalfAsFine,   ///< each pixel shown by four
};

/// A way to cut frames for four renderers.
struct Way {
    std::string name;  ///< of the layout that shows it
    Meaning meaning = Meaning::OneChannel;
    bool isStereo = false;
    std::string compounds;  ///< children of its destination's, which takes frames f0 to f3
};

/// One of every kind that compounds have, and of what they are combined to.
std::vector<Way> allWays();

/// A configuration of four pipes whose one canvas shows each of `ways` in a layout of its name, of
/// `width` x `height` pixels.
std::string configurationOf(const std::vector<Way>& ways, int width, int height);

}  // namespace eyrie::bench
