// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "renderer/truth/flip.h"
#include "renderer/truth/heat_map.h"
#include "renderer/truth/image_quality.h"
#include "renderer/truth/silhouette.h"

namespace eyrie::truth {
namespace {

using fabric::Image;
using fabric::Rgba;

Image uniform(Rgba colour, int width = 40, int height = 30) {
    return fabric::makeImage({0, 0, width, height}, colour, false);
}

/// Grey stripes of a period of eight pixels, `amplitude` around 128, moved by `shift` pixels.
Image stripes(double amplitude, double shift = 0) {
    Image image = uniform({});
    for (int y = 0; y < 30; ++y)
        for (int x = 0; x < 40; ++x) {
            const auto level = static_cast<std::uint8_t>(
                std::lround(128 + amplitude * std::sin(2 * M_PI * (x - shift) / 8)));
            image.colour[static_cast<std::size_t>(y * 40 + x)] = {level, level, level};
        }
    return image;
}

TEST(Psnr, IsThatOfAKnownMeanSquare) {
    const Image black = uniform({0, 0, 0});
    EXPECT_EQ(psnrDb(black, black), std::numeric_limits<double>::infinity());
    EXPECT_NEAR(psnrDb(black, uniform({255, 255, 255})), 0, 1e-12);
    EXPECT_NEAR(psnrDb(black, uniform({10, 10, 10})), 20 * std::log10(25.5), 1e-12);
    EXPECT_NEAR(psnrDb(black, uniform({30, 0, 0})), 10 * std::log10(65025.0 / 300), 1e-12)
        << "one channel in three";
}

TEST(Ssim, OfEqualPicturesIsOne) { EXPECT_NEAR(ssim(stripes(50), stripes(50)), 1, 1e-12); }

/// Without structure only the term of luminance is left: (2 a b + c1) / (a^2 + b^2 + c1).
TEST(Ssim, OfUniformPicturesIsTheLuminancesTerm) {
    const double c1 = 2.55 * 2.55;
    EXPECT_NEAR(ssim(uniform({100, 100, 100}), uniform({50, 50, 50})),
                (2 * 100 * 50 + c1) / (100 * 100 + 50 * 50 + c1), 1e-9);
    EXPECT_NEAR(ssim(uniform({0, 0, 0}, 3, 2), uniform({200, 200, 200}, 3, 2)),
                c1 / (200 * 200 + c1), 1e-9)
        << "smaller than a window";
}

/// The luma of windows differs, too: it is not -1.
TEST(Ssim, OfTheNegativeOfAPatternIsFarBelowNothing) {
    EXPECT_LT(ssim(stripes(100), stripes(-100)), -0.8);
}

TEST(Flip, OfEqualPicturesIsNothing) { EXPECT_EQ(meanFlip(stripes(60), stripes(60)), 0); }

/// What the method is scaled by: no two colours differ more than these.
TEST(Flip, OfGreenAndBlueIsOne) {
    EXPECT_NEAR(meanFlip(uniform({0, 255, 0}), uniform({0, 0, 255})), 1, 1e-4);
}

/// 100 of lightness to the power 0.7, past the knee of the paper's error mapping.
TEST(Flip, OfBlackAndWhiteIsWhatThePaperSays) {
    EXPECT_NEAR(meanFlip(uniform({0, 0, 0}), uniform({255, 255, 255})), 0.967, 1e-3);
}

TEST(Flip, GrowsWithTheDifferenceAndNeedNotKnowWhichIsFirst) {
    const double little = meanFlip(stripes(60), stripes(60, 0.5));
    const double more = meanFlip(stripes(60), stripes(60, 2));
    EXPECT_GT(little, 0);
    EXPECT_GT(more, little);
    EXPECT_LT(more, 1);
    EXPECT_NEAR(meanFlip(stripes(60, 2), stripes(60)), more, 1e-9);
}

TEST(HeatMap, HasOneColourForADisplacementAndMarksWhatIsBeyond) {
    const float nothing = std::nanf("");
    const Image map = heatMap(std::vector<float>{0, 1, 2, 2.001F, nothing, 1}, 3, 2, 2);
    EXPECT_EQ(map.colour[0], (Rgba{68, 1, 84}));
    EXPECT_EQ(map.colour[1], (Rgba{33, 144, 141}));
    EXPECT_EQ(map.colour[2], (Rgba{253, 231, 37}));
    EXPECT_EQ(map.colour[3], kBeyondColour);
    EXPECT_EQ(map.colour[4], kNothingColour);
    EXPECT_EQ(map.colour[5], map.colour[1]);
}

/// Of 16 x 12 pixels: the reference covers columns from `reference` on, the picture from `drawn`.
double outlineMoved(int reference, int drawn) {
    const Pinhole camera({.eye = {0, -10, 0}, .target = {0, 0, 0}}, 16, 12);
    ReferenceView view{camera, nullptr, {}};
    std::vector<float> depth;
    for (int y = 0; y < 12; ++y)
        for (int x = 0; x < 16; ++x) {
            const double hit = x >= reference ? 10 : kNoHit;
            view.hits.push_back({hit, hit});
            depth.push_back(x >= drawn ? 10.0F : std::numeric_limits<float>::infinity());
        }
    return silhouettePixels(view, depth);
}

TEST(Silhouette, IsAsFarOffAsItWasMoved) {
    EXPECT_EQ(outlineMoved(5, 5), 0);
    EXPECT_EQ(outlineMoved(5, 8), 3);
    EXPECT_EQ(outlineMoved(8, 5), 3);
    EXPECT_EQ(outlineMoved(16, 16), 0) << "nothing in either";
    EXPECT_EQ(outlineMoved(5, 16), 20) << "the diagonal of 16 x 12";
}

TEST(Silhouette, MeasuresObliquelyAndLetsPassWhatTheReferenceMayBe) {
    const Pinhole camera({.eye = {0, -10, 0}, .target = {0, 0, 0}}, 16, 12);
    ReferenceView view{camera, nullptr, std::vector<ReferenceSurface::HitRange>(16 * 12)};
    std::vector<float> depth(16 * 12, std::numeric_limits<float>::infinity());
    view.hits[2 * 16 + 3] = {10, 10};
    depth[2 * 16 + 3] = 10;
    depth[6 * 16 + 6] = 10;  // 3 to the right, 4 up
    EXPECT_EQ(silhouettePixels(view, depth), 5);
    view.hits[6 * 16 + 6] = {10, kNoHit};
    EXPECT_EQ(silhouettePixels(view, depth), 0);
}

}  // namespace
}  // namespace eyrie::truth
