// SPDX-License-Identifier: Apache-2.0
#include "coordinator/config/statement_list.h"

namespace eyrie::config {
namespace {

const Channel& channelAt(const Configuration& all, const ChannelIndex& index) {
    return all.nodes[index.node].pipes[index.pipe].windows[index.window].channels[index.channel];
}

/// The first of that name, in the order of the file.
bool isFirstOfItsName(const Configuration& all, const ChannelIndex& index) {
    const std::string& name = channelAt(all, index).name;
    for (std::size_t node = 0; node <= index.node; ++node)
        for (std::size_t pipe = 0; pipe < all.nodes[node].pipes.size(); ++pipe) {
            const std::vector<Window>& windows = all.nodes[node].pipes[pipe].windows;
            for (std::size_t window = 0; window < windows.size(); ++window)
                for (std::size_t channel = 0; channel < windows[window].channels.size(); ++channel)
                    if (windows[window].channels[channel].name == name)
                        return ChannelIndex{node, pipe, window, channel} == index;
        }
    return false;
}

void writeDestination(const Configuration& all, const DestinationIndex& index,
                      StatementList& list) {
    StatementList inner;
    writeReference("canvas", all.canvases, index.canvas, inner);
    writeReference("segment", all.canvases[index.canvas].segments, index.segment, inner);
    writeReference("layout", all.layouts, index.layout, inner);
    writeReference("view", all.layouts[index.layout].views, index.view, inner);
    list.reference("channel", std::move(inner));
}

void writeBuffers(const std::optional<Buffers>& buffers, StatementList& list) {
    if (buffers)
        list.flags("buffer", {{"COLOR", buffers->colour}, {"DEPTH", buffers->depth}});
}

void writeFrame(std::string_view keyword, const Frame& frame, StatementList& list) {
    StatementList inner;
    inner.text("name", frame.name);
    if (frame.isTexture)
        inner.word("type", "texture");
    if (frame.viewport != Viewport{})
        inner.viewport("viewport", frame.viewport);
    writeBuffers(frame.buffers, inner);
    if (frame.zoom)
        inner.pair("zoom", *frame.zoom);
    list.block(keyword, std::move(inner));
}

void writeTiles(std::string_view keyword, const Tiles& tiles, StatementList& list) {
    StatementList inner;
    inner.text("name", tiles.name);
    if (tiles.size)
        inner.pair("size", *tiles.size);
    inner.number("size", tiles.chunk);
    list.block(keyword, std::move(inner));
}

std::string_view wordOf(StereoMode mode) {
    switch (mode) {
        case StereoMode::Auto:
            return "AUTO";
        case StereoMode::Quad:
            return "QUAD";
        case StereoMode::Anaglyph:
            return "ANAGLYPH";
        case StereoMode::Passive:
            break;
    }
    return "PASSIVE";
}

void writeMask(std::string_view keyword, const std::optional<ColourMask>& mask,
               StatementList& list) {
    if (mask)
        list.flags(keyword, {{"RED", mask->red}, {"GREEN", mask->green}, {"BLUE", mask->blue}});
}

void writeStereo(const Compound& compound, StatementList& list) {
    if (!compound.stereoMode && !compound.anaglyphLeft && !compound.anaglyphRight)
        return;
    StatementList inner;
    if (compound.stereoMode)
        inner.word("stereo_mode", wordOf(*compound.stereoMode));
    writeMask("stereo_anaglyph_left_mask", compound.anaglyphLeft, inner);
    writeMask("stereo_anaglyph_right_mask", compound.anaglyphRight, inner);
    list.block("attributes", std::move(inner));
}

/// Which share of what the parent does.
void writeShare(const Compound& compound, StatementList& list) {
    if (compound.viewport != Viewport{})
        list.viewport("viewport", compound.viewport);
    if (compound.range != fabric::Range{})
        list.numbers("range", {compound.range.begin, compound.range.end});
    list.number("period", compound.period);
    list.number("phase", compound.phase);
    const PixelShare& pixel = compound.pixel;
    if (pixel != PixelShare{})
        list.numbers("pixel",
                     {static_cast<double>(pixel.x), static_cast<double>(pixel.y),
                      static_cast<double>(pixel.width), static_cast<double>(pixel.height)});
    if (compound.subpixel != SubPixelShare{})
        list.numbers("subpixel", {static_cast<double>(compound.subpixel.index),
                                  static_cast<double>(compound.subpixel.count)});
    if (compound.zoom != fabric::Vec2(1, 1))
        list.pair("zoom", compound.zoom);
}

void writeTasks(const std::optional<Tasks>& tasks, StatementList& list) {
    if (tasks)
        list.flags("task", {{"CLEAR", tasks->clear},
                            {"DRAW", tasks->draw},
                            {"ASSEMBLE", tasks->assemble},
                            {"READBACK", tasks->readback}});
}

void writeChannelReference(const Configuration& all, const ChannelReference& channel,
                           StatementList& list) {
    if (const auto* source = std::get_if<ChannelIndex>(&channel))
        writeChannel(all, *source, list);
    else if (const auto* destination = std::get_if<DestinationIndex>(&channel))
        writeDestination(all, *destination, list);
}

}  // namespace

void writeChannel(const Configuration& all, const ChannelIndex& index, StatementList& list) {
    const std::string& name = channelAt(all, index).name;
    if (!name.empty() && isFirstOfItsName(all, index))
        return list.text("channel", name);
    StatementList inner;
    inner.number("node", std::optional(index.node));
    inner.number("pipe", std::optional(index.pipe));
    inner.number("window", std::optional(index.window));
    inner.number("channel", std::optional(index.channel));
    list.reference("channel", std::move(inner));
}

void writeCompound(const Configuration& all, const Compound& compound, StatementList& list) {
    StatementList inner;
    inner.text("name", compound.name);
    writeChannelReference(all, compound.channel, inner);
    writeTasks(compound.tasks, inner);
    writeBuffers(compound.buffers, inner);
    if (compound.eyes)
        inner.eyes("eye", *compound.eyes);
    writeShare(compound, inner);
    writeSurface(compound.surface, inner);
    writeSwapBarrier(compound.swapBarrier, inner);
    writeStereo(compound, inner);
    for (const Equalizer& equalizer : compound.equalizers) writeEqualizer(equalizer, inner);
    for (const Compound& child : compound.children) writeCompound(all, child, inner);
    for (const Frame& frame : compound.inputFrames) writeFrame("inputframe", frame, inner);
    for (const Frame& frame : compound.outputFrames) writeFrame("outputframe", frame, inner);
    for (const Tiles& tiles : compound.inputTiles) writeTiles("inputtiles", tiles, inner);
    for (const Tiles& tiles : compound.outputTiles) writeTiles("outputtiles", tiles, inner);
    list.block("compound", std::move(inner));
}

EqcText statementsOf(const Configuration& all) {
    StatementList config;
    config.text("name", all.name);
    config.number("latency", all.latency, std::int64_t{1});
    config.attributes("attributes", all.attributes);
    for (const Node& node : all.nodes) writeNode(node, config);
    for (const Observer& observer : all.observers) writeObserver(observer, config);
    for (const Layout& layout : all.layouts) writeLayout(all, layout, config);
    for (const Canvas& canvas : all.canvases) writeCanvas(all, canvas, config);
    for (const Compound& compound : all.compounds) writeCompound(all, compound, config);
    StatementList server;
    for (const Connection& connection : all.connections) writeConnection(connection, server);
    server.block("config", std::move(config));
    StatementList file;
    file.attributes("global", all.globals);
    file.block("server", std::move(server));
    return {all.version, file.take()};
}

}  // namespace eyrie::config
