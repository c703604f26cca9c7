// SPDX-License-Identifier: Apache-2.0
// Where the colours that a level shows come from. The judge knows nothing of maps: of each point it
// finds the range of all colours that the source's triangles have within the distance promised.
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <memory>
#include <random>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "renderer/import/mesh_synth.h"
#include "renderer/mesh/lod/lod_tree.h"
#include "renderer/mesh/lod/patch_colours.h"
#include "renderer/mesh/vertex_packing.h"
#include "tests/renderer/mesh/lod/sample_levels.h"

namespace eyrie::mesh {
namespace {

using fabric::Rgba;
using fabric::Vec3;
using fabric::Vec4;
using import::TriangleMesh;
using test::Levels;

/// Of `colour` at each vertex, or of none.
Levels levelsOf(TriangleMesh source, const std::function<Rgba(const Vec3&)>& colour,
                const LodOptions& options = {.nodeTriangles = test::kNodeTriangles}) {
    if (colour)
        for (const Vec3& at : source.positions) source.colours.push_back(colour(at));
    return test::levelsOf(std::move(source), options);
}

auto plane(std::uint32_t cells) {
    return test::sheet(cells, [](std::uint32_t, std::uint32_t) { return 0.0; });
}

std::function<Rgba(const Vec3&)> checks(double side) {
    return [side](const Vec3& at) {
        const auto sum = static_cast<int>(std::floor(at.x / side) + std::floor(at.y / side) +
                                          std::floor(at.z / side));
        return sum % 2 == 0 ? Rgba{250, 240, 20, 255} : Rgba{10, 30, 200, 255};
    };
}

std::function<Rgba(const Vec3&)> noise(int most) {
    return [most, random = std::make_shared<std::mt19937>(9)](const Vec3&) {
        const auto one = [&] {
            return static_cast<std::uint8_t>(130 +
                                             static_cast<int>((*random)() % 1000) * most / 1000);
        };
        return Rgba{one(), one(), one(), 255};
    };
}

Rgba gradient(const Vec3& at) {
    const auto part = [](double of) {
        return static_cast<std::uint8_t>(std::clamp(128 + 60 * of, 0.0, 255.0));
    };
    return {part(at.x), part(at.y), part(at.z), 255};
}

/// Least and most of a channel's light, or of opacity.
struct Range {
    double least = 2;
    double most = -1;
    void hold(double one) {
        least = std::min(least, one);
        most = std::max(most, one);
    }
};

struct Corner {
    Vec3 place;
    Vec4 light;  ///< and the opacity
};

Vec4 lightOf(const Rgba& colour) {
    const Vec4 shown = Vec4(colour.r, colour.g, colour.b, colour.a) / 255.0;
    return {shown.r * shown.r, shown.g * shown.g, shown.b * shown.b, shown.a};
}

class Judge {
public:
    explicit Judge(const Levels& levels) : levels_(levels) {}

    Corner corner(std::uint32_t vertex) const {
        return {levels_.mesh.lattice.metres(unpackPosition(levels_.mesh.positions[vertex])),
                lightOf(unpackColour(levels_.mesh.colours[vertex]))};
    }

    void look(const KdNode& node) {
        source_.clear();
        for (std::uint64_t i = node.triangleBegin; i < node.triangleEnd; ++i) {
            const auto [a, b, c] = levels_.mesh.triangles[levels_.tree.order[i]];
            source_.push_back(boxed({corner(a), corner(b), corner(c)}));
        }
    }

    /// How far a light shown at a place is off the source's within a distance, as displayed, or the
    /// opacity.
    double off(const Corner& shown, double distance) const {
        std::array<Range, 4> ranges;
        for (const auto& [triangle, low, high] : source_) {
            bool isNear = true;
            for (std::size_t k = 0; k < 3; ++k)
                isNear = isNear && shown.place[static_cast<int>(k)] >= low[k] - distance &&
                         shown.place[static_cast<int>(k)] <= high[k] + distance;
            if (isNear)
                holdWithin(triangle, shown.place, distance, ranges);
        }
        double most = 0;
        for (int k = 0; k < 3; ++k) {
            const Range& range = ranges[static_cast<std::size_t>(k)];
            most = std::max({most, std::sqrt(shown.light[k]) - std::sqrt(std::max(range.most, 0.0)),
                             std::sqrt(range.least) - std::sqrt(shown.light[k])});
        }
        return std::max({most, shown.light.a - ranges[3].most, ranges[3].least - shown.light.a});
    }

private:
    /// With the box around it, which tells most triangles apart from a ball in no time.
    struct Boxed {
        std::array<Corner, 3> corners;
        std::array<double, 3> low;
        std::array<double, 3> high;
    };

    static Boxed boxed(const std::array<Corner, 3>& corners) {
        Boxed made{corners, {}, {}};
        for (std::size_t k = 0; k < 3; ++k) {
            const auto at = [&](std::size_t i) { return corners[i].place[static_cast<int>(k)]; };
            made.low[k] = std::min({at(0), at(1), at(2)});
            made.high[k] = std::max({at(0), at(1), at(2)});
        }
        return made;
    }

    /// All that is within a ball of a triangle: what is linear is extreme at its corners, where its
    /// sides leave the ball, or farthest along its slope in the plane.
    static void holdWithin(const std::array<Corner, 3>& triangle, const Vec3& middle, double radius,
                           std::array<Range, 4>& ranges) {
        const auto hold = [&](const Vec4& light) {
            for (int k = 0; k < 4; ++k) ranges[static_cast<std::size_t>(k)].hold(light[k]);
        };
        for (std::size_t i = 0; i < 3; ++i) {
            const Corner& from = triangle[i];
            const Corner& to = triangle[(i + 1) % 3];
            if (glm::distance(from.place, middle) <= radius)
                hold(from.light);
            const Vec3 along = to.place - from.place;
            const Vec3 away = from.place - middle;
            const double a = glm::dot(along, along);
            const double b = glm::dot(along, away);
            const double root = b * b - a * (glm::dot(away, away) - radius * radius);
            if (root < 0)
                continue;
            for (const double sign : {-1.0, 1.0}) {
                const double share = (-b + sign * std::sqrt(root)) / a;
                if (share >= 0 && share <= 1)
                    hold(glm::mix(from.light, to.light, share));
            }
        }
        const Vec3 u = triangle[1].place - triangle[0].place;
        const Vec3 v = triangle[2].place - triangle[0].place;
        const Vec3 normal = glm::normalize(glm::cross(u, v));
        const double height = glm::dot(middle - triangle[0].place, normal);
        if (std::abs(height) >= radius)
            return;
        const double within = std::sqrt(radius * radius - height * height);
        const Vec3 foot = middle - height * normal;
        // Shares of the second and third corner grow along these.
        const Vec3 toB = glm::cross(v, normal) / glm::dot(u, glm::cross(v, normal));
        const Vec3 toC = glm::cross(normal, u) / glm::dot(v, glm::cross(normal, u));
        const auto holdIfOn = [&](const Vec3& at) {
            const double b = glm::dot(at - triangle[0].place, toB);
            const double c = glm::dot(at - triangle[0].place, toC);
            if (b >= 0 && c >= 0 && b + c <= 1)
                hold((1 - b - c) * triangle[0].light + b * triangle[1].light +
                     c * triangle[2].light);
        };
        holdIfOn(foot);
        for (int k = 0; k < 4; ++k) {
            const Vec3 slope = (triangle[1].light[k] - triangle[0].light[k]) * toB +
                               (triangle[2].light[k] - triangle[0].light[k]) * toC;
            if (glm::length(slope) > 0)
                for (const double sign : {-1.0, 1.0})
                    holdIfOn(foot + sign * within * glm::normalize(slope));
        }
    }

    const Levels& levels_;
    std::vector<Boxed> source_;
};

/// What stands for a node, here and there.
std::vector<Corner> shownBy(const Levels& levels, const Judge& judge, std::size_t index,
                            std::mt19937& random) {
    std::vector<Corner> shown;
    if (const auto& points = levels.lod.points[index]) {
        for (std::size_t i = 0; i < points->positions.size(); i += 3) {
            Vec4 light = lightOf(unpackColour(points->colours[i]));
            light.a = 1;  // of a point alpha says from where it is seen
            shown.push_back(
                {levels.mesh.lattice.metres(unpackPosition(points->positions[i])), light});
        }
        return shown;
    }
    std::uniform_real_distribution<double> share(0, 1);
    for (const Triangle& triangle : levels.lod.geometry[index]) {
        const double a = std::sqrt(share(random));
        const double b = share(random);
        const std::array<double, 3> weights = {1 - a, a * (1 - b), a * b};
        Corner at{Vec3(0), Vec4(0)};
        for (std::size_t k = 0; k < 3; ++k) {
            const Corner corner = judge.corner(triangle[k]);
            at.place += weights[k] * corner.place;
            at.light += weights[k] * corner.light;
        }
        shown.push_back(at);
    }
    return shown;
}

struct Found {
    std::size_t nodes = 0;
    std::size_t withReach = 0;
    std::size_t offNearby = 0;  ///< points for which a fourth of the promise is not enough
};

Found checkLaw(const Levels& levels) {
    Found found;
    Judge judge(levels);
    std::mt19937 random(3);
    for (std::size_t i = 0; i < levels.tree.nodes.size(); ++i) {
        const KdNode& node = levels.tree.nodes[i];
        const double reach = levels.lod.colourReachMetres[i];
        if (!node.isLeaf())
            for (const std::int32_t child : {node.left, node.right})
                EXPECT_GE(reach, levels.lod.colourReachMetres[static_cast<std::size_t>(child)]);
        else
            EXPECT_EQ(reach, 0);
        if (levels.lod.geometry[i].empty() && !levels.lod.points[i])
            continue;
        judge.look(node);
        const double promised = std::max(levels.lod.errorMetres[i], reach);
        double worst = 0;
        for (const Corner& shown : shownBy(levels, judge, i, random)) {
            worst = std::max(worst, judge.off(shown, promised * (1 + 1e-9)));
            found.offNearby += judge.off(shown, promised / 4) > double{kColourTolerance} ? 1 : 0;
        }
        EXPECT_LE(worst, double{kColourTolerance} + 1e-6) << "node " << i;
        ++found.nodes;
        found.withReach += reach > 0 ? 1 : 0;
    }
    return found;
}

TEST(ColourReach, HoldsOfChecksOnABall) {
    const Found found = checkLaw(levelsOf(import::synthesizeMesh(6000, 5), checks(0.3)));
    EXPECT_GT(found.nodes, 10U);
    EXPECT_GT(found.withReach, 0U);
}

TEST(ColourReach, HoldsOfNoise) {
    for (const int most : {6, 40, 120}) {
        const Found found = checkLaw(levelsOf(import::synthesizeMesh(6000, 5), noise(most)));
        EXPECT_GT(found.nodes, 10U);
        EXPECT_EQ(found.withReach > 0, most > 6);
    }
}

/// So it does not merely say something large: of checks that vanish a fourth is not enough.
TEST(ColourReach, HoldsOfAPlaneWhoseChecksVanishAndIsNotManyTimesTooLong) {
    const Found found = checkLaw(levelsOf(plane(96), checks(6)));
    EXPECT_GT(found.withReach, 5U);
    EXPECT_GT(found.offNearby, 10U);
}

TriangleMesh blended(TriangleMesh mesh) {
    mesh.materials = {{.flags = kIsBlended}};
    mesh.materialOf.assign(mesh.positions.size(), 0);
    return mesh;
}

std::function<Rgba(const Vec3&)> veil(double side) {
    return [colour = checks(side)](const Vec3& at) { return Rgba{200, 90, 7, colour(at).r}; };
}

TEST(ColourReach, HoldsOfOpacity) {
    const Found found = checkLaw(levelsOf(blended(plane(96)), veil(6)));
    EXPECT_GT(found.withReach, 5U);
    EXPECT_GT(found.offNearby, 10U);
}

/// What nothing is seen through costs no triangles.
TEST(ColourReach, IsNoneOfOpacityThatIsNotDrawn) {
    const Levels levels = levelsOf(plane(96), veil(6));
    EXPECT_EQ(levels.lod.geometry, levelsOf(plane(96), {}).lod.geometry);
    EXPECT_EQ(levels.lod.colourReachMetres.front(), 0);
}

TEST(ColourReach, HoldsWhereVerticesOfOnePlaceHaveSeveralColours) {
    TriangleMesh source = import::synthesizeMesh(6000, 5);
    const TriangleMesh whole = source;
    source.triangles.clear();
    // Two halves of the ball with vertices of their own along the equator.
    const auto beside = static_cast<std::uint32_t>(whole.positions.size());
    for (std::size_t v = 0; v < beside; ++v) source.positions.push_back(whole.positions[v]);
    for (auto triangle : whole.triangles) {
        const Vec3 sum = whole.positions[triangle[0]] + whole.positions[triangle[1]] +
                         whole.positions[triangle[2]];
        if (sum.z > 0)
            for (std::uint32_t& corner : triangle) corner += beside;
        source.triangles.push_back(triangle);
    }
    for (std::size_t v = 0; v < source.positions.size(); ++v)
        source.colours.push_back(v < beside ? checks(0.5)(source.positions[v])
                                            : gradient(source.positions[v]));
    EXPECT_GT(checkLaw(levelsOf(std::move(source), {})).nodes, 10U);
}

TEST(ColourReach, HoldsOfPointsAndOfWhatLosesPieces) {
    const Levels pieces = levelsOf(test::ballWithPieces(), checks(0.2));
    EXPECT_GT(checkLaw(pieces).nodes, 3U);
    const Levels levels = levelsOf(test::ballWithPieces(), checks(0.2), test::kWithPoints);
    EXPECT_GT(levels.lod.pointNodes(), 3U);
    EXPECT_GT(checkLaw(levels).nodes, 3U);
}

TEST(ColourReach, IsNoneOfAMeshWithOneColourWhoseLevelsAreThoseOfOneWithout) {
    const Levels plain = levelsOf(import::synthesizeMesh(20000, 5), {});
    const Levels coloured = levelsOf(import::synthesizeMesh(20000, 5), [](const Vec3&) {
        return Rgba{200, 90, 7, 255};
    });
    EXPECT_EQ(plain.mesh.positions, coloured.mesh.positions);
    EXPECT_EQ(plain.lod.geometry, coloured.lod.geometry);
    EXPECT_EQ(plain.lod.errorMetres, coloured.lod.errorMetres);
    for (const Levels* levels : {&plain, &coloured})
        EXPECT_TRUE(std::ranges::all_of(levels->lod.colourReachMetres,
                                        [](double reach) { return reach == 0; }));
}

/// Few vertices that differ among many that do not: edges between checks stay, which is why a
/// quarter of the triangles shows them as they are.
TEST(ColourReach, IsNoneAsLongAsEdgesBetweenColoursMayStay) {
    const Levels levels = levelsOf(plane(128), checks(32));
    std::size_t coarsest = levels.mesh.triangles.size();
    for (std::size_t i = 0; i < levels.tree.nodes.size(); ++i) {
        const KdNode& node = levels.tree.nodes[i];
        if (!levels.lod.geometry[i].empty() && levels.lod.colourReachMetres[i] == 0)
            coarsest =
                std::min(coarsest, levels.lod.geometry[i].size() * levels.mesh.triangles.size() /
                                       (node.triangleEnd - node.triangleBegin));
    }
    EXPECT_LE(coarsest, levels.mesh.triangles.size() / 4);
}

TEST(ColourReach, IsNoneOfColoursThatChangeEvenly) {
    const Levels levels = levelsOf(plane(128), [](const Vec3& at) {
        // Evenly in light, which is what triangles show between their corners.
        const double light = 0.1 + 0.8 * (at.x + at.y) / 256;
        return Rgba{static_cast<std::uint8_t>(std::lround(255 * std::sqrt(light))), 90, 80, 255};
    });
    ASSERT_EQ(levels.lod.levels.size(), 6U);
    // At the last hardly a vertex is left that is not on the plane's border.
    EXPECT_EQ(levels.lod.levels[4].largestReachMetres, 0);
    // Five halvings, and what is kept for borders besides.
    EXPECT_LE(levels.lod.levels[4].trianglesAfter, levels.mesh.triangles.size() / 20);
}

}  // namespace
}  // namespace eyrie::mesh
