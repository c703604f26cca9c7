// SPDX-License-Identifier: Apache-2.0
#include "coordinator/frame/view_change.h"

#include <cmath>

#include <gtest/gtest.h>

namespace eyrie::coordinator {
namespace {

fabric::Camera cameraAt(double azimuth, double distance = 10) {
    fabric::Camera camera;
    camera.eye = {distance * std::cos(azimuth), distance * std::sin(azimuth), 0};
    camera.target = {0, 0, 0};
    return camera;
}

TEST(ViewChange, TellsCutsFromMovements) {
    ViewChange view;
    EXPECT_TRUE(view.isCut(cameraAt(0)));
    view.follow(cameraAt(0));
    for (int i = 1; i < 50; ++i) {
        const double azimuth = 0.05 * i;
        EXPECT_FALSE(view.isCut(cameraAt(azimuth))) << i;
        view.follow(cameraAt(azimuth));
        fabric::Camera turned = cameraAt(azimuth);
        turned.target = 2.0 * turned.eye;
        EXPECT_TRUE(view.isCut(turned)) << i;
        EXPECT_TRUE(view.isCut(cameraAt(azimuth, 50))) << i;
        fabric::Camera zoomed = cameraAt(azimuth);
        zoomed.fovYDegrees /= 3;
        EXPECT_TRUE(view.isCut(zoomed)) << i;
    }
}

TEST(ViewChange, EveryFifthFrameMayBeACut) {
    ViewChange view;
    view.follow(cameraAt(0));
    for (int cut = 1; cut < 20; ++cut) {
        const double azimuth = 2.0 * cut;
        EXPECT_TRUE(view.isCut(cameraAt(azimuth))) << cut;
        for (int i = 0; i < 5; ++i) {
            view.follow(cameraAt(azimuth + 0.02 * i));
            EXPECT_FALSE(view.isCut(cameraAt(azimuth + 0.02 * (i + 1)))) << cut << " " << i;
        }
    }
}

/// A quarter turn a frame is a movement, too, once it goes on.
TEST(ViewChange, FastMovementsAreNoCuts) {
    ViewChange view;
    for (int i = 0; i < 10; ++i) {
        EXPECT_EQ(view.isCut(cameraAt(1.5 * i)), i < 2) << i;
        view.follow(cameraAt(1.5 * i));
    }
}

}  // namespace
}  // namespace eyrie::coordinator
