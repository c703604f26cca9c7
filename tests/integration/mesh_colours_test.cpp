// SPDX-License-Identifier: Apache-2.0
// Colours of a mesh's vertices in pictures: each is one that the source shows within what the frame
// promises. The judge reads a plane of checks at the places that lines of sight meet.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/integration/mesh_pictures.h"

namespace eyrie {
namespace {

using fabric::Vec3;
using import::TriangleMesh;

constexpr int kCells = 400;
constexpr int kCheck = 4;  ///< cells a side
constexpr std::uint8_t kBright = 235;
constexpr std::uint8_t kDark = 40;
/// As promised (docs/errors.md#vertex-colours), and what rounding to bytes adds.
constexpr double kOff = 8.5 / 255;

bool isBright(int x, int y) { return (x / kCheck + y / kCheck) % 2 == 0; }

TriangleMesh checkedPlane() {
    TriangleMesh mesh;
    for (int y = 0; y <= kCells; ++y)
        for (int x = 0; x <= kCells; ++x) {
            mesh.positions.emplace_back(x, y, 0);
            const std::uint8_t shade = isBright(x, y) ? kBright : kDark;
            mesh.colours.push_back({shade, shade, shade, 255});
            const auto at = static_cast<std::uint32_t>(y * (kCells + 1) + x);
            constexpr std::uint32_t kRow = kCells + 1;
            if (x < kCells && y < kCells)
                for (const mesh::Triangle& triangle :
                     {mesh::Triangle{at, at + 1, at + kRow + 1}, {at, at + kRow + 1, at + kRow}})
                    mesh.triangles.push_back(triangle);
        }
    return mesh;
}

/// What the source shows at a place, as displayed; triangles are linear in its square.
std::optional<double> shownAt(const Vec3& place) {
    if (place.x < 0 || place.y < 0 || place.x > kCells || place.y > kCells)
        return std::nullopt;
    const int x = std::min(static_cast<int>(place.x), kCells - 1);
    const int y = std::min(static_cast<int>(place.y), kCells - 1);
    const auto light = [](int column, int row) {
        const double shade = (isBright(column, row) ? kBright : kDark) / 255.0;
        return shade * shade;
    };
    const double u = place.x - x;
    const double v = place.y - y;
    const double corner = u > v ? light(x + 1, y) : light(x, y + 1);
    return std::sqrt((1 - std::max(u, v)) * light(x, y) + std::abs(u - v) * corner +
                     std::min(u, v) * light(x + 1, y + 1));
}

class MeshColours : public test::MeshPictures {
protected:
    MeshColours() : MeshPictures(480, 270) {
        // Nothing but what is the colours' own.
        scene_.lights = {{.direction = {0, 0, -1}, .colour = {0, 0, 0}}};
    }

    /// Of what the source shows around a place of the picture, nothing where it ends.
    struct Shades {
        double least = 2;
        double most = -1;
        bool isWhole = true;
    };
    static Shades shadesAround(const truth::Pinhole& view, double x, double y, double pixels) {
        Shades shades;
        constexpr int kRings = 8;
        constexpr int kAngles = 48;
        for (int ring = 0; ring <= kRings; ++ring)
            for (int angle = 0; angle < (ring == 0 ? 1 : kAngles); ++angle) {
                const double away = pixels * ring / kRings;
                const double turn = 2 * M_PI * angle / kAngles;
                const truth::Ray ray =
                    view.rayThrough(x + away * std::cos(turn), y + away * std::sin(turn));
                const auto shade = shownAt(ray.at(-ray.origin.z / ray.direction.z));
                shades.isWhole = shades.isWhole && shade;
                if (!shade)
                    continue;
                shades.least = std::min(shades.least, *shade);
                shades.most = std::max(shades.most, *shade);
            }
        return shades;
    }

    struct Looked {
        std::size_t pixels = 0;
        std::size_t plain = 0;  ///< around which the source hardly changes within the promise
        double promised = 0;
    };
    Looked checkColours(const fabric::Camera& camera, double tauPixels) {
        const fabric::ChannelResult drawn = draw(camera, tauPixels);
        const double promised = drawn.statistics.tauAchievedPixels;
        EXPECT_LE(promised, tauPixels);
        const truth::Pinhole view(camera, width_, height_);
        Looked looked{.promised = promised};
        std::size_t wrong = 0;
        for (int row = 0; row < height_; ++row)
            for (int column = 0; column < width_; ++column) {
                const auto at = static_cast<std::size_t>(row * width_ + column);
                if (drawn.image.depth[at] == 0)
                    continue;
                const double shade = drawn.image.colour[at].g / 255.0;
                const Shades around =
                    shadesAround(view, column + 0.5, row + 0.5, promised + 2 * test::kRasterPixels);
                if (!around.isWhole)
                    continue;
                ++looked.pixels;
                looked.plain += around.most - around.least < 0.1 ? 1 : 0;
                wrong += shade > around.most + kOff || shade < around.least - kOff ? 1 : 0;
            }
        fmt::print(
            "tau {}: promised {:.3f}, {} triangles, {} of {} pixels where colours hardly change\n",
            tauPixels, promised, drawn.statistics.triangles, looked.plain, looked.pixels);
        EXPECT_EQ(wrong, 0U) << "tau " << tauPixels;
        return looked;
    }
};

TEST_F(MeshColours, AreThoseOfTheSourceWithinThePromise) {
    scene_.objects = {import(checkedPlane(), "checks")};
    ASSERT_NO_FATAL_FAILURE(open());
    fabric::Camera camera;
    camera.target = {kCells / 2.0, kCells / 2.0, 0};
    camera.fovYDegrees = 40;
    std::size_t plain = 0;
    int coloursDecide = 0;  // the plane is flat, so places do nowhere
    for (const double away : {30.0, 150.0, 600.0, 2500.0, 12000.0})
        for (const double tau : {0.5, 1.0, 4.0}) {
            camera.eye = camera.target + away * glm::normalize(Vec3(0.3, -0.5, 0.8));
            const Looked looked = checkColours(camera, tau);
            EXPECT_GT(looked.pixels, 4U);
            plain += looked.plain;
            coloursDecide += looked.promised > 0.1 ? 1 : 0;
        }
    EXPECT_GT(plain, 200'000U);  // where a wrong colour would be seen
    EXPECT_GT(coloursDecide, 3);
}

}  // namespace
}  // namespace eyrie
