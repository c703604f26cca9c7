// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "fabric/image.h"

namespace eyrie::truth {

/// The mean over all pixels of LDR-FLIP, 0 (no difference is seen) to 1: P. Andersson, J. Nilsson,
/// T. Akenine-Moeller, M. Oskarsson, K. Astroem, M. Fairchild, "FLIP: A Difference Evaluator for
/// Alternating Images", 2020; 67 pixels a degree, as on a 0.7 m wide 4K screen at 0.7 m. Of two
/// pictures of the same size. Uses all cores.
double meanFlip(const fabric::Image& reference, const fabric::Image& test);

}  // namespace eyrie::truth
