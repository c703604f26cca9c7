// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <fmt/format.h>

#include "coordinator/config/equalizer_limits.h"
#include "coordinator/config/section_readers.h"

namespace eyrie::config {
namespace {

/// Two whole numbers in [ ] are pixels, one number is a share of the range.
void pixelsOrRange(const Statement& statement, ValueReader& reader,
                   std::optional<fabric::Vec2>& pixels, std::optional<double>& range) {
    const std::size_t errors = reader.findings().errors();
    std::int64_t x = 0;
    std::int64_t y = 0;
    double share = 0;
    if (statement.form == Statement::Form::List)
        reader.wholeNumbers(statement, {&x, &y});
    else
        reader.number(statement, share);
    if (reader.findings().errors() > errors)
        return;
    if (statement.form == Statement::Form::List)
        pixels = fabric::Vec2(x, y);
    else if (isShare(share))
        range = share;
    else
        reader.expected(statement, "a share from 0 to 1, or pixels as [ x y ]");
}

void damping(const Statement& statement, ValueReader& reader, double& target) {
    double read = target;
    reader.number(statement, read);
    if (isShare(read))
        target = read;
    else
        reader.expected(statement, "a number from 0 to 1");
}

void positive(const Statement& statement, ValueReader& reader, double& target) {
    const std::size_t errors = reader.findings().errors();
    double read = 0;
    reader.number(statement, read);
    if (isAboveZero(read))
        target = read;
    else if (reader.findings().errors() == errors)
        reader.expected(statement, "a number above 0");
}

void tileSize(const Statement& statement, ValueReader& reader, Equalizer& equalizer) {
    const std::size_t errors = reader.findings().errors();
    if (statement.form != Statement::Form::List) {
        double chunk = 0;
        reader.number(statement, chunk);
        if (reader.findings().errors() > errors)
            return;
        if (!isChunk(chunk))
            return reader.expected(statement, "a share above 0, 1 at most, or [ width height ]");
        equalizer.tileChunk = chunk;
        return;
    }
    std::int64_t width = 0;
    std::int64_t height = 0;
    reader.wholeNumbers(statement, {&width, &height});
    if (reader.findings().errors() > errors)
        return;
    if (!isTileSize(fabric::Vec2(width, height)))
        return reader.expected(statement, "a width and a height of a pixel or more");
    equalizer.tileSize = fabric::Vec2(width, height);
    equalizer.tileChunk.reset();
}

void splitMode(const Statement& statement, ValueReader& reader, SplitMode& mode) {
    reader.choice<SplitMode>(statement,
                             {{"2D", SplitMode::TwoD},
                              {"DB", SplitMode::Db},
                              {"HORIZONTAL", SplitMode::Horizontal},
                              {"VERTICAL", SplitMode::Vertical}},
                             mode);
}

Entry dampingEntry(ValueReader& reader, Equalizer& equalizer) {
    return {"damping", [&](const Statement& each) { damping(each, reader, equalizer.damping); }};
}
Entry modeEntry(ValueReader& reader, Equalizer& equalizer) {
    return {"mode", [&](const Statement& each) { splitMode(each, reader, equalizer.mode); }};
}
Entry boundaryEntry(ValueReader& reader, Equalizer& equalizer) {
    return {"boundary",
            [&](const Statement& each) {
                pixelsOrRange(each, reader, equalizer.boundaryPixels, equalizer.boundaryRange);
            },
            true};  // in pixels, and in shares of the range
}
Entry resistanceEntry(ValueReader& reader, Equalizer& equalizer) {
    return {"resistance",
            [&](const Statement& each) {
                pixelsOrRange(each, reader, equalizer.resistancePixels, equalizer.resistanceRange);
            },
            true};
}
Entry limitEntry(ValueReader& reader, Equalizer& equalizer) {
    return {"assemble_only_limit", [&](const Statement& each) {
                reader.optional(equalizer.assembleOnlyLimit,
                                [&](double& limit) { positive(each, reader, limit); });
            }};
}
Entry framerateEntry(ValueReader& reader, Equalizer& equalizer) {
    return {"framerate",
            [&](const Statement& each) { positive(each, reader, equalizer.framerate); }};
}

/// Without what its kind has not.
Equalizer ofItsKind(const Equalizer& read) {
    Equalizer own;
    own.kind = read.kind;
    own.place = read.place;
    if (read.kind == EqualizerKind::Load) {
        own = read;
        own.framerate = Equalizer{}.framerate;
    } else if (read.kind == EqualizerKind::Dfr) {
        own.damping = read.damping;
        own.framerate = read.framerate;
    }
    return own;
}

}  // namespace

Equalizer readEqualizer(const Statement& block, EqualizerKind kind, ValueReader& reader) {
    Equalizer equalizer;
    equalizer.kind = kind;
    equalizer.place = block.place;
    const Entry name = {"name", [&](const Statement& each) { reader.text(each, equalizer.name); }};
    switch (kind) {
        case EqualizerKind::Load:
            reader.block(block, "a load_equalizer",
                         {modeEntry(reader, equalizer), dampingEntry(reader, equalizer),
                          boundaryEntry(reader, equalizer), resistanceEntry(reader, equalizer),
                          limitEntry(reader, equalizer)});
            break;
        case EqualizerKind::Tree:
            reader.block(block, "a tree_equalizer",
                         {modeEntry(reader, equalizer), dampingEntry(reader, equalizer),
                          boundaryEntry(reader, equalizer), resistanceEntry(reader, equalizer)});
            break;
        case EqualizerKind::Dfr:
            reader.block(block, "a DFR_equalizer",
                         {dampingEntry(reader, equalizer), framerateEntry(reader, equalizer)});
            break;
        case EqualizerKind::Tile:
            reader.block(block, "a tile_equalizer", {name, {"size", [&](const Statement& each) {
                                                                tileSize(each, reader, equalizer);
                                                            }}});
            break;
        case EqualizerKind::View:
        case EqualizerKind::Monitor:
        case EqualizerKind::Framerate:
            reader.block(block, "this equalizer", {});
            break;
    }
    return equalizer;
}

std::optional<Equalizer> readLoadBalancer(const Statement& block, ValueReader& reader) {
    Equalizer equalizer;
    equalizer.place = block.place;
    const std::size_t errors = reader.findings().errors();
    struct Balance {
        EqualizerKind kind = EqualizerKind::Load;
        SplitMode mode = SplitMode::TwoD;
    };
    const auto balances = [&](const Statement& each) {
        Balance balance;
        reader.choice<Balance>(each,
                               {{"2D", {EqualizerKind::Load, SplitMode::TwoD}},
                                {"DB", {EqualizerKind::Load, SplitMode::Db}},
                                {"HORIZONTAL", {EqualizerKind::Load, SplitMode::Horizontal}},
                                {"VERTICAL", {EqualizerKind::Load, SplitMode::Vertical}},
                                {"DPLEX", {EqualizerKind::Framerate}},
                                {"DFR", {EqualizerKind::Dfr}},
                                {"DDS", {EqualizerKind::Monitor}}},
                               balance);
        equalizer.kind = balance.kind;
        equalizer.mode = balance.mode;
    };
    reader.block(block, "a loadBalancer",
                 {{"mode", balances},
                  dampingEntry(reader, equalizer),
                  boundaryEntry(reader, equalizer),
                  resistanceEntry(reader, equalizer),
                  limitEntry(reader, equalizer),
                  framerateEntry(reader, equalizer)});
    if (reader.findings().errors() > errors)
        return std::nullopt;
    // Equalizer itself balances nothing then.
    if (std::ranges::find(block.statements, "mode", &Statement::keyword) == block.statements.end())
        reader.findings().warning(
            block.place,
            "a loadBalancer without `mode` is taken for one of mode 2D; say which it is");
    return ofItsKind(equalizer);
}

}  // namespace eyrie::config
