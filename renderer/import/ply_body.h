// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <type_traits>

#include <absl/status/status.h>
#include <fmt/format.h>

#include "fabric/status.h"
#include "renderer/import/ply_header.h"
#include "renderer/import/ply_layout.h"
#include "renderer/import/ply_values.h"
#include "renderer/import/progress.h"
#include "renderer/import/triangle_mesh.h"

namespace eyrie::import {

/// Takes a piece that ends so many bytes from the start of the body.
using TakeUpTo = std::function<absl::Status(TriangleMesh& piece, std::uint64_t offset)>;

/// What the readers of a PLY file's elements share: the values of its body, one after another, of
/// text (AsciiValues) or binary (BinaryValues); the mesh that they make of these, which with `take`
/// is handed over piece by piece; and errors that say where in the file something is wrong.
template <typename Values>
class PlyBody {
public:
    static constexpr std::string_view kStage = "reading";

    /// All but `bytes` outlive this.
    PlyBody(const PlyHeader& header, std::string_view bytes, const ImportControl& control,
            const TakeUpTo& take)
        : values(bytes),
          header_(header),
          bytes_(bytes.size()),
          control_(control),
          take_(take),
          vertexCount_(header.find("vertex")->count) {}

    const PlyHeader& header() const { return header_; }
    const ImportControl& control() const { return control_; }
    std::uint64_t vertexCount() const { return vertexCount_; }
    bool isPiecewise() const { return static_cast<bool>(take_); }
    std::uint64_t handedOverTriangles() const { return handedOver_; }
    std::uint64_t roomFor(std::uint64_t count) const {
        return take_ ? std::min(count, 2 * kPiece) : count;
    }

    /// The one whose values come next; enter() comes before anything of it is read.
    const PlyElement& element() const { return *element_; }
    void enter(const PlyElement& element) { element_ = &element; }

    /// Before the values of one of the element.
    absl::Status begin(std::uint64_t index) {
        startOffset_ = values.offset();
        return poll(index);
    }
    /// Hands over, reports and looks whether it ought to stop, once in so many calls.
    absl::Status poll(std::uint64_t index) {
        return index % kPiece == 0 ? pause() : absl::OkStatus();
    }
    /// What was read, to whoever takes it piece by piece.
    absl::Status handOver();

    absl::Status readCount(const PlyProperty& property, std::uint64_t index, std::uint64_t& count);
    absl::Status skip(const PlyProperty& property, std::uint64_t index);

    /// For a value that is not there, or no number.
    absl::Status unreadable(std::string_view property, std::uint64_t index) const;
    absl::Status wrong(std::string_view property, std::uint64_t index, const std::string& found,
                       const std::string& expected, std::string_view remedy) const;
    absl::Status wrongCorner(std::uint64_t index, std::uint64_t corner, std::int64_t found) const;

    static constexpr std::uint64_t kPiece = 65536;  ///< vertices or triangles, handed over at once

    Values values;
    TriangleMesh mesh;

private:
    absl::Status pause();
    std::string place(std::string_view property, std::uint64_t index) const;

    const PlyHeader& header_;
    std::uint64_t bytes_;
    const ImportControl& control_;
    const TakeUpTo& take_;
    std::uint64_t vertexCount_;
    const PlyElement* element_ = nullptr;
    std::uint64_t startOffset_ = 0;  ///< where the one being read starts in the body
    std::uint64_t handedOver_ = 0;   ///< triangles
};

template <typename Values>
std::string PlyBody<Values>::place(std::string_view property, std::uint64_t index) const {
    std::string where = fmt::format("{} {}, {}", element_->name, index, property);
    if constexpr (std::is_same_v<Values, AsciiValues>)
        return where + fmt::format(" (line {})", header_.lines + values.line(startOffset_));
    else
        return where + fmt::format(" (byte {})", header_.bodyOffset + startOffset_);
}

template <typename Values>
absl::Status PlyBody<Values>::wrong(std::string_view property, std::uint64_t index,
                                    const std::string& found, const std::string& expected,
                                    std::string_view remedy) const {
    return absl::InvalidArgumentError(fmt::format("{}: found {}, expected {}; {}",
                                                  place(property, index), found, expected, remedy));
}

template <typename Values>
absl::Status PlyBody<Values>::unreadable(std::string_view property, std::uint64_t index) const {
    if constexpr (std::is_same_v<Values, AsciiValues>) {
        if (!values.atEnd()) {
            std::string word(values.nextWord().substr(0, 40));
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
absl::Status PlyBody<Values>::wrongCorner(std::uint64_t index, std::uint64_t corner,
                                          std::int64_t found) const {
    return wrong(fmt::format("{}[{}]", findCorners(*element_)->name, corner), index,
                 fmt::format("{}", found), fmt::format("a vertex from 0 to {}", vertexCount_ - 1),
                 "repair the face or export the mesh again");
}

template <typename Values>
absl::Status PlyBody<Values>::handOver() {
    if (!take_)
        return absl::OkStatus();
    handedOver_ += mesh.triangles.size();
    RETURN_IF_ERROR(take_(mesh, values.offset()));
    mesh.positions.clear();
    mesh.normals.clear();
    mesh.colours.clear();
    mesh.triangles.clear();
    return absl::OkStatus();
}

template <typename Values>
absl::Status PlyBody<Values>::pause() {
    RETURN_IF_ERROR(handOver());
    if (bytes_ != 0)
        control_.report(kStage, static_cast<double>(values.offset()) / static_cast<double>(bytes_));
    return control_.check();
}

template <typename Values>
absl::Status PlyBody<Values>::readCount(const PlyProperty& property, std::uint64_t index,
                                        std::uint64_t& count) {
    std::int64_t found = 0;
    if (!values.integer(*property.countType, found))
        return unreadable(fmt::format("count of {}", property.name), index);
    if (found < 0 || !values.mayHold(property.type, static_cast<std::uint64_t>(found)))
        return wrong(fmt::format("count of {}", property.name), index, fmt::format("{}", found),
                     fmt::format("a list that fits the {} bytes left", values.bytesLeft()),
                     "the file is truncated or damaged: copy or export it again");
    count = static_cast<std::uint64_t>(found);
    return absl::OkStatus();
}

template <typename Values>
absl::Status PlyBody<Values>::skip(const PlyProperty& property, std::uint64_t index) {
    std::uint64_t count = 1;
    if (property.isList())
        RETURN_IF_ERROR(readCount(property, index, count));
    return values.skip(property.type, count) ? absl::OkStatus() : unreadable(property.name, index);
}

}  // namespace eyrie::import
