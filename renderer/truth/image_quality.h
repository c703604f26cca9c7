// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "fabric/image.h"

/// How far the colours of a picture are from another's of the same size.
namespace eyrie::truth {

/// Peak signal-to-noise ratio in decibels over red, green and blue; infinite of equal pictures.
double psnrDb(const fabric::Image& a, const fabric::Image& b);

/// Mean structural similarity of the luma, 1 of equal pictures: Z. Wang, A. Bovik, H. Sheikh,
/// E. Simoncelli, "Image Quality Assessment: From Error Visibility to Structural Similarity", 2004;
/// Gaussian windows of 11 x 11 pixels, sigma 1.5, wholly inside the picture, which is not reduced
/// before. Pictures smaller than a window are one.
double ssim(const fabric::Image& a, const fabric::Image& b);

}  // namespace eyrie::truth
