// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "coordinator/config/statement_list.h"

namespace eyrie::config {
namespace {

void viewport(const std::optional<Viewport>& viewport, StatementList& list) {
    if (viewport)
        list.viewport("viewport", *viewport);
}

void writeChannel(const Channel& channel, StatementList& list) {
    StatementList inner;
    inner.text("name", channel.name);
    viewport(channel.viewport, inner);
    const auto has = [&channel](std::string_view drawable) {
        return std::ranges::find(channel.drawables, drawable) != channel.drawables.end();
    };
    if (!channel.drawables.empty())
        inner.flags("drawable", {{"FBO_COLOR", has("FBO_COLOR")},
                                 {"FBO_DEPTH", has("FBO_DEPTH")},
                                 {"FBO_STENCIL", has("FBO_STENCIL")}});
    inner.attributes("attributes", channel.attributes);
    list.block("channel", std::move(inner));
}

void writeWindow(const Window& window, StatementList& list) {
    StatementList inner;
    inner.text("name", window.name);
    viewport(window.viewport, inner);
    inner.attributes("attributes", window.attributes);
    for (const Channel& channel : window.channels) writeChannel(channel, inner);
    list.block("window", std::move(inner));
}

void writePipe(const Pipe& pipe, StatementList& list) {
    StatementList inner;
    inner.text("name", pipe.name);
    inner.number("port", pipe.port);
    inner.number("device", pipe.device);
    viewport(pipe.viewport, inner);
    inner.attributes("attributes", pipe.attributes);
    for (const Window& window : pipe.windows) writeWindow(window, inner);
    list.block("pipe", std::move(inner));
}

}  // namespace

void writeConnection(const Connection& connection, StatementList& list) {
    StatementList inner;
    if (!connection.type.empty())
        inner.word("type", connection.type);
    inner.text("hostname", connection.hostname);
    inner.text("interface", connection.interfaceName);
    inner.number("port", connection.port, std::int64_t{0});
    inner.number("bandwidth", connection.bandwidth, std::int64_t{0});
    inner.text("filename", connection.filename);
    list.block("connection", std::move(inner));
}

void writeNode(const Node& node, StatementList& list) {
    StatementList inner;
    inner.text("name", node.name);
    inner.text("host", node.host);
    for (const Connection& connection : node.connections) writeConnection(connection, inner);
    inner.attributes("attributes", node.attributes);
    for (const Pipe& pipe : node.pipes) writePipe(pipe, inner);
    list.block(node.isApplication ? "appNode" : "node", std::move(inner));
}

}  // namespace eyrie::config
