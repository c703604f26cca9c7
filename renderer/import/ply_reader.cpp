// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/ply_reader.h"

#include <string_view>
#include <utility>

#include <absl/status/status.h>
#include <fmt/format.h>

#include "fabric/status.h"
#include "renderer/import/ply_body.h"
#include "renderer/import/ply_faces.h"
#include "renderer/import/ply_header.h"
#include "renderer/import/ply_layout.h"
#include "renderer/import/ply_textures.h"
#include "renderer/import/ply_values.h"
#include "renderer/import/ply_vertices.h"
#include "renderer/mesh/mapped_file.h"

namespace eyrie::import {
namespace {

/// Reads a body's elements one after another.
template <typename Values>
class BodyReader {
public:
    BodyReader(const PlyHeader& header, std::string_view body, const ImportControl& control,
               const TakeUpTo& take, std::uint64_t memoryBytes)
        : layout_(header),
          isTextured_(layout_.isUsed() && !take),
          body_(header, body, control, take),
          vertices_(body_, isTextured_ && layout_.ofFaces == nullptr),
          faces_(body_, layout_, isTextured_, memoryBytes) {
        body_.mesh.notes = notesOf(header, isTextured_);
    }

    /// `path` is where the file would have its images.
    absl::StatusOr<TriangleMesh> read(const std::string& path);

private:
    absl::Status readElement(const PlyElement& element);
    absl::Status skipElement();
    void addNotes();

    const TextureLayout layout_;
    const bool isTextured_;
    PlyBody<Values> body_;
    PlyVertices<Values> vertices_;
    PlyFaces<Values> faces_;
};

template <typename Values>
absl::Status BodyReader<Values>::skipElement() {
    const PlyElement& element = body_.element();
    for (std::uint64_t i = 0; i < element.count; ++i) {
        RETURN_IF_ERROR(body_.begin(i));
        for (const PlyProperty& property : element.properties)
            RETURN_IF_ERROR(body_.skip(property, i));
    }
    return absl::OkStatus();
}

template <typename Values>
absl::Status BodyReader<Values>::readElement(const PlyElement& element) {
    body_.enter(element);
    if (element.properties.empty())
        return absl::OkStatus();  // no bytes, whatever its count
    if (element.name == "vertex")
        return vertices_.read();
    const bool isSurface = element.name == "face" || element.name == "tristrips";
    return isSurface ? faces_.read() : skipElement();
}

template <typename Values>
void BodyReader<Values>::addNotes() {
    vertices_.addNotes(isTextured_);
    if (!body_.values.atEnd())
        body_.mesh.notes.push_back(
            fmt::format("left out {} bytes behind what its header counts: if these are faces, "
                        "export it again",
                        body_.values.bytesLeft()));
}

template <typename Values>
absl::StatusOr<TriangleMesh> BodyReader<Values>::read(const std::string& path) {
    for (const PlyElement& element : body_.header().elements) RETURN_IF_ERROR(readElement(element));
    RETURN_IF_ERROR(faces_.finish(path));
    addNotes();
    RETURN_IF_ERROR(body_.handOver());
    if (body_.mesh.triangles.empty() && body_.handedOverTriangles() == 0)
        return absl::InvalidArgumentError(
            fmt::format("found no face with three corners or more ({} with fewer), expected at "
                        "least one; export the mesh again with its faces",
                        body_.mesh.droppedFaces));
    body_.control().report(PlyBody<Values>::kStage, 1);
    return std::move(body_.mesh);
}

absl::StatusOr<TriangleMesh> parse(std::string_view file, const std::string& path,
                                   const ImportControl& control, const TakeUpTo& take,
                                   std::uint64_t memoryBytes) {
    ASSIGN_OR_RETURN(const PlyHeader header, parsePlyHeader(file));
    RETURN_IF_ERROR(checkIsMesh(header));
    const std::string_view body = file.substr(header.bodyOffset);
    switch (header.encoding) {
        case PlyEncoding::Ascii:
            return BodyReader<AsciiValues>(header, body, control, take, memoryBytes).read(path);
        case PlyEncoding::LittleEndian:
            return BodyReader<BinaryValues<false>>(header, body, control, take, memoryBytes)
                .read(path);
        case PlyEncoding::BigEndian:
            return BodyReader<BinaryValues<true>>(header, body, control, take, memoryBytes)
                .read(path);
    }
    return absl::InternalError("unknown PLY encoding");
}

/// Triangles that the strips of a file may have: each corner in what other elements leave of it
/// makes one. Of text a corner takes two bytes or more.
std::uint64_t mostOfStrips(const PlyHeader& header, std::uint64_t fileBytes) {
    const PlyElement* const strips = header.find("tristrips");
    if (strips == nullptr)
        return 0;
    const PlyProperty* const corners = findCorners(*strips);
    if (header.encoding == PlyEncoding::Ascii || corners == nullptr)
        return (fileBytes - header.bodyOffset) / 2;
    std::uint64_t left = fileBytes - header.bodyOffset;
    for (const PlyElement& element : header.elements)
        left -= element.count * leastBytes(element, header.encoding);
    return left / sizeBytes(corners->type);
}

std::string_view textOf(const mesh::MappedFile& file) {
    const auto bytes = file.bytes();
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

}  // namespace

absl::StatusOr<TriangleMesh> parsePly(std::string_view file, const std::string& name,
                                      const ImportControl& control, std::uint64_t memoryBytes) {
    absl::StatusOr<TriangleMesh> mesh = parse(file, name, control, {}, memoryBytes);
    return mesh.ok() ? std::move(mesh) : fabric::withContext(mesh.status(), name);
}

absl::Status readPlyPieces(const std::string& path, const TakePiece& take,
                           const ImportControl& control) {
    ASSIGN_OR_RETURN(const mesh::MappedFile file, mesh::MappedFile::open(path));
    const std::string_view text = textOf(file);
    const auto takeUpTo = [&](TriangleMesh& piece, std::uint64_t offset) {
        file.forget(offset);  // the header before the body keeps this on the safe side
        return take(piece);
    };
    return fabric::withContext(parse(text, path, control, takeUpTo, 0).status(), path);
}

absl::StatusOr<PlySize> measurePly(const std::string& path) {
    ASSIGN_OR_RETURN(const mesh::MappedFile file, mesh::MappedFile::open(path));
    const absl::StatusOr<PlyHeader> header = parsePlyHeader(textOf(file));
    if (!header.ok())
        return fabric::withContext(header.status(), path);
    RETURN_IF_ERROR(fabric::withContext(checkIsMesh(*header), path));
    const PlyElement* const faces = header->find("face");
    const std::uint64_t bytes = file.bytes().size();
    const TextureLayout layout(*header);
    PlySize size{header->find("vertex")->count,
                 (faces != nullptr ? faces->count : 0) + mostOfStrips(*header, bytes), bytes,
                 layout.isUsed()};
    const bool isSplit = layout.isUsed() && layout.isByFace();
    size.splitVertices = std::max(size.vertices, isSplit ? 3 * size.faces : 0);
    return size;
}

std::vector<std::string> texturesOfPly(std::string_view file, const std::string& path) {
    const absl::StatusOr<PlyHeader> header = parsePlyHeader(file);
    return header.ok() ? textureNames(*header, path) : std::vector<std::string>();
}

absl::StatusOr<TriangleMesh> readPly(const std::string& path, const ImportControl& control) {
    ASSIGN_OR_RETURN(const mesh::MappedFile file, mesh::MappedFile::open(path));
    return parsePly(textOf(file), path, control);
}

}  // namespace eyrie::import
