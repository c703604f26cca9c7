// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <absl/status/statusor.h>

#include "fabric/scene.h"
#include "renderer/truth/mesh_ray_caster.h"
#include "renderer/truth/terrain_ray_caster.h"

/// Sources of an import, read again for the truth: by the importers' readers, which give posts and
/// triangles as they are in the files, and never from what was imported.
namespace eyrie::truth {

/// What is known of a source before all of it is read.
struct SourceFacts {
    std::uint64_t hash = 0;         ///< as an import of it has it
    std::uint64_t neededBytes = 0;  ///< of memory, about: while it is read, or then
};

/// Hashes the files' bytes and reads their headers. Where a header does not say how many triangles
/// there are, eight times the files' size stands for what they need. Errors: those of openDems,
/// meshSourceHash and measurePly.
absl::StatusOr<SourceFacts> inspectSource(fabric::ObjectKind kind,
                                          const std::vector<std::string>& paths);

/// One of the two, as the kind is.
struct SourceSurface {
    std::shared_ptr<const TerrainRayCaster> terrain;
    std::shared_ptr<const MeshRayCaster> mesh;
    std::uint64_t hash = 0;  ///< SourceFacts::hash, when it was read

    std::shared_ptr<const ReferenceSurface> surface() const {
        return terrain ? std::shared_ptr<const ReferenceSurface>(terrain) : mesh;
    }
};

/// From where a mesh's triangles are drawn.
struct MeshSides {
    bool isOneSided = false;  ///< from their fronts only, but where their material has two sides
    /// The import wound some the other way round: the source does not tell what is their front, and
    /// those of one side may be seen through.
    bool areTurned = false;

    bool operator==(const MeshSides&) const = default;
};

/// Reads all of it. Errors: those of openDems and readMeshes; InvalidArgument (no triangles, no
/// post with data).
absl::StatusOr<SourceSurface> readSource(fabric::ObjectKind kind,
                                         const std::vector<std::string>& paths,
                                         const MeshSides& sides = {});

}  // namespace eyrie::truth
