// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <absl/status/statusor.h>

/// The header of a PLY file: G. Turk, "The PLY Polygon File Format", 1994.
namespace eyrie::import {

enum class PlyEncoding { Ascii, LittleEndian, BigEndian };

enum class PlyType { Int8, UInt8, Int16, UInt16, Int32, UInt32, Float32, Float64 };

std::size_t sizeBytes(PlyType type);
bool isInteger(PlyType type);

/// A scalar of `type`, or with `countType` a list of them.
struct PlyProperty {
    std::string name;
    PlyType type = PlyType::Float32;
    std::optional<PlyType> countType;

    bool isList() const { return countType.has_value(); }
    bool operator==(const PlyProperty&) const = default;
};

struct PlyElement {
    std::string name;
    std::uint64_t count = 0;
    std::vector<PlyProperty> properties;

    const PlyProperty* find(std::string_view propertyName) const;  ///< null if there is none
    bool operator==(const PlyElement&) const = default;
};

/// Fewest bytes one of an element takes: in text, a digit and a separator a value.
std::uint64_t leastBytes(const PlyElement& element, PlyEncoding encoding);

struct PlyHeader {
    PlyEncoding encoding = PlyEncoding::Ascii;
    std::vector<PlyElement> elements;       ///< in the order of the body
    std::vector<std::string> textureFiles;  ///< named by comments, as MeshLab does, in order
    std::size_t bodyOffset = 0;             ///< of the first byte after the header
    std::uint64_t lines = 0;                ///< of the header, end_header included

    const PlyElement* find(std::string_view elementName) const;  ///< null if there is none
};

/// Reads the header at the start of `file` and checks that the counts it declares can fit into the
/// rest of the file, so that they may be trusted as sizes of memory.
/// InvalidArgument says line, field, what was found and expected; it does not name the file.
absl::StatusOr<PlyHeader> parsePlyHeader(std::string_view file);

}  // namespace eyrie::import
