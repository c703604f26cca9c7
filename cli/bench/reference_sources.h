// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <absl/status/statusor.h>

#include "fabric/scene.h"
#include "renderer/page/page_source.h"
#include "renderer/truth/placed_surfaces.h"
#include "renderer/truth/source_files.h"

/// The full-resolution sources that a scene's pictures are held against.
namespace eyrie::cli::bench {

/// One import of a scene, and what it was made of.
struct FoundSource {
    std::string imported;  ///< the .eyt or .eym
    fabric::ObjectKind kind = fabric::ObjectKind::Mesh;
    truth::MeshSides sides;  ///< as its object is drawn
    std::vector<std::string> files;
    std::uint64_t hash = 0;  ///< theirs, as the import keeps it

    bool isOf(const fabric::SceneObject& object) const {
        return imported == object.path && sides.isOneSided == object.singleSided;
    }
};

/// What a reference may take, and what of it is not the sources'.
struct ReferenceMemory {
    std::uint64_t limitBytes = 0;
    std::uint64_t framesBytes = 0;  ///< of the frames that are judged (neededBytes)
    std::string frames = {};        ///< these, as a person says it
};

/// Finds the source files of each of the scene's imports: those of `given` (of the names that the
/// import's record has, in their order where names repeat; or all of them or one where it has
/// none), or where the record says, or beside the import. Their hash must be the one that the
/// import keeps, and all of them together must not need more than `memory` leaves. Nothing is read
/// but for the hashes. One for each file, whichever objects show it, or two where some show one
/// side of it and some both.
///
/// Errors: NotFound (no file, nor a record), InvalidArgument (another hash), ResourceExhausted.
absl::StatusOr<std::vector<FoundSource>> findSources(const fabric::Scene& scene,
                                                     const std::vector<std::string>& given,
                                                     const ReferenceMemory& memory,
                                                     const page::SourceOptions& remote);

/// A scene's sources, read.
struct ReferenceScene {
    struct Object {
        truth::SourceSurface source;
        std::string imported;
        fabric::Mat4 worldFromObject{1.0};
    };
    std::vector<Object> objects;  ///< of the scene
    std::shared_ptr<const truth::PlacedSurfaces> surface;
};

/// Precondition: `found` is what findSources gave for it. Errors: those of readSource;
/// InvalidArgument (the files have changed since).
absl::StatusOr<ReferenceScene> readSources(const fabric::Scene& scene,
                                           const std::vector<FoundSource>& found);

}  // namespace eyrie::cli::bench
