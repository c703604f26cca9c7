// SPDX-License-Identifier: Apache-2.0
#include "coordinator/config/statement_list.h"

namespace eyrie::config {
namespace {

std::string_view wordOf(SplitMode mode) {
    switch (mode) {
        case SplitMode::TwoD:
            return "2D";
        case SplitMode::Db:
            return "DB";
        case SplitMode::Horizontal:
            return "HORIZONTAL";
        case SplitMode::Vertical:
            break;
    }
    return "VERTICAL";
}

void pixelsOrRange(std::string_view keyword, const std::optional<fabric::Vec2>& pixels,
                   const std::optional<double>& range, StatementList& list) {
    if (pixels)
        list.pair(keyword, *pixels);
    list.number(keyword, range);
}

}  // namespace

std::string_view keywordOf(EqualizerKind kind) {
    switch (kind) {
        case EqualizerKind::Load:
            return "load_equalizer";
        case EqualizerKind::Tree:
            return "tree_equalizer";
        case EqualizerKind::Dfr:
            return "DFR_equalizer";
        case EqualizerKind::Tile:
            return "tile_equalizer";
        case EqualizerKind::View:
            return "view_equalizer";
        case EqualizerKind::Monitor:
            return "monitor_equalizer";
        case EqualizerKind::Framerate:
            break;
    }
    return "framerate_equalizer";
}

/// What other kinds have is at its usual value, and so left out.
void writeEqualizer(const Equalizer& equalizer, StatementList& list) {
    const Equalizer usual;
    StatementList inner;
    inner.text("name", equalizer.name);
    if (equalizer.mode != usual.mode)
        inner.word("mode", wordOf(equalizer.mode));
    inner.number("damping", equalizer.damping, usual.damping);
    pixelsOrRange("boundary", equalizer.boundaryPixels, equalizer.boundaryRange, inner);
    pixelsOrRange("resistance", equalizer.resistancePixels, equalizer.resistanceRange, inner);
    inner.number("assemble_only_limit", equalizer.assembleOnlyLimit);
    inner.number("framerate", equalizer.framerate, usual.framerate);
    if (equalizer.tileSize != usual.tileSize)
        inner.pair("size", equalizer.tileSize);
    inner.number("size", equalizer.tileChunk);
    list.block(keywordOf(equalizer.kind), std::move(inner));
}

}  // namespace eyrie::config
