// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <absl/status/status.h>

#include "fabric/box.h"
#include "fabric/ground.h"
#include "fabric/image.h"
#include "fabric/vec.h"

namespace eyrie::fabric {

enum class ObjectKind { Terrain, Mesh };

/// One data set in a scene.
struct SceneObject {
    std::string name;  ///< for people; not empty
    ObjectKind kind = ObjectKind::Mesh;
    std::string path;            ///< of the .eyt or .eym file
    Mat4 worldFromObject{1.0};   ///< affine; object space is the file's own, in metres
    Vec3 colour{0.8, 0.8, 0.8};  ///< linear; meshes without vertex colours only
    bool singleSided = false;    ///< triangles facing away are left out; meshes only
    /// Pictures to lay over a terrain that is still to be imported; an .eyt has its own.
    std::vector<std::string> imagery = {};

    bool operator==(const SceneObject&) const = default;
};

/// A light without distance: `direction` points from the light into the scene, world axes.
struct DirectionalLight {
    Vec3 direction{0.4, 0.5, -0.8};
    Vec3 colour{1, 1, 1};

    bool operator==(const DirectionalLight&) const = default;
};

inline constexpr double kLeastReachMetres = 1e-6;
inline constexpr double kMostReachMetres = 1e12;

/// What a spot shines into: all of its light up to the inner angle from the axis, none from the
/// outer one on, and between them the square of (cos a - cos outer) / (cos inner - cos outer) of
/// it, a being the angle (glTF, KHR_lights_punctual).
struct LightCone {
    Vec3 axis{0, 0, -1};       ///< from the light into the scene, world axes; not 0
    double innerDegrees = 0;   ///< from the axis; 0 to outerDegrees
    double outerDegrees = 45;  ///< more than 0, at most 90

    bool operator==(const LightCone&) const = default;
};

/// A light at a point of the world, shining all around unless it has a cone. At a distance d it is
/// colour / (1 + (d / reach)^2).
struct PointLight {
    Vec3 positionMetres{0, 0, 0};
    Vec3 colour{1, 1, 1};
    double reachMetres = 1;  ///< where half of it arrives; kLeast- to kMostReachMetres
    std::optional<LightCone> cone = {};

    bool operator==(const PointLight&) const = default;
};

/// Everything that is drawn: the init data of a session.
struct Scene {
    std::vector<SceneObject> objects;
    /// At most kMaxLights together; none of either kind means those of its files (fabric/lights.h)
    /// or, where these have none either, one at the camera.
    std::vector<DirectionalLight> lights;
    std::vector<PointLight> pointLights = {};
    double ambient = 0.25;  ///< 0 to 1
    Rgba background{38, 44, 54, 255};

    bool operator==(const Scene&) const = default;
};

inline constexpr int kMaxLights = 4;

/// InvalidArgument, naming the object and field, when a transform is beyond 1e14, not affine or
/// singular, a name or path is empty, or there are too many lights.
absl::Status validate(const Scene& scene);

/// Tells the contents of one .eyt or .eym file from another's: `checksum` is its header's, which
/// covers the index's, which covers those of all pages.
struct DataFile {
    std::uint64_t bytes = 0;
    std::uint64_t checksum = 0;

    bool operator==(const DataFile&) const = default;
};

/// What an object of a scene comes to.
struct ObjectInfo {
    Box bounds;                   ///< world space, metres, at true height
    std::uint64_t triangles = 0;  ///< at full resolution

    bool operator==(const ObjectInfo&) const = default;
};

/// What a renderer found in a scene.
struct SceneInfo {
    Box bounds;                   ///< world space, metres
    std::uint64_t triangles = 0;  ///< at full resolution
    std::uint64_t bytes = 0;      ///< of all files
    /// One for each terrain, at most kMaxGroundCells together; null where there is none.
    std::shared_ptr<const std::vector<GroundGrid>> ground = {};
    std::vector<DataFile> files = {};      ///< of each object of the scene
    std::vector<ObjectInfo> objects = {};  ///< likewise

    bool operator==(const SceneInfo& other) const {
        return bounds == other.bounds && triangles == other.triangles && bytes == other.bytes &&
               files == other.files && objects == other.objects &&
               (ground == other.ground || (ground && other.ground && *ground == *other.ground));
    }
};

}  // namespace eyrie::fabric
