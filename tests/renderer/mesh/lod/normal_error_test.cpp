// SPDX-License-Identifier: Apache-2.0
// How far the normals that a level shows are from the source's. The judge knows nothing of maps: of
// each point it looks through all of the source within the distance promised for a normal that is
// within the angle promised.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "renderer/import/mesh_synth.h"
#include "renderer/mesh/back_faces.h"
#include "renderer/mesh/eym_format.h"
#include "renderer/mesh/eym_writer.h"
#include "renderer/mesh/lod/lod_tree.h"
#include "renderer/mesh/output_file.h"
#include "renderer/mesh/vertex_packing.h"
#include "tests/renderer/mesh/lod/sample_levels.h"
#include "tests/renderer/mesh/temporary_folder.h"

namespace eyrie::mesh {
namespace {

using fabric::Vec3;
using test::Levels;
using test::levelsOf;
using test::sheet;

/// Parts of a source triangle's sides at whose ends the judge looks.
constexpr int kParts = 4;

struct Corner {
    Vec3 place;
    Vec3 normal;
};
using Corners = std::array<Corner, 3>;

double degreesBetween(const Vec3& a, const Vec3& b) {
    return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b)) * 180 / std::numbers::pi;
}

Corner blend(const Corners& corners, const std::array<double, 3>& weights) {
    Corner at{Vec3(0), Vec3(0)};
    for (std::size_t k = 0; k < 3; ++k) {
        at.place += weights[k] * corners[k].place;
        at.normal += weights[k] * corners[k].normal;
    }
    return at;
}

Corners cornersOf(const PackedMesh& mesh, const Triangle& triangle) {
    const auto corner = [&](std::uint32_t vertex) {
        return Corner{mesh.lattice.metres(unpackPosition(mesh.positions[vertex])),
                      Vec3(unpackNormal(mesh.normals[vertex]))};
    };
    return {corner(triangle[0]), corner(triangle[1]), corner(triangle[2])};
}

double longestSide(const Corners& t) {
    return std::max({glm::distance(t[0].place, t[1].place), glm::distance(t[1].place, t[2].place),
                     glm::distance(t[2].place, t[0].place)});
}

class Judge {
public:
    Judge(const Levels& levels, const KdNode& node) {
        for (std::uint64_t i = node.triangleBegin; i < node.triangleEnd; ++i) {
            const Corners t = cornersOf(levels.mesh, levels.mesh.triangles[levels.tree.order[i]]);
            const double turn = std::max({degreesBetween(t[0].normal, t[1].normal),
                                          degreesBetween(t[1].normal, t[2].normal),
                                          degreesBetween(t[2].normal, t[0].normal)});
            source_.push_back({t, longestSide(t), 1.5 * turn / kParts});
        }
    }

    /// Not more than the least angle between what is shown and a normal of the source within a
    /// distance of there; less by what normals change between the places looked at, at most.
    double leastDegrees(const Corner& shown, double distance) const {
        double least = 180;
        for (const auto& [corners, longest, change] : source_) {
            if (glm::distance(corners[0].place, shown.place) > distance + longest)
                continue;
            for (int i = 0; i <= kParts; ++i)
                for (int j = 0; i + j <= kParts; ++j) {
                    const double b = double(i) / kParts;
                    const double c = double(j) / kParts;
                    const Corner at = blend(corners, {1 - b - c, b, c});
                    if (glm::distance(at.place, shown.place) <= distance + longest / kParts)
                        least = std::min(least, degreesBetween(at.normal, shown.normal) - change);
                }
        }
        return std::max(least, 0.0);
    }

private:
    struct Source {
        Corners corners;
        double longest;  ///< side
        double change;   ///< of normals, degrees, between neighbouring places that are looked at
    };
    std::vector<Source> source_;
};

/// A place of what stands for a node, and its share of that.
struct Shown {
    Corner at;
    double weight;
};

std::vector<Shown> shownBy(const Levels& levels, std::size_t index, std::mt19937& random) {
    std::vector<Shown> shown;
    if (const auto& points = levels.lod.points[index]) {
        for (std::size_t i = 0; i < points->positions.size(); i += 3)
            shown.push_back({{levels.mesh.lattice.metres(unpackPosition(points->positions[i])),
                              Vec3(unpackNormal(points->normals[i]))},
                             1});
        return shown;
    }
    std::uniform_real_distribution<double> share(0, 1);
    for (const Triangle& triangle : levels.lod.geometry[index]) {
        const Corners corners = cornersOf(levels.mesh, triangle);
        const double a = std::sqrt(share(random));
        const double b = share(random);
        shown.push_back({blend(corners, {1 - a, a * (1 - b), a * b}),
                         glm::length(glm::cross(corners[1].place - corners[0].place,
                                                corners[2].place - corners[0].place))});
    }
    return shown;
}

struct Found {
    std::size_t nodes = 0;
    std::size_t telling = 0;    ///< nodes of which the mean says something
    std::size_t points = 0;     ///< that were looked at
    std::size_t offNearby = 0;  ///< of these, for which a fourth of the promise is not enough
    double most = 0;
    double mean = 0;
};

/// `judgeOf(i)`: says how far something shown for node i is off, degrees, or less.
template <typename JudgeOf>
Found checkLaw(const Levels& levels, const JudgeOf& judgeOf) {
    Found found;
    std::mt19937 random(3);
    for (std::size_t i = 0; i < levels.tree.nodes.size(); ++i) {
        const NormalError& promised = levels.lod.normalErrors[i];
        EXPECT_LE(promised.mean, promised.most);
        if (levels.lod.geometry[i].empty() && !levels.lod.points[i]) {
            EXPECT_EQ(promised.most, 0);
            continue;
        }
        const auto judge = judgeOf(i);
        double worst = 0;
        double sum = 0;
        double weights = 0;
        for (const auto& [at, weight] : shownBy(levels, i, random)) {
            const double degrees = judge(at);
            worst = std::max(worst, degrees);
            sum += weight * degrees;
            weights += weight;
            ++found.points;
            found.offNearby += degrees > promised.most / 4 ? 1 : 0;
        }
        EXPECT_LE(worst, promised.most + 0.01) << "node " << i;
        EXPECT_LE(sum / weights, promised.mean + 0.01) << "node " << i;
        ++found.nodes;
        found.telling += promised.mean < 45 ? 1 : 0;
        found.most = std::max(found.most, promised.most);
        found.mean = std::max(found.mean, promised.mean);
    }
    return found;
}

Found checkLaw(const Levels& levels) {
    return checkLaw(levels, [&](std::size_t i) {
        return [judge = Judge(levels, levels.tree.nodes[i]),
                within = levels.lod.errorMetres[i] * (1 + 1e-9)](const Corner& shown) {
            return judge.leastDegrees(shown, within);
        };
    });
}

TEST(NormalError, HoldsOfABallAndSaysSomethingOfMostOfIt) {
    const Found found = checkLaw(levelsOf(import::synthesizeMesh(6000, 5)));
    EXPECT_GT(found.nodes, 10U);
    EXPECT_GT(found.telling, found.nodes / 2);
}

TEST(NormalError, IsNoneOfAPlane) {
    const Levels levels = levelsOf(sheet(64, [](std::uint32_t, std::uint32_t) { return 0.0; }));
    const Found found = checkLaw(levels);
    EXPECT_GT(found.nodes, 5U);
    EXPECT_LT(found.most, 0.1);  // what is allowed for rounding, step by step
}

/// So it does not merely say something large: where noise is flattened, normals are off.
TEST(NormalError, HoldsOfNoiseForWhichAFourthIsNotEnough) {
    std::mt19937 random(11);
    std::uniform_real_distribution<double> noise(0, 0.02);
    const Found found =
        checkLaw(levelsOf(sheet(64, [&](std::uint32_t, std::uint32_t) { return noise(random); })));
    EXPECT_GT(found.nodes, 5U);
    EXPECT_LT(found.most, 20);
    EXPECT_GT(found.offNearby, 0U);
}

/// Light falls on a wave as on what it bends like, the better the finer it is sampled: blends of
/// normals are off by the square of a triangle's size, and so is the promise, about.
TEST(NormalError, OfAWaveIsFarLessThanItsNormalsTurn) {
    const auto wave = [](std::uint32_t x, std::uint32_t) { return 4 * std::sin(0.1 * x); };
    const Found found = checkLaw(levelsOf(sheet(64, wave)));
    EXPECT_GT(found.nodes, 5U);
    EXPECT_LT(found.mean, 8);  // its slopes are up to 22 degrees to either side
}

/// A plane with normals of its file's: as it stays where it is, partners are in the same place.
class NormalsOfAPlane : public testing::TestWithParam<std::pair<std::string, float>> {
protected:
    /// Between what is shown in a place and what the source has there.
    static double degreesAt(const Levels& levels, const KdNode& node, const Corner& shown) {
        for (std::uint64_t i = node.triangleBegin; i < node.triangleEnd; ++i) {
            const Corners t = cornersOf(levels.mesh, levels.mesh.triangles[levels.tree.order[i]]);
            const auto share = [&](const Vec3& from, const Vec3& to) {
                return glm::cross(from - shown.place, to - shown.place).z /
                       glm::cross(t[1].place - t[0].place, t[2].place - t[0].place).z;
            };
            const std::array<double, 3> weights = {share(t[1].place, t[2].place),
                                                   share(t[2].place, t[0].place),
                                                   share(t[0].place, t[1].place)};
            if (*std::ranges::min_element(weights) >= -1e-9)
                return degreesBetween(blend(t, weights).normal, shown.normal);
        }
        ADD_FAILURE() << "the source has nothing where something is shown";
        return 0;
    }
};

INSTANTIATE_TEST_SUITE_P(NormalError, NormalsOfAPlane,
                         testing::Values(std::pair("Waves", 0.0F), std::pair("Noise", 0.1F),
                                         std::pair("MuchNoise", 0.6F)),
                         [](const auto& named) { return named.param.first; });

TEST_P(NormalsOfAPlane, AreWithinTheirErrorAndNotFarWithin) {
    std::mt19937 random(11);
    const float noise = GetParam().second;
    std::uniform_real_distribution<float> off(-noise, noise);
    import::TriangleMesh mesh = sheet(64, [](std::uint32_t, std::uint32_t) { return 0.0;
});
for (const Vec3& place : mesh.positions) {
    const glm::vec3 at(place);
    mesh.normals.emplace_back(0.4F * std::sin(0.3F * at.x) + off(random),
                              0.4F * std::cos(0.2F * at.y) + off(random), 1);
}
const Levels levels = levelsOf(std::move(mesh), {.nodeTriangles = test::kNodeTriangles},
                               {.normals = import::NormalSource::File});
const Found found = checkLaw(levels, [&](std::size_t i) {
    return [&levels, i](const Corner& shown) {
        return degreesAt(levels, levels.tree.nodes[i], shown);
    };
});
EXPECT_GT(found.nodes, 5U);
EXPECT_GT(found.offNearby, 10U);
}  // namespace

TEST(NormalError, HoldsAcrossCreases) {
    const auto roof = [](std::uint32_t x, std::uint32_t) {
        return x % 16 < 8 ? 0.5 * (x % 8) : 0.5 * (8 - x % 8);
    };
    const Found found = checkLaw(levelsOf(sheet(64, roof), {.nodeTriangles = test::kNodeTriangles},
                                          {.normals = import::NormalSource::Crease}));
    EXPECT_GT(found.nodes, 5U);
}

TEST(NormalError, HoldsOfPointsAndOfWhatLosesPieces) {
    EXPECT_GT(checkLaw(levelsOf(test::ballWithPieces())).nodes, 3U);
    const Levels levels = levelsOf(test::ballWithPieces(), test::kWithPoints);
    EXPECT_GT(levels.lod.pointNodes(), 3U);
    EXPECT_GT(checkLaw(levels).nodes, 3U);
}

TEST(NormalError, IsInTheFile) {
    const test::TemporaryFolder folder;
    const auto [mesh, tree, lod] = levelsOf(import::synthesizeMesh(6000, 5));
    auto out = OutputFile::create(folder.file("m.eym"));
    ASSERT_TRUE(out.ok());
    ASSERT_TRUE(writeEym(mesh, tree, lod, findBacks(mesh, tree), {}, *out).ok());
    ASSERT_TRUE(out->commit().ok());
    const auto file = EymFile::open(folder.file("m.eym"));
    ASSERT_TRUE(file.ok()) << file.status();
    int off = 0;
    for (std::size_t i = 0; i < tree.nodes.size(); ++i) {
        const Node& node = file->nodes()[i];
        const NormalError& error = lod.normalErrors[i];
        EXPECT_GE(double{node.normalErrorDegrees}, error.most);
        EXPECT_LE(double{node.normalErrorDegrees}, error.most * 1.0001);
        EXPECT_GE(double{node.normalErrorMeanDegrees}, error.mean);
        EXPECT_LE(double{node.normalErrorMeanDegrees}, error.mean * 1.0001);
        off += error.mean > 0 ? 1 : 0;
    }
    EXPECT_GT(off, 5);
}

}  // namespace eyrie::mesh
}  // namespace eyrie::mesh
