// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace eyrie::fabric {

struct PictureSides {
    int width = 0;
    int height = 0;
};

/// A picture in the shape of one of `width` x `height` pixels and about `scale` times as wide, 0 to
/// 1; each side `least` or more, and no longer than it was. Of the widths up to a sixteenth below,
/// and sixteen pixels, it has that of which whole pixels come clearly nearest to the shape.
PictureSides smallerPicture(int width, int height, double scale, int least = 1);

/// How far a point may lie beside its place, in pixels of a picture of `width` x `height`, where
/// one of sides `drawn`, with the same vertical field of view, is stretched to that. Proof:
/// docs/errors.md#measuring.
double shapeErrorPixels(int width, int height, const PictureSides& drawn);

}  // namespace eyrie::fabric
