// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include <absl/status/statusor.h>

#include "fabric/pick.h"
#include "fabric/scene.h"
#include "renderer/import/mesh_import.h"
#include "renderer/pick/picker.h"
#include "renderer/terrain/height_grid.h"
#include "renderer/truth/reference_surface.h"
#include "tests/renderer/lod/wall.h"
#include "tests/support/temporary_folder.h"

namespace eyrie::test {

/// What picks of one kind of view came to.
struct PickTally {
    int picked = 0;
    int missed = 0;               ///< the source, too
    int slipped = 0;              ///< nothing picked, though the source is met
    int mayBeMissed = 0;          ///< picked, but the source may be missed
    std::vector<double> spreads;  ///< farthest - nearest, in pixels' widths

    double medianSpread() {
        std::ranges::sort(spreads);
        return spreads.empty() ? 0 : spreads[spreads.size() / 2];
    }
};

/// An object and its source: what is picked of the one is held against double-precision rays at the
/// other.
class PickPair {
public:
    static constexpr int kWidth = 1280;
    static constexpr int kHeight = 720;

    PickPair(std::shared_ptr<const pick::Picker> picker,
             std::unique_ptr<truth::ReferenceSurface> source, double exaggeration = 1);

    absl::StatusOr<fabric::Picked> pick(const fabric::Camera& camera,
                                        const fabric::Vec2& place) const;

    /// Holds the answer for one place against the truth.
    void hold(const fabric::Camera& camera, const fabric::Vec2& place, PickTally& tally) const;

    /// The same through a wall, both in the camera's axes: the judge looks through its corners.
    void holdThrough(const Wall& wall, const fabric::Vec3& eye, const fabric::Camera& camera,
                     const fabric::Vec2& place, PickTally& tally) const;

    /// Of those readings that there are, one is within the error.
    void holdNearest(const fabric::PickedPoint& point) const;

private:
    void holdPoint(const fabric::PickedPoint& point, double first, double last,
                   PickTally& tally) const;
    void holdError(const fabric::PickedPoint& point, double rounding) const;

    std::shared_ptr<const pick::Picker> picker_;
    std::unique_ptr<truth::ReferenceSurface> source_;
    double exaggeration_;
};

/// Of this object alone. Fails the test, and returns null, on errors.
std::shared_ptr<const pick::Picker> openPicker(const fabric::SceneObject& object);

/// `grid`, imported into `folder`, and its posts.
PickPair terrainPair(const TemporaryFolder& folder, const terrain::HeightGrid& grid,
                     double exaggeration = 1);

/// `mesh`, imported into `folder`, and its triangles.
PickPair meshPair(const TemporaryFolder& folder, import::TriangleMesh mesh,
                  const fabric::Mat4& worldFromObject,
                  const import::MeshImportOptions& options = {});

/// Places all over what a sphere covers of the picture.
std::vector<fabric::Vec2> placesAround(const fabric::Camera& camera, const fabric::Vec3& centre,
                                       double radius, int count, std::mt19937& engine);

struct NamedCamera {
    std::string name;
    fabric::Camera camera;
};

/// At 1 m, 1 km and 1,000 km from a point of ground, and almost level over it.
std::vector<NamedCamera> camerasOver(const fabric::Vec3& ground);

}  // namespace eyrie::test
