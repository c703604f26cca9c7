// SPDX-License-Identifier: Apache-2.0
#include "coordinator/config/screen.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <string>

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <gtest/gtest.h>

#include "coordinator/config/resolved.h"
#include "eqc_samples.h"

namespace eyrie::config {
namespace {

/// The plane of a wall or a projection as the notes on Equalizer's mathematics give it, by its own
/// formulas: axes, centre and size.
struct BookPlane {
    fabric::Vec3 u, v, w, centre;
    double width = 0;
    double height = 0;

    explicit BookPlane(const Wall& wall)
        : u(glm::normalize(wall.bottomRight - wall.bottomLeft)),
          v(glm::normalize(wall.topLeft - wall.bottomLeft)),
          w(glm::cross(u, v)),
          centre((wall.bottomRight + wall.topLeft) * .5),
          width(glm::distance(wall.bottomRight, wall.bottomLeft)),
          height(glm::distance(wall.topLeft, wall.bottomLeft)) {}

    /// Rows of the inverse of roll, pitch and heading, written out.
    explicit BookPlane(const Projection& projection) {
        const fabric::Vec3 angles = glm::radians(projection.headingPitchRollDegrees);
        const double sinH = std::sin(angles.x), cosH = std::cos(angles.x);
        const double sinP = std::sin(angles.y), cosP = std::cos(angles.y);
        const double sinR = std::sin(angles.z), cosR = std::cos(angles.z);
        u = {sinR * sinP * sinH + cosR * cosH, cosP * sinR, sinR * sinP * cosH - cosR * sinH};
        v = {cosR * sinP * sinH - sinR * cosH, cosP * cosR, sinR * sinH + cosR * sinP * cosH};
        w = {cosP * sinH, -sinP, cosP * cosH};
        centre = projection.origin - projection.distance * w;
        width = 2 * projection.distance * std::tan(glm::radians(projection.fovDegrees.x) / 2);
        height = 2 * projection.distance * std::tan(glm::radians(projection.fovDegrees.y) / 2);
    }

    /// A point of the room against the plane's axes and centre.
    fabric::Vec3 onPlane(const fabric::Vec3& point) const {
        const fabric::Vec3 d = point - centre;
        return {glm::dot(u, d), glm::dot(v, d), glm::dot(w, d)};
    }
};

/// Of the plane's corners, scaled to distance 1 from the eye.
fabric::Frustum byTheBook(const BookPlane& plane, const fabric::Vec3& eye) {
    const fabric::Vec3 e = plane.onPlane(eye);
    return {(-plane.width / 2 - e.x) / e.z, (plane.width / 2 - e.x) / e.z,
            (-plane.height / 2 - e.y) / e.z, (plane.height / 2 - e.y) / e.z};
}

/// The part of a frustum that a viewport is.
fabric::Frustum slice(const fabric::Frustum& whole, const Viewport& part) {
    const double width = whole.right - whole.left;
    const double height = whole.top - whole.bottom;
    const double left = whole.left + width * part.x;
    const double bottom = whole.bottom + height * part.y;
    return {left, left + width * part.width, bottom, bottom + height * part.height};
}

void expectNear(const fabric::Frustum& a, const fabric::Frustum& b) {
    EXPECT_NEAR(a.left, b.left, 1e-12);
    EXPECT_NEAR(a.right, b.right, 1e-12);
    EXPECT_NEAR(a.bottom, b.bottom, 1e-12);
    EXPECT_NEAR(a.top, b.top, 1e-12);
}

TEST(Screen, OfACaveIsWhatTheFormulasSay) {
    const Read read = sample("3-channel.cave.eqc");
    ASSERT_EQ(read.resolved.compounds.size(), 3U);
    const fabric::Vec3 eye(0, 0, 0);
    for (const ResolvedCompound& compound : read.resolved.compounds) {
        ASSERT_EQ(compound.sights.size(), 1U);
        const Wall& wall = *read.resolved.destinations[*compound.destination].wall;
        expectNear(compound.sights[0].sight->frustum, byTheBook(BookPlane(wall), eye));
    }
    // The left wall: from (-1, -1, 1) to (-1, -1, -1), seen from the middle, is 90 degrees wide.
    expectNear(read.resolved.compounds[0].sights[0].sight->frustum, {-1, 1, -1, 1});
}

/// What of a configuration an eye of a destination looks through: the view's surface, else the
/// segment's, else the canvas's; and where that lies on the canvas.
struct LookedThrough {
    const Surface* surface = nullptr;
    Viewport onCanvas;
};

LookedThrough lookedThrough(const Configuration& configuration, const DestinationIndex& index) {
    const Canvas& canvas = configuration.canvases[index.canvas];
    const Segment& segment = canvas.segments[index.segment];
    const View& view = configuration.layouts[index.layout].views[index.view];
    if (!std::holds_alternative<std::monostate>(view.surface))
        return {&view.surface, view.viewport};
    if (!std::holds_alternative<std::monostate>(segment.surface))
        return {&segment.surface, segment.viewport};
    return {&canvas.surface, {}};
}

BookPlane planeOf(const Surface& surface) {
    if (const auto* projection = std::get_if<Projection>(&surface))
        return BookPlane(*projection);
    return BookPlane(std::get<Wall>(surface));
}

/// Where the segment and the view of a destination meet, as a part of `whole`.
Viewport meetingWithin(const Configuration& configuration, const DestinationIndex& index,
                       const Viewport& whole) {
    const Viewport& a = configuration.canvases[index.canvas].segments[index.segment].viewport;
    const Viewport& b = configuration.layouts[index.layout].views[index.view].viewport;
    const double left = std::max(a.x, b.x);
    const double bottom = std::max(a.y, b.y);
    const double right = std::min(a.x + a.width, b.x + b.width);
    const double top = std::min(a.y + a.height, b.y + b.height);
    return {(left - whole.x) / whole.width, (bottom - whole.y) / whole.height,
            (right - left) / whole.width, (top - bottom) / whole.height};
}

/// A head at the origin: eyes half the eye base to the sides, unless their places are given.
fabric::Vec3 eyeByTheBook(const Configuration& configuration, const DestinationIndex& index,
                          EyeSight::Eye eye) {
    double base = .05;
    if (const Attribute* const setting = find(configuration.globals, "EQ_CONFIG_FATTR_EYE_BASE"))
        base = std::get<double>(setting->value);
    if (const Attribute* const setting = find(configuration.attributes, "eye_base"))
        base = std::get<double>(setting->value);
    const auto& at = configuration.layouts[index.layout].views[index.view].observer;
    const Observer observer = at ? configuration.observers[*at] : Observer{};
    base = observer.eyeBase.value_or(base);
    switch (eye) {
        case EyeSight::Eye::Left:
            return observer.eyeLeft.value_or(fabric::Vec3(-base / 2, 0, 0));
        case EyeSight::Eye::Right:
            return observer.eyeRight.value_or(fabric::Vec3(base / 2, 0, 0));
        case EyeSight::Eye::Cyclop:
            break;
    }
    return observer.eyeCyclop.value_or(fabric::Vec3(0, 0, 0));
}

/// Of every n-th column from the k-th on, k + 1/2 - n/2 columns beside the part; rows alike.
Viewport shifted(const ResolvedCompound& compound, const std::vector<Destination>& destinations) {
    const fabric::PixelViewport& pixels = destinations[*compound.destination].pixelViewport;
    const auto share = [](std::int64_t first, std::int64_t apart, std::int32_t count) {
        return static_cast<double>(2 * first + 1 - apart) / (2.0 * count);
    };
    const PixelShare& drawn = compound.pixel;
    Viewport part = compound.viewport;
    part.x += share(drawn.x, drawn.width, pixels.width);
    part.y += share(drawn.y, drawn.height, pixels.height);
    return part;
}

TEST(Screen, OfEveryFileOfEqualizersIsWhatTheFormulasSay) {
    std::size_t sights = 0;
    std::size_t ofProjections = 0;
    for (const std::string& name : samples()) {
        const Read read = sample(name);
        for (const ResolvedCompound& compound : read.resolved.compounds)
            for (const EyeSight& seen : compound.sights) {
                const DestinationIndex& index =
                    read.resolved.destinations[*compound.destination].index;
                const LookedThrough through = lookedThrough(read.configuration, index);
                const BookPlane plane =
                    compound.wall ? BookPlane(*compound.wall) : planeOf(*through.surface);
                const Viewport part =
                    compound.wall ? Viewport{}
                                  : meetingWithin(read.configuration, index, through.onCanvas);
                const fabric::Vec3 eye = eyeByTheBook(read.configuration, index, seen.eye);
                const fabric::Frustum whole = slice(byTheBook(plane, eye), part);
                SCOPED_TRACE(name + ", line " + std::to_string(compound.place().line));
                ASSERT_TRUE(seen.sight);
                expectNear(seen.sight->frustum,
                           slice(whole, shifted(compound, read.resolved.destinations)));
                for (const fabric::Vec3& point : {fabric::Vec3(1, 2, -3), fabric::Vec3(-4, 0, 1)}) {
                    const fabric::Vec3 expected = plane.onPlane(point) - plane.onPlane(eye);
                    const fabric::Vec4 got =
                        fabric::viewFromCamera(*seen.sight) * fabric::Vec4(point, 1);
                    EXPECT_NEAR(glm::distance(fabric::Vec3(got), expected), 0, 1e-12);
                }
                ++sights;
                ofProjections += std::holds_alternative<Projection>(*through.surface) ? 1 : 0;
            }
    }
    EXPECT_EQ(sights, 344U);
    EXPECT_EQ(ofProjections, 12U) << "those of 3-window.curved.eqc";
}

/// A window of 200 x 100 pixels onto a wall 1.6 m wide, 1 m ahead.
Read wallWith(const std::string& observer, const std::string& compounds) {
    return Read(
        "config { appNode { pipe { window { viewport [ 0 0 200 100 ]"
        " channel { name \"a\" } channel { name \"b\" } } } } observer { " +
        observer +
        " } layout { view { observer 0 mode STEREO } } canvas { layout 0 wall {"
        " bottom_left [ -.8 -.5 -1 ] bottom_right [ .8 -.5 -1 ] top_left [ -.8 .5 -1 ] }"
        " segment { channel \"a\" } } " +
        compounds + " }");
}

/// At the focus, 3 m ahead, and as wide an angle: the eyes see it 25 mm from the middle.
TEST(Screen, IsWhereTheObserversFocusMovesIt) {
    const Read read =
        wallWith("eye_base .05 focus_distance 3 focus_mode relative_to_observer",
                 "compound { channel ( canvas 0 segment 0 layout 0 view 0 ) eye [ LEFT RIGHT ] }");
    const auto& sights = read.resolved.compounds.at(0).sights;
    ASSERT_EQ(sights.size(), 2U);
    for (const EyeSight& each : sights) {
        const double eye = each.eye == EyeSight::Eye::Left ? -.025 : .025;
        ASSERT_TRUE(each.sight);
        EXPECT_NEAR(each.sight->frustum.left, (-2.4 - eye) / 3, 1e-12);
        EXPECT_NEAR(each.sight->frustum.right, (2.4 - eye) / 3, 1e-12);
        EXPECT_NEAR(each.sight->frustum.top, .5, 1e-12);
    }
}

/// Each of two shares has the middles of its own columns, half a column of 8 mm beside those of
/// pixels twice as wide.
TEST(Screen, IsShiftedByWhichPixelsAreDrawn) {
    const Read read = wallWith("eye_base 0",
                               "compound { channel ( canvas 0 segment 0 layout 0 view 0 )"
                               " compound { pixel [ 0 0 2 1 ] outputframe { name \"x\" } }"
                               " compound { channel \"b\" pixel [ 1 0 2 1 ]"
                               " outputframe { name \"y\" } }"
                               " inputframe { name \"x\" } inputframe { name \"y\" } }");
    const auto frustumOf = [&](std::size_t compound) {
        return read.resolved.compounds.at(compound).sights.at(0).sight->frustum;
    };
    EXPECT_NEAR(frustumOf(1).left, -.804, 1e-12);
    EXPECT_NEAR(frustumOf(1).right, .796, 1e-12);
    EXPECT_NEAR(frustumOf(2).left, -.796, 1e-12);
    EXPECT_NEAR(frustumOf(2).right, .804, 1e-12);
    EXPECT_NEAR(frustumOf(2).bottom, -.5, 1e-12);
    const Read zoomed = wallWith("eye_base 0",
                                 "compound { channel ( canvas 0 segment 0 layout 0 view 0 )"
                                 " zoom [ .5 1 ] outputframe { name \"whole\" }"
                                 " compound { pixel [ 0 0 2 1 ] outputframe { name \"x\" } }"
                                 " inputframe { name \"x\" } inputframe { name \"whole\" } }");
    EXPECT_NEAR(zoomed.resolved.compounds.at(1).sights.at(0).sight->frustum.left, -.808, 1e-12)
        << "of columns twice as wide";
}

TEST(Screen, PutsEveryPointOfTheWallWhereTheEyeSeesIt) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> any(-2, 2);
    for (int i = 0; i < 200; ++i) {
        const fabric::Vec3 corner(any(random), any(random), any(random));
        const fabric::Vec3 u = glm::normalize(fabric::Vec3(any(random), any(random), any(random)));
        const fabric::Vec3 other(any(random), any(random), any(random));
        const fabric::Vec3 v = glm::normalize(other - glm::dot(other, u) * u);
        const Wall wall{corner, corner + 3.0 * u, corner + 2.0 * v, false};
        const fabric::Vec3 eye = corner + any(random) * u + any(random) * v +
                                 (.1 + std::abs(any(random))) * glm::cross(u, v);
        const auto sight = sightThrough(wall, eye);
        ASSERT_TRUE(sight.has_value());
        expectNear(sight->frustum, byTheBook(BookPlane(wall), eye));
        const fabric::Vec4 seen = fabric::viewFromCamera(*sight) * fabric::Vec4(wall.topLeft, 1);
        EXPECT_NEAR(seen.x / -seen.z, sight->frustum.left, 1e-9);
        EXPECT_NEAR(seen.y / -seen.z, sight->frustum.top, 1e-9);
        EXPECT_FALSE(sightThrough(wall, eye - 10.0 * glm::cross(u, v)).has_value());
    }
}

TEST(Screen, OfAProjectorIsBeforeItWhicheverWayItTurns) {
    const Wall ahead = wallOf(Projection{{1, 2, 3}, 2, {90, 90}, {0, 0, 0}});
    EXPECT_NEAR(glm::distance(ahead.bottomLeft, fabric::Vec3(-1, 0, 1)), 0, 1e-12);
    const Wall left = wallOf(Projection{{0, 0, 0}, 1, {90, 90}, {90, 0, 0}});
    EXPECT_NEAR(glm::distance(left.bottomLeft, fabric::Vec3(-1, -1, 1)), 0, 1e-12);
    const Wall up = wallOf(Projection{{0, 0, 0}, 1, {90, 90}, {0, 90, 0}});
    EXPECT_NEAR(glm::distance(up.bottomLeft, fabric::Vec3(-1, 1, -1)), 0, 1e-12);
    const Wall rolled = wallOf(Projection{{0, 0, 0}, 1, {90, 90}, {0, 0, 90}});
    EXPECT_NEAR(glm::distance(rolled.bottomLeft, fabric::Vec3(1, -1, -1)), 0, 1e-12);
}

/// All of it and each segment alike: the rectangle on its lower side.
TEST(Screen, OfAWallThatIsNearlyARectangleIsOne) {
    const Wall skewed{{-1, -1, -2}, {1, -1, -2}, {-.98, 1, -2}, false};
    const std::optional<Wall> square = wallOf(Surface(skewed));
    ASSERT_TRUE(square);
    EXPECT_EQ(square->bottomLeft, skewed.bottomLeft);
    EXPECT_EQ(square->bottomRight, skewed.bottomRight);
    EXPECT_NEAR(glm::distance(square->topLeft, fabric::Vec3(-1, -1 + std::hypot(2, .02), -2)), 0,
                1e-12);
    const Read read(
        "config { appNode { pipe { window { channel { name \"a\" } } } } observer {} layout { view "
        "{ "
        "observer 0 } } canvas { layout 0 wall { bottom_left [ -1 -1 -2 ] bottom_right [ 1 -1 -2 ] "
        "top_left [ -.98 1 -2 ] } segment { channel \"a\" viewport [ 0 0 1 .5 ] } segment { "
        "channel "
        "\"a\" viewport [ 0 .5 1 .5 ] } } }");
    ASSERT_EQ(read.resolved.compounds.size(), 2U);
    for (const ResolvedCompound& each : read.resolved.compounds) {
        const auto& sight = each.sights.at(0).sight;
        ASSERT_TRUE(sight);
        EXPECT_NEAR(sight->frustum.left, -.5, 1e-12) << "the upper one is not beside the lower";
        EXPECT_NEAR(sight->frustum.right, .5, 1e-12);
    }
    const Wall rounded{{-1, -1, -2}, {1, -1, -2}, {-.999, 1, -2}, false};
    EXPECT_EQ(wallOf(Surface(rounded)), rounded);
}

TEST(Screen, ShowsEachEyeOfAStereoView) {
    const Read read = sample("2-window.HMD.eqc");
    ASSERT_EQ(read.resolved.destinations.size(), 2U);
    EXPECT_EQ(read.resolved.destinations[0].eyes, (Eyes{false, true, false}));
    EXPECT_EQ(read.resolved.destinations[1].eyes, (Eyes{false, false, true}));
    for (const ResolvedCompound& compound : read.resolved.compounds)
        EXPECT_EQ(compound.sights.size(), 1U);
}

}  // namespace
}  // namespace eyrie::config
