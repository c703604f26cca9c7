// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include <absl/status/statusor.h>

#include "renderer/mesh/eym_format.h"

/// What must hold before any offset, count or child of an .eym file is followed. Messages name the
/// field but not the file.
namespace eyrie::mesh {

/// Magic, version, checksum, lattice, and that the tables lie inside a file of `fileBytes`
/// that begins with `beginning` (its header, or more). Errors: InvalidArgument (another
/// kind of file, another version), DataLoss.
absl::Status checkHeader(std::span<const std::byte> beginning, std::uint64_t fileBytes);

/// The tables of EymFile that materials have.
struct MaterialTables {
    std::span<const Material> materials;
    std::span<const ImageRecord> images;
    std::span<const MaterialRange> ranges;
};

/// That materials name images that there are, that images lie inside the file and have the length
/// of their shape, and that ranges make up each node that has geometry, and nothing else. Errors:
/// DataLoss. Preconditions: checkHeader and checkNodes are ok; the tables are as the header counts.
absl::Status checkMaterials(const EymHeader& header, std::span<const Node> nodes,
                            const MaterialTables& tables);

/// That each node of points has ranges, ascending, of which the last has all of it, and that there
/// are no others. Errors: DataLoss. Precondition: checkNodes is ok.
absl::Status checkPointRanges(std::span<const Node> nodes, std::span<const PointRange> ranges);

/// That they shine, from somewhere. Errors: DataLoss.
absl::Status checkLights(std::span<const Light> lights);

/// That those of lights at a place, and no others, are spots of a sound shape. Errors: DataLoss.
/// Precondition: none or as many as lights.
absl::Status checkCones(std::span<const Light> lights, std::span<const Cone> cones);

/// Bytes from the file's start to its first page.
std::uint64_t endOfTables(const EymHeader& header);

/// That the nodes form one binary tree, depth first and no deeper than kMaxTreeDepth, with boxes
/// and triangle ranges nested, and that their pages lie inside the file and hold no more than a
/// node may have. Returns the levels. Errors: DataLoss. Precondition: checkHeader is ok.
absl::StatusOr<int> checkNodes(const EymHeader& header, std::span<const Node> nodes);

/// That they have boxes on the lattice. Errors: DataLoss.
absl::Status checkLids(std::span<const Lid> lids);

}  // namespace eyrie::mesh
