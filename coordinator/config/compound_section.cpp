// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "coordinator/config/attribute_table.h"
#include "coordinator/config/section_readers.h"

namespace eyrie::config {
namespace {

constexpr std::int64_t kMostPeriod = 1'000'000;

void number(const Statement& statement, ValueReader& reader, std::int64_t low,
            std::optional<std::int64_t>& target) {
    reader.optional(target, [&](std::int64_t& value) {
        reader.wholeNumber(statement, low, kMostPeriod, value);
    });
}

std::optional<Buffers> readBuffers(const Statement& statement, ValueReader& reader) {
    Buffers buffers;
    reader.flags(statement, {{"COLOR", &buffers.colour}, {"DEPTH", &buffers.depth}});
    return buffers;
}

template <typename Zoom>
void readZoom(const Statement& statement, ValueReader& reader, Zoom& zoom) {
    fabric::Vec2 read(1, 1);
    reader.pair(statement, read);
    if (!(read.x > 0 && read.y > 0))
        return reader.expected(statement, "two numbers above 0");
    zoom = read;
}

Frame readFrame(const Statement& block, std::string_view what, ValueReader& reader) {
    Frame frame;
    frame.place = block.place;
    reader.block(
        block, what,
        {{"name", [&](const auto& each) { reader.text(each, frame.name); }},
         {"type",
          [&](const auto& each) {
              reader.choice<bool>(each, {{"memory", false}, {"texture", true}}, frame.isTexture);
          }},
         {"viewport", [&](const auto& each) { reader.fraction(each, frame.viewport); }},
         {"buffer", [&](const auto& each) { frame.buffers = readBuffers(each, reader); }},
         {"buffers", [&](const auto& each) { frame.buffers = readBuffers(each, reader); }, false,
          "buffer"},
         {"zoom", [&](const auto& each) { readZoom(each, reader, frame.zoom); }}});
    return frame;
}

Tiles readTiles(const Statement& block, std::string_view what, ValueReader& reader) {
    Tiles tiles;
    tiles.place = block.place;
    reader.block(block, what,
                 {{"name", [&](const auto& each) { reader.text(each, tiles.name); }},
                  {"size", [&](const auto& each) {
                       const std::size_t errors = reader.findings().errors();
                       std::int64_t width = 0;
                       std::int64_t height = 0;
                       double chunk = 0;
                       const bool isList = each.form == Statement::Form::List;
                       if (isList)
                           reader.wholeNumbers(each, {&width, &height});
                       else
                           reader.number(each, chunk);
                       if (reader.findings().errors() > errors)
                           return;
                       if (isList && width > 0 && height > 0) {
                           tiles.size = fabric::Vec2(width, height);
                           tiles.chunk.reset();
                       } else if (!isList && chunk > 0 && chunk <= 1) {
                           tiles.chunk = chunk;
                       } else {
                           reader.expected(each,
                                           "[ width height ] of a pixel or more, or a share "
                                           "of the range up to 1");
                       }
                   }}});
    return tiles;
}

void readAttributes(const Statement& block, ValueReader& reader, Compound& compound) {
    const auto mask = [&reader](const Statement& each) {
        ColourMask read;
        reader.flags(each, {{"RED", &read.red}, {"GREEN", &read.green}, {"BLUE", &read.blue}});
        return read;
    };
    const auto removed = [&reader](const Statement& each) {
        reader.hasNoEffect(each, "Equalizer has it no more");
    };
    reader.block(block, "a compound's attributes",
                 {{"stereo_mode",
                   [&](const auto& each) {
                       StereoMode mode = StereoMode::Auto;
                       reader.choice<StereoMode>(each,
                                                 {{"AUTO", StereoMode::Auto},
                                                  {"QUAD", StereoMode::Quad},
                                                  {"ANAGLYPH", StereoMode::Anaglyph},
                                                  {"PASSIVE", StereoMode::Passive},
                                                  {"anaglyph", StereoMode::Anaglyph}},
                                                 mode);
                       compound.stereoMode = mode;
                   }},
                  {"stereo_anaglyph_left_mask",
                   [&](const auto& each) { compound.anaglyphLeft = mask(each); }},
                  {"stereo_anaglyph_right_mask",
                   [&](const auto& each) { compound.anaglyphRight = mask(each); }},
                  {"update_FOV", removed},
                  {"hint_offset", removed}});
}

/// Of all segments or views: an index counts in the first canvas or layout, a name is looked for in
/// all of them. `within` narrows it to one.
template <typename Group, typename Member>
bool findMember(const Statement& statement, const std::vector<Group>& groups,
                std::vector<Member> Group::*members, std::string_view what, bool isWithin,
                ValueReader& reader, std::size_t& group, std::size_t& member) {
    const Scalar* const value = ValueReader::single(statement);
    if (isWithin || value == nullptr || value->kind != Scalar::Kind::Text) {
        const std::size_t of = isWithin ? group : 0;
        static const std::vector<Member> none;
        const auto found =
            reader.reference(statement, of < groups.size() ? groups[of].*members : none, what);
        if (!found)
            return false;
        group = of;
        member = *found;
        return true;
    }
    for (group = 0; group < groups.size(); ++group)
        for (member = 0; member < (groups[group].*members).size(); ++member)
            if ((groups[group].*members)[member].name == value->text)
                return true;
    reader.findings().error(
        value->place, fmt::format("no {} named \"{}\" is defined before this", what, value->text));
    return false;
}

/// ( canvas C segment S layout L view V ): a canvas stands for its first segment, a layout for its
/// first view.
ChannelReference readDestination(const Statement& statement, const Configuration& before,
                                 ValueReader& reader) {
    DestinationIndex index;
    bool hasCanvas = false;
    bool hasLayout = false;
    const std::size_t errors = reader.findings().errors();
    for (const Statement& each : statement.statements) {
        if (each.keyword == "canvas") {
            const auto canvas = reader.reference(each, before.canvases, "canvas");
            index.canvas = canvas.value_or(0);
            index.segment = 0;
            hasCanvas = canvas.has_value();
        } else if (each.keyword == "layout") {
            const auto layout = reader.reference(each, before.layouts, "layout");
            index.layout = layout.value_or(0);
            index.view = 0;
            hasLayout = layout.has_value();
        } else if (each.keyword == "segment") {
            findMember(each, before.canvases, &Canvas::segments, "segment", hasCanvas, reader,
                       index.canvas, index.segment);
        } else if (each.keyword == "view") {
            findMember(each, before.layouts, &Layout::views, "view", hasLayout, reader,
                       index.layout, index.view);
        } else {
            reader.findings().error(each.place,
                                    fmt::format("'{}' in a channel's reference; expected canvas, "
                                                "segment, layout or view",
                                                each.keyword));
        }
    }
    if (reader.findings().errors() > errors)
        return {};
    const bool isThere = index.canvas < before.canvases.size() &&
                         index.segment < before.canvases[index.canvas].segments.size() &&
                         index.layout < before.layouts.size() &&
                         index.view < before.layouts[index.layout].views.size();
    if (isThere)
        return index;
    reader.findings().error(statement.place,
                            "the channel's reference is to the first segment or view of what has "
                            "none");
    return {};
}

ChannelReference readChannelReference(const Statement& statement, const Configuration& before,
                                      ValueReader& reader) {
    if (statement.form == Statement::Form::Reference && !isPosition(statement))
        return readDestination(statement, before, reader);
    if (const auto channel = readChannel(statement, before, reader))
        return *channel;
    return {};
}

void readRange(const Statement& statement, ValueReader& reader, fabric::Range& target) {
    fabric::Range range = target;
    reader.numbers(statement, {&range.begin, &range.end});
    if (!(range.begin >= 0 && range.begin <= range.end && range.end <= 1))
        return reader.expected(statement, "[ begin end ] with 0 <= begin <= end <= 1");
    target = range;
}

void readPixel(const Statement& statement, ValueReader& reader, PixelShare& target) {
    PixelShare pixel;
    reader.wholeNumbers(statement, {&pixel.x, &pixel.y, &pixel.width, &pixel.height});
    if (!(pixel.width > 0 && pixel.height > 0 && pixel.x < pixel.width && pixel.y < pixel.height))
        return reader.expected(statement, "[ x y width height ] with x < width and y < height");
    target = pixel;
}

void readSubPixel(const Statement& statement, ValueReader& reader, SubPixelShare& target) {
    SubPixelShare subpixel;
    reader.wholeNumbers(statement, {&subpixel.index, &subpixel.count});
    if (subpixel.index >= subpixel.count)
        return reader.expected(statement, "[ index count ] with index < count");
    target = subpixel;
}

class CompoundReader {
public:
    CompoundReader(const Configuration& before, ValueReader& reader)
        : before_(before), reader_(reader) {}

    Compound read(const Statement& block) {
        Compound compound;
        compound.place = block.place;
        reader_.block(
            block, "a compound",
            {{"name", [&](const auto& each) { reader_.text(each, compound.name); }},
             {"channel",
              [&](const auto& each) {
                  compound.channel = readChannelReference(each, before_, reader_);
              }},
             {"task", [&](const auto& each) { readTasks(each, compound); }},
             {"eye", [&](const auto& each) { readEyes(each, compound); }},
             {"buffer", [&](const auto& each) { readOwnBuffers(each, compound); }},
             {"buffers", [&](const auto& each) { readOwnBuffers(each, compound); }, false,
              "buffer"},
             {"viewport", [&](const auto& each) { reader_.fraction(each, compound.viewport); }},
             {"range", [&](const auto& each) { readRange(each, reader_, compound.range); }},
             {"period", [&](const auto& each) { number(each, reader_, 1, compound.period); }},
             {"phase", [&](const auto& each) { number(each, reader_, 0, compound.phase); }},
             {"pixel", [&](const auto& each) { readPixel(each, reader_, compound.pixel); }},
             {"subpixel",
              [&](const auto& each) { readSubPixel(each, reader_, compound.subpixel); }},
             {"zoom", [&](const auto& each) { readZoom(each, reader_, compound.zoom); }},
             {"wall", [&](const auto& each) { compound.surface = readWall(each, reader_); }, false,
              "wall"},
             {"projection",
              [&](const auto& each) { compound.surface = readProjection(each, reader_); }, false,
              "wall"},
             {"swapbarrier",
              [&](const auto& each) { compound.swapBarrier = readSwapBarrier(each, reader_); },
              false, "swapbarrier"},
             {"outputframe",
              [&](const auto& each) {
                  compound.outputFrames.push_back(readFrame(each, "an outputframe", reader_));
              }},
             {"inputframe",
              [&](const auto& each) {
                  compound.inputFrames.push_back(readFrame(each, "an inputframe", reader_));
              }},
             {"outputtiles",
              [&](const auto& each) {
                  compound.outputTiles.push_back(readTiles(each, "outputtiles", reader_));
              }},
             {"inputtiles",
              [&](const auto& each) {
                  compound.inputTiles.push_back(readTiles(each, "inputtiles", reader_));
              }},
             equalizer("load_equalizer", EqualizerKind::Load, compound),
             equalizer("tree_equalizer", EqualizerKind::Tree, compound),
             equalizer("DFR_equalizer", EqualizerKind::Dfr, compound),
             equalizer("tile_equalizer", EqualizerKind::Tile, compound),
             equalizer("view_equalizer", EqualizerKind::View, compound),
             equalizer("monitor_equalizer", EqualizerKind::Monitor, compound),
             equalizer("framerate_equalizer", EqualizerKind::Framerate, compound),
             {"loadBalancer",
              [&](const auto& each) {
                  if (auto read = readLoadBalancer(each, reader_))
                      compound.equalizers.push_back(std::move(*read));
              }},
             {"attributes", [&](const auto& each) { readAttributes(each, reader_, compound); }},
             {"compound", [&](const auto& each) { compound.children.push_back(read(each)); }}});
        return compound;
    }

private:
    void readTasks(const Statement& statement, Compound& compound) {
        Tasks tasks;
        reader_.flags(statement, {{"CLEAR", &tasks.clear},
                                  {"DRAW", &tasks.draw},
                                  {"ASSEMBLE", &tasks.assemble},
                                  {"READBACK", &tasks.readback}});
        compound.tasks = tasks;
    }
    void readEyes(const Statement& statement, Compound& compound) {
        Eyes eyes;
        reader_.flags(statement,
                      {{"CYCLOP", &eyes.cyclop}, {"LEFT", &eyes.left}, {"RIGHT", &eyes.right}});
        compound.eyes = eyes;
    }
    void readOwnBuffers(const Statement& statement, Compound& compound) {
        compound.buffers = readBuffers(statement, reader_);
    }
    Entry equalizer(std::string_view keyword, EqualizerKind kind, Compound& compound) {
        return {keyword, [this, kind, &compound](const Statement& each) {
                    compound.equalizers.push_back(readEqualizer(each, kind, reader_));
                }};
    }

    const Configuration& before_;
    ValueReader& reader_;
};

}  // namespace

Compound readCompound(const Statement& block, const Configuration& before, ValueReader& reader) {
    return CompoundReader(before, reader).read(block);
}

}  // namespace eyrie::config
