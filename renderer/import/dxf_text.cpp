// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/dxf_text.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstddef>
#include <cstdint>
#include <map>
#include <set>

#include <fmt/format.h>
#include <glm/vec3.hpp>

#include "renderer/import/dxf_colours.h"
#include "renderer/import/dxf_records.h"
#include "renderer/import/mended_text.h"

namespace eyrie::import {
namespace {

/// Of all that a file inserts in rows and columns; a few numbers may ask for a thousand million.
constexpr double kMostCopies = 65536;
/// In bytes, the format's own: each copy has it.
constexpr std::size_t kLongestName = 255;

bool isRead(std::string_view kind) {
    constexpr std::array<std::string_view, 10> kKinds = {"BLOCK",  "ENDBLK", "INSERT", "POLYLINE",
                                                         "LINE",   "3DLINE", "VERTEX", "SEQEND",
                                                         "3DFACE", "EOF"};
    return std::ranges::count(kKinds, kind) > 0;
}

/// How a block is put into the drawing.
struct Insert {
    explicit Insert(const DxfRecord& record)
        : block(record.value(2)),
          place(record.vector(10, 10, 0)),
          scale(record.vector(41, 1, 1)),
          columns(std::max(1.0, record.number(70, 1))),
          rows(std::max(1.0, record.number(71, 1))),
          columnStep(record.number(44)),
          rowStep(record.number(45)),
          isTurned(record.number(50) != 0 || record.number(210) != 0 || record.number(220) != 0 ||
                   record.number(230, 1) < 0) {}

    bool isRepeated() const { return columns * rows > 1; }

    std::string_view block;
    glm::dvec3 place, scale;
    double columns, rows, columnStep, rowStep;
    bool isTurned;
};

/// Whether blocks are put as the file has them, one after the other.
class Placing {
public:
    bool isRight(const Insert& insert) {
        if (insert.isTurned)
            return false;
        if (!insert.isRepeated())
            return true;
        const double copies = insert.columns * insert.rows;
        if (insert.block.size() > kLongestName || !(copies_ + copies <= kMostCopies))
            return false;
        copies_ += copies;
        return true;
    }

private:
    double copies_ = 0;
};

/// Where Assimp's scale * (point + place) - base is the format's place + scale * (point - base).
std::string insertForAssimp(const Insert& insert, const glm::dvec3& offset,
                            const glm::dvec3& base) {
    const glm::dvec3 place = (insert.place + offset + base) / insert.scale - base;
    return fmt::format("0\nINSERT\n2\n{}\n10\n{}\n20\n{}\n30\n{}\n41\n{}\n42\n{}\n43\n{}\n",
                       insert.block, place.x, place.y, place.z, insert.scale.x, insert.scale.y,
                       insert.scale.z);
}

/// In all its rows and columns.
std::string insertsForAssimp(const Insert& insert, const glm::dvec3& base) {
    std::string text;
    for (int row = 0; row < insert.rows; ++row)
        for (int column = 0; column < insert.columns; ++column)
            text += insertForAssimp(
                insert, glm::dvec3(column * insert.columnStep, row * insert.rowStep, 0), base);
    return text;
}

std::map<std::string_view, glm::dvec3> basesOf(std::string_view dxf) {
    std::map<std::string_view, glm::dvec3> bases;
    forEachDxfRecord(dxf, kDxfDrawn, [&](const DxfRecord& record) {
        if (record.kind == "BLOCK")
            bases[record.value(2)] = record.vector(10, 10, 0);
    });
    return bases;
}

/// The block that records are in, one after the other; empty outside of blocks.
class BlockName {
public:
    std::string_view at(const DxfRecord& record) {
        if (record.kind == "BLOCK")
            name_ = record.value(2);
        else if (record.kind == "ENDBLK" || record.section == "ENTITIES")
            name_ = {};
        return name_;
    }

private:
    std::string_view name_;
};

bool isColoured(const DxfRecord& record) {
    return record.kind == "3DFACE" || record.kind == "POLYLINE";
}

/// For the colour that the layer stands for.
void putOnLayer(const DxfRecord& entity, std::string_view layer, MendedText& mended) {
    constexpr int kLayer = 8;
    std::size_t at = 0;
    dxfGroupAt(entity.text, at);
    const std::size_t behindKind = at;
    while (at < entity.text.size()) {
        const DxfGroup group = dxfGroupAt(entity.text, at);
        if (group.code != kLayer)
            continue;
        const auto offset = static_cast<std::size_t>(group.value.data() - entity.text.data());
        mended.replace(entity.begin + offset, group.value.size(), layer);
        return;
    }
    mended.replace(entity.begin + behindKind, 0, fmt::format("{}\n{}\n", kLayer, layer));
}

/// Of a face of a polyface mesh: the corner before an edge that is not shown has a number below 0,
/// and Assimp leaves such out.
void showEdges(const DxfRecord& vertex, MendedText& mended) {
    constexpr int kFlags = 70, kFirstCorner = 71, kLastCorner = 74, kIsPlace = 64, kIsFace = 128;
    if ((dxfNumberOf(vertex.value(kFlags), 0) & (kIsPlace | kIsFace)) != kIsFace)
        return;
    for (std::size_t at = 0; at < vertex.text.size();) {
        const DxfGroup group = dxfGroupAt(vertex.text, at);
        if (group.code < kFirstCorner || group.code > kLastCorner || !group.value.starts_with('-'))
            continue;
        const auto offset = static_cast<std::size_t>(group.value.data() - vertex.text.data());
        mended.replace(vertex.begin + offset, 1, "");
    }
}

/// A solid, a mesh of rows and columns, or a line that is drawn out to a height.
bool isLostSurface(const DxfRecord& record) {
    constexpr std::array<std::string_view, 13> kKinds = {
        "SOLID",           "TRACE",       "MESH",           "3DSOLID",      "BODY",
        "REGION",          "SURFACE",     "PLANESURFACE",   "SWEPTSURFACE", "LOFTEDSURFACE",
        "EXTRUDEDSURFACE", "NURBSURFACE", "REVOLVEDSURFACE"};
    constexpr std::array<std::string_view, 5> kLines = {"LINE", "ARC", "CIRCLE", "POLYLINE",
                                                        "LWPOLYLINE"};
    constexpr int kIsOfRows = 16;
    return std::ranges::count(kKinds, record.kind) > 0 ||
           (std::ranges::count(kLines, record.kind) > 0 && record.number(39) != 0) ||
           (record.kind == "POLYLINE" && (dxfNumberOf(record.value(70), 0) & kIsOfRows) != 0);
}

}  // namespace

std::optional<std::string> dxfForAssimp(std::string_view dxf) {
    const std::map<std::string_view, glm::dvec3> bases = basesOf(dxf);
    const DxfColours colours(dxf);
    MendedText mended(dxf);
    Placing placing;
    BlockName blockName;
    forEachDxfRecord(dxf, kDxfDrawn, [&](const DxfRecord& record) {
        const std::string_view around = blockName.at(record);
        if (!isRead(record.kind))
            mended.replace(record.begin, record.text.size(), "");
        if (colours.areAny() && isColoured(record))
            putOnLayer(record, dxfLayerOf(colours.of(record, around)), mended);
        if (record.kind == "VERTEX")
            showEdges(record, mended);
        if (record.kind != "INSERT" || record.section != "ENTITIES")
            return;
        const Insert insert(record);
        const bool isRight = placing.isRight(insert);
        const auto block = bases.find(insert.block);
        const glm::dvec3 base = block == bases.end() ? glm::dvec3(0) : block->second;
        const bool isPlain = base == glm::dvec3(0) && insert.scale == glm::dvec3(1) &&
                             !insert.isTurned && !insert.isRepeated();
        if (isPlain || insert.scale.x * insert.scale.y * insert.scale.z == 0)
            return;
        mended.replace(record.begin, record.text.size(),
                       isRight ? insertsForAssimp(insert, base)
                               : insertForAssimp(insert, glm::dvec3(0), base));
    });
    return mended.finish();
}

std::vector<std::string> dxfCaveats(std::string_view dxf) {
    std::uint64_t misplaced = 0, surfaces = 0, grey = 0;
    const DxfColours colours(dxf);
    Placing placing;
    BlockName blockName;
    std::set<std::string_view> kinds;
    forEachDxfRecord(dxf, kDxfDrawn, [&](const DxfRecord& record) {
        if (record.kind == "INSERT" && record.section == "ENTITIES")
            misplaced += placing.isRight(Insert(record)) ? 0 : 1;
        if (const std::string_view around = blockName.at(record); isColoured(record))
            grey += colours.areSeveral(record, around) ? 1 : 0;
        if (!isLostSurface(record))
            return;
        ++surfaces;
        kinds.insert(record.kind);
    });
    std::vector<std::string> caveats;
    if (misplaced > 0)
        caveats.push_back(fmt::format(
            "{} blocks are not put as the file has them: turned, in a plane of their "
            "own, in rows under a name of more than {} bytes, or more than {} times in all; "
            "explode them before export",
            misplaced, kLongestName, kMostCopies));
    if (surfaces > 0)
        caveats.push_back(
            fmt::format("left out {} surfaces of the kinds {}, which are not read: turn them into "
                        "3DFACEs or polyface meshes before export",
                        surfaces, fmt::join(kinds, ", ")));
    if (grey > 0)
        caveats.push_back(fmt::format(
            "{} surfaces of blocks are grey: they have the colour of what inserts the block, which "
            "is inserted with several; explode such blocks before export",
            grey));
    return caveats;
}

}  // namespace eyrie::import
