// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/ply_reader.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include <absl/status/status.h>
#include <fmt/format.h>

#include "fabric/status.h"
#include "renderer/import/byte_colours.h"
#include "renderer/import/ply_header.h"
#include "renderer/import/ply_layout.h"
#include "renderer/import/ply_textures.h"
#include "renderer/import/ply_values.h"
#include "renderer/import/polygon.h"
#include "renderer/mesh/mapped_file.h"

namespace eyrie::import {
namespace {

using Corners = std::array<std::uint32_t, 3>;

constexpr std::uint64_t kPollInterval = 65536;  // elements between looks at the stop token
constexpr std::uint64_t kPiece = 65536;  // vertices or triangles that are handed over at once
constexpr std::string_view kStage = "reading";
constexpr std::array<std::string_view, 3> kAxisNames = {"x", "y", "z"};

/// Takes a piece that ends so many bytes from the start of the body.
using TakeUpTo = std::function<absl::Status(TriangleMesh& piece, std::uint64_t offset)>;

/// Reads a body from text (AsciiValues) or binary (BinaryValues); with `take` piece by piece.
template <typename Values>
class BodyReader {
public:
    BodyReader(const PlyHeader& header, std::string_view body, const ImportControl& control,
               const TakeUpTo& take = {})
        : header_(header),
          values_(body),
          bodyBytes_(body.size()),
          control_(control),
          take_(take),
          vertexCount_(header.find("vertex")->count),
          layout_(header),
          textures_(layout_),
          isTextured_(layout_.isUsed() && !take_) {
        mesh_.notes = notesOf(header, isTextured_);
    }

    /// `path` is where the file would have its images.
    absl::StatusOr<TriangleMesh> read(const std::string& path);

private:
    /// A face of more than three corners waits until all vertices are known.
    struct Polygon {
        std::uint64_t face;
        std::size_t firstCorner;
        std::size_t cornerCount;
    };
    /// The last two corners of a strip and the turn its next triangle has.
    struct Strip {
        std::array<std::uint32_t, 2> last{};
        std::uint64_t corners = 0;
    };

    absl::Status readElement(const PlyElement& element);
    absl::Status lookForBytes(const VertexLayout& layout);
    absl::Status readVertices();
    absl::Status storeVertex(const VertexLayout& layout, const VertexRow& row, std::uint64_t index);
    absl::Status readList(const PlyProperty& property, std::uint64_t index);
    absl::Status readFace(const PlyProperty& property, std::uint64_t index, std::uint64_t count);
    absl::Status readStrip(const PlyProperty& property, std::uint64_t index, std::uint64_t count);
    void extend(Strip& strip, std::uint32_t corner);
    absl::Status readTexturedFaces();
    absl::Status readTexturedFace(const PlyProperty* corners, std::uint64_t index);
    absl::Status readPlaces(std::uint64_t index);
    absl::Status readCount(const PlyProperty& property, std::uint64_t index, std::uint64_t& count);
    absl::Status skip(const PlyProperty& property, std::uint64_t index);
    absl::Status triangulatePolygons();
    void addNotes();
    absl::Status handOver();
    std::uint64_t roomFor(std::uint64_t count) const {
        return take_ ? std::min(count, 2 * kPiece) : count;
    }
    absl::Status begin(std::uint64_t index);
    absl::Status poll(std::uint64_t index);

    absl::Status unreadable(std::string_view property, std::uint64_t index) const;
    absl::Status wrong(std::string_view property, std::uint64_t index, const std::string& found,
                       const std::string& expected, std::string_view remedy) const;
    absl::Status wrongCorner(std::uint64_t index, std::uint64_t corner, std::int64_t found) const;
    std::string place(std::string_view property, std::uint64_t index) const;

    const PlyHeader& header_;
    Values values_;
    std::uint64_t bodyBytes_;
    const ImportControl& control_;
    const TakeUpTo take_;
    std::uint64_t vertexCount_;
    const PlyElement* element_ = nullptr;  // being read
    std::uint64_t startOffset_ = 0;        // where the one being read starts in the body
    TriangleMesh mesh_;
    std::uint64_t handedOver_ = 0;  // triangles
    bool coloursAreBytes_ = false;  // those of real numbers
    std::uint64_t notOpaque_ = 0;   // vertices
    std::vector<Polygon> polygons_;
    std::vector<std::uint32_t> polygonCorners_;
    const TextureLayout layout_;
    PlyTextures textures_;
    const bool isTextured_;
    std::vector<double> places_;  // of the face being read
};

template <typename Values>
std::string BodyReader<Values>::place(std::string_view property, std::uint64_t index) const {
    std::string where = fmt::format("{} {}, {}", element_->name, index, property);
    if constexpr (std::is_same_v<Values, AsciiValues>)
        return where + fmt::format(" (line {})", header_.lines + values_.line(startOffset_));
    else
        return where + fmt::format(" (byte {})", header_.bodyOffset + startOffset_);
}

template <typename Values>
absl::Status BodyReader<Values>::wrong(std::string_view property, std::uint64_t index,
                                       const std::string& found, const std::string& expected,
                                       std::string_view remedy) const {
    return absl::InvalidArgumentError(fmt::format("{}: found {}, expected {}; {}",
                                                  place(property, index), found, expected, remedy));
}

/// For a value that is not there, or no number.
template <typename Values>
absl::Status BodyReader<Values>::unreadable(std::string_view property, std::uint64_t index) const {
    if constexpr (std::is_same_v<Values, AsciiValues>) {
        if (!values_.atEnd()) {
            std::string word(values_.nextWord().substr(0, 40));
            std::replace_if(
                word.begin(), word.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
            return wrong(property, index, fmt::format("'{}'", word), "a number of its type",
                         "repair the line or export the mesh again");
        }
    }
    return wrong(property, index, "the end of the file",
                 fmt::format("{} elements {}", element_->count, element_->name),
                 "the file is truncated: copy or export it again");
}

template <typename Values>
absl::Status BodyReader<Values>::wrongCorner(std::uint64_t index, std::uint64_t corner,
                                             std::int64_t found) const {
    return wrong(fmt::format("{}[{}]", findCorners(*element_)->name, corner), index,
                 fmt::format("{}", found), fmt::format("a vertex from 0 to {}", vertexCount_ - 1),
                 "repair the face or export the mesh again");
}

template <typename Values>
absl::Status BodyReader<Values>::begin(std::uint64_t index) {
    startOffset_ = values_.offset();
    return poll(index);
}

/// What was read, to whoever takes it piece by piece.
template <typename Values>
absl::Status BodyReader<Values>::handOver() {
    if (!take_)
        return absl::OkStatus();
    handedOver_ += mesh_.triangles.size();
    RETURN_IF_ERROR(take_(mesh_, values_.offset()));
    mesh_.positions.clear();
    mesh_.normals.clear();
    mesh_.colours.clear();
    mesh_.triangles.clear();
    return absl::OkStatus();
}

template <typename Values>
absl::Status BodyReader<Values>::poll(std::uint64_t index) {
    if (index % kPiece == 0)
        RETURN_IF_ERROR(handOver());
    if (index % kPollInterval != 0)
        return absl::OkStatus();
    if (bodyBytes_ != 0)
        control_.report(kStage,
                        static_cast<double>(values_.offset()) / static_cast<double>(bodyBytes_));
    return control_.check();
}

template <typename Values>
absl::Status BodyReader<Values>::readCount(const PlyProperty& property, std::uint64_t index,
                                           std::uint64_t& count) {
    std::int64_t found = 0;
    if (!values_.integer(*property.countType, found))
        return unreadable(fmt::format("count of {}", property.name), index);
    if (found < 0 || !values_.mayHold(property.type, static_cast<std::uint64_t>(found)))
        return wrong(fmt::format("count of {}", property.name), index, fmt::format("{}", found),
                     fmt::format("a list that fits the {} bytes left", values_.bytesLeft()),
                     "the file is truncated or damaged: copy or export it again");
    count = static_cast<std::uint64_t>(found);
    return absl::OkStatus();
}

template <typename Values>
absl::Status BodyReader<Values>::skip(const PlyProperty& property, std::uint64_t index) {
    std::uint64_t count = 1;
    if (property.isList())
        RETURN_IF_ERROR(readCount(property, index, count));
    return values_.skip(property.type, count) ? absl::OkStatus() : unreadable(property.name, index);
}

template <typename Values>
absl::Status BodyReader<Values>::storeVertex(const VertexLayout& layout, const VertexRow& row,
                                             std::uint64_t index) {
    for (std::size_t axis = 0; axis < 3; ++axis)
        if (!std::isfinite(row[axis]))
            return wrong(kAxisNames[axis], index, fmt::format("{}", row[axis]),
                         "a finite coordinate", "remove or repair the vertex");
    mesh_.positions.emplace_back(row[0], row[1], row[2]);
    if (layout.hasThree(kNormalX))
        mesh_.normals.emplace_back(static_cast<float>(row[3]), static_cast<float>(row[4]),
                                   static_cast<float>(row[5]));
    if (layout.hasThree(kRed)) {
        const auto byteOf = [&](std::size_t slot) {
            return colourByte(row[slot], layout.types[slot], coloursAreBytes_);
        };
        const std::uint8_t opacity = layout.isFilled[kAlpha]
                                         ? opacityByte(row[kAlpha], layout.types[kAlpha])
                                         : std::uint8_t{255};
        mesh_.colours.push_back({byteOf(kRed), byteOf(kRed + 1), byteOf(kRed + 2), opacity});
        notOpaque_ += opacity < 255 ? 1 : 0;
    }
    if (layout.hasPlaces())
        mesh_.textureCoordinates.push_back(placeFrom(row[kU], row[kV]));
    return absl::OkStatus();
}

/// Reads ahead, as the first colours need not tell. What cannot be read is told by readVertices().
template <typename Values>
absl::Status BodyReader<Values>::lookForBytes(const VertexLayout& layout) {
    const Values start = values_;
    bool canBeRead = true;
    for (std::uint64_t i = 0; i < element_->count && canBeRead && !coloursAreBytes_; ++i) {
        if (i % kPiece == 0) {
            RETURN_IF_ERROR(handOver());
            RETURN_IF_ERROR(control_.check());
        }
        for (std::size_t p = 0; p < layout.slots.size() && canBeRead; ++p) {
            const PlyProperty& property = element_->properties[p];
            const std::size_t slot = layout.slots[p];
            const bool isColour = slot >= kRed && slot < kAlpha && layout.isReal(slot);
            double value = 0;
            canBeRead = isColour ? values_.number(property.type, value) : skip(property, i).ok();
            coloursAreBytes_ = coloursAreBytes_ || value > kMostOfFractions;
        }
    }
    values_ = start;
    return absl::OkStatus();
}

template <typename Values>
absl::Status BodyReader<Values>::readVertices() {
    const VertexLayout layout(*element_, isTextured_ && layout_.ofFaces == nullptr);
    const std::uint64_t room = roomFor(vertexCount_);
    mesh_.positions.reserve(room);
    mesh_.normals.reserve(layout.hasThree(kNormalX) ? room : 0);
    mesh_.colours.reserve(layout.hasThree(kRed) ? room : 0);
    mesh_.textureCoordinates.reserve(layout.hasPlaces() ? room : 0);
    if (layout.hasRealColours())
        RETURN_IF_ERROR(lookForBytes(layout));
    VertexRow row{};
    for (std::uint64_t i = 0; i < element_->count; ++i) {
        RETURN_IF_ERROR(begin(i));
        for (std::size_t p = 0; p < layout.slots.size(); ++p) {
            const PlyProperty& property = element_->properties[p];
            const std::size_t slot = layout.slots[p];
            if (slot == kIgnored)
                RETURN_IF_ERROR(skip(property, i));
            else if (!values_.number(property.type, row[slot]))
                return unreadable(property.name, i);
        }
        RETURN_IF_ERROR(storeVertex(layout, row, i));
    }
    return absl::OkStatus();
}

template <typename Values>
absl::Status BodyReader<Values>::readFace(const PlyProperty& property, std::uint64_t index,
                                          std::uint64_t count) {
    if (count < 3) {
        ++mesh_.droppedFaces;
        return values_.skip(property.type, count) ? absl::OkStatus()
                                                  : unreadable(property.name, index);
    }
    Corners triangle{};
    if (count > 3 && take_)
        return wrong(fmt::format("count of {}", property.name), index, fmt::format("{}", count),
                     "triangles of a mesh that does not fit the memory it may have",
                     "triangulate it before export, or allow more memory");
    if (count > 3)
        polygons_.push_back({index, polygonCorners_.size(), count});
    for (std::uint64_t i = 0; i < count; ++i) {
        std::int64_t corner = 0;
        if (!values_.integer(property.type, corner))
            return unreadable(property.name, index);
        if (static_cast<std::uint64_t>(corner) >= vertexCount_)
            return wrongCorner(index, i, corner);
        if (count == 3)
            triangle[i] = static_cast<std::uint32_t>(corner);
        else
            polygonCorners_.push_back(static_cast<std::uint32_t>(corner));
    }
    if (count == 3)
        mesh_.triangles.push_back(triangle);
    return absl::OkStatus();
}

template <typename Values>
void BodyReader<Values>::extend(Strip& strip, std::uint32_t corner) {
    if (strip.corners >= 2) {
        const bool isTurned = strip.corners % 2 != 0;
        mesh_.triangles.push_back(
            {strip.last[isTurned ? 1 : 0], strip.last[isTurned ? 0 : 1], corner});
    }
    strip.last = {strip.last[1], corner};
    ++strip.corners;
}

template <typename Values>
absl::Status BodyReader<Values>::readStrip(const PlyProperty& property, std::uint64_t index,
                                           std::uint64_t count) {
    Strip strip;
    for (std::uint64_t i = 0; i < count; ++i) {
        RETURN_IF_ERROR(poll(i));
        std::int64_t corner = 0;
        if (!values_.integer(property.type, corner))
            return unreadable(property.name, index);
        if (corner == -1)
            strip = {};
        else if (static_cast<std::uint64_t>(corner) >= vertexCount_)
            return wrongCorner(index, i, corner);
        else
            extend(strip, static_cast<std::uint32_t>(corner));
    }
    return absl::OkStatus();
}

template <typename Values>
absl::Status BodyReader<Values>::readList(const PlyProperty& property, std::uint64_t index) {
    std::uint64_t count = 0;
    RETURN_IF_ERROR(readCount(property, index, count));
    return element_->name == "face" ? readFace(property, index, count)
                                    : readStrip(property, index, count);
}

template <typename Values>
absl::Status BodyReader<Values>::readPlaces(std::uint64_t index) {
    const PlyProperty& property = *layout_.ofFaces;
    std::uint64_t count = 0;
    RETURN_IF_ERROR(readCount(property, index, count));
    places_.resize(count);
    for (double& place : places_)
        if (!values_.number(property.type, place))
            return unreadable(property.name, index);
    return absl::OkStatus();
}

template <typename Values>
absl::Status BodyReader<Values>::readTexturedFace(const PlyProperty* corners, std::uint64_t index) {
    const std::size_t triangles = mesh_.triangles.size();
    const std::size_t cornersBefore = polygonCorners_.size();
    double number = 0;
    places_.clear();
    for (const PlyProperty& property : element_->properties) {
        if (&property == corners)
            RETURN_IF_ERROR(readList(property, index));
        else if (&property == layout_.ofFaces)
            RETURN_IF_ERROR(readPlaces(index));
        else if (&property != layout_.number)
            RETURN_IF_ERROR(skip(property, index));
        else if (!values_.number(property.type, number))
            return unreadable(property.name, index);
    }
    const std::size_t count = mesh_.triangles.size() > triangles
                                  ? std::tuple_size_v<Corners>
                                  : polygonCorners_.size() - cornersBefore;
    textures_.addFace(index, count, places_, number, triangles);
    return absl::OkStatus();
}

template <typename Values>
absl::Status BodyReader<Values>::readTexturedFaces() {
    const PlyProperty* const corners = findCorners(*element_);
    for (std::uint64_t i = 0; i < element_->count; ++i) {
        RETURN_IF_ERROR(begin(i));
        RETURN_IF_ERROR(readTexturedFace(corners, i));
    }
    return absl::OkStatus();
}

template <typename Values>
absl::Status BodyReader<Values>::readElement(const PlyElement& element) {
    element_ = &element;
    if (element.properties.empty())
        return absl::OkStatus();  // no bytes, whatever its count
    if (element.name == "vertex")
        return readVertices();
    const bool isSurface = element.name == "face" || element.name == "tristrips";
    const PlyProperty* corners = isSurface ? findCorners(element) : nullptr;
    if (element.name == "face")
        mesh_.triangles.reserve(roomFor(std::min(element.count, values_.bytesLeft() / 4)));
    if (element.name == "face" && isTextured_ && layout_.isByFace())
        return readTexturedFaces();
    for (std::uint64_t i = 0; i < element.count; ++i) {
        RETURN_IF_ERROR(begin(i));
        for (const PlyProperty& property : element.properties)
            RETURN_IF_ERROR(&property == corners ? readList(property, i) : skip(property, i));
    }
    return absl::OkStatus();
}

template <typename Values>
absl::Status BodyReader<Values>::triangulatePolygons() {
    element_ = header_.find("face");
    for (const Polygon& polygon : polygons_) {
        RETURN_IF_ERROR(control_.check());
        const std::span<const std::uint32_t> corners =
            std::span(polygonCorners_).subspan(polygon.firstCorner, polygon.cornerCount);
        if (!triangulatePolygon(mesh_.positions, corners, mesh_.triangles))
            return absl::InvalidArgumentError(fmt::format(
                "face {}: found a concave polygon of {} corners, expected at most {}; triangulate "
                "it before export",
                polygon.face, corners.size(), kMaxConcaveCorners));
    }
    return absl::OkStatus();
}

template <typename Values>
void BodyReader<Values>::addNotes() {
    if (coloursAreBytes_)
        mesh_.notes.emplace_back(kColoursAreBytes);
    if (notOpaque_ > 0)
        mesh_.notes.push_back(fmt::format(
            "{} vertices are not opaque, which is left out{}: for see-through surfaces export it "
            "as glTF",
            notOpaque_, isTextured_ ? " where no texture is see-through" : ""));
    if (!values_.atEnd())
        mesh_.notes.push_back(
            fmt::format("left out {} bytes behind what its header counts: if these are faces, "
                        "export it again",
                        values_.bytesLeft()));
}

template <typename Values>
absl::StatusOr<TriangleMesh> BodyReader<Values>::read(const std::string& path) {
    for (const PlyElement& element : header_.elements) RETURN_IF_ERROR(readElement(element));
    if (isTextured_)
        RETURN_IF_ERROR(textures_.applyTo(mesh_, polygonCorners_, textureNames(header_, path)));
    RETURN_IF_ERROR(triangulatePolygons());
    addNotes();
    RETURN_IF_ERROR(handOver());
    if (mesh_.triangles.empty() && handedOver_ == 0)
        return absl::InvalidArgumentError(
            fmt::format("found no face with three corners or more ({} with fewer), expected at "
                        "least one; export the mesh again with its faces",
                        mesh_.droppedFaces));
    control_.report(kStage, 1);
    return std::move(mesh_);
}

absl::StatusOr<TriangleMesh> parse(std::string_view file, const std::string& path,
                                   const ImportControl& control, const TakeUpTo& take = {}) {
    ASSIGN_OR_RETURN(const PlyHeader header, parsePlyHeader(file));
    RETURN_IF_ERROR(checkIsMesh(header));
    const std::string_view body = file.substr(header.bodyOffset);
    switch (header.encoding) {
        case PlyEncoding::Ascii:
            return BodyReader<AsciiValues>(header, body, control, take).read(path);
        case PlyEncoding::LittleEndian:
            return BodyReader<BinaryValues<false>>(header, body, control, take).read(path);
        case PlyEncoding::BigEndian:
            return BodyReader<BinaryValues<true>>(header, body, control, take).read(path);
    }
    return absl::InternalError("unknown PLY encoding");
}

std::string_view textOf(const mesh::MappedFile& file) {
    const auto bytes = file.bytes();
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

}  // namespace

absl::StatusOr<TriangleMesh> parsePly(std::string_view file, const std::string& name,
                                      const ImportControl& control) {
    absl::StatusOr<TriangleMesh> mesh = parse(file, name, control);
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
    return fabric::withContext(parse(text, path, control, takeUpTo).status(), path);
}

absl::StatusOr<PlySize> measurePly(const std::string& path) {
    ASSIGN_OR_RETURN(const mesh::MappedFile file, mesh::MappedFile::open(path));
    const absl::StatusOr<PlyHeader> header = parsePlyHeader(textOf(file));
    if (!header.ok())
        return fabric::withContext(header.status(), path);
    RETURN_IF_ERROR(fabric::withContext(checkIsMesh(*header), path));
    const PlyElement* const faces = header->find("face");
    const std::uint64_t bytes = file.bytes().size();
    // A strip's corner takes two bytes or more, and makes one triangle.
    return PlySize{header->find("vertex")->count,
                   (faces != nullptr ? faces->count : 0) +
                       (header->find("tristrips") != nullptr ? bytes / 2 : 0),
                   bytes, TextureLayout(*header).isUsed()};
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
