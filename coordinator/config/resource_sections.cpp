// SPDX-License-Identifier: Apache-2.0
#include "coordinator/config/attribute_table.h"
#include "coordinator/config/section_readers.h"

namespace eyrie::config {
namespace {

constexpr std::int64_t kMostPort = 65535;
constexpr std::int64_t kMost = 1'000'000'000;

void viewport(const Statement& statement, ValueReader& reader, std::optional<Viewport>& target) {
    reader.optional(target, [&](Viewport& value) {
        reader.viewport(statement, value);
        if (value.isPixels() && (value.width < 1 || value.height < 1))
            reader.expected(statement,
                            "1 x 1 pixels or more: a width or a height above 1 makes all four "
                            "pixels");
    });
}

void number(const Statement& statement, ValueReader& reader, std::optional<std::int64_t>& target) {
    reader.optional(target,
                    [&](std::int64_t& value) { reader.wholeNumber(statement, 0, kMost, value); });
}

/// What is wrong is said to be so, and no more.
template <typename Read>
void readInVain(const Statement& statement, ValueReader& reader, std::string_view why,
                const Read& read) {
    const std::size_t errors = reader.findings().errors();
    read();
    if (reader.findings().errors() == errors)
        reader.hasNoEffect(statement, why);
}

Channel readChannel(const Statement& block, ValueReader& reader) {
    Channel channel;
    channel.place = block.place;
    bool colour = false;
    bool depth = false;
    bool stencil = false;
    reader.block(
        block, "a channel",
        {{"name", [&](const auto& each) { reader.text(each, channel.name); }},
         {"viewport", [&](const auto& each) { viewport(each, reader, channel.viewport); }},
         {"drawable",
          [&](const auto& each) {
              reader.flags(
                  each, {{"FBO_COLOR", &colour}, {"FBO_DEPTH", &depth}, {"FBO_STENCIL", &stencil}});
          }},
         {"attributes", [&](const auto& each) {
              readAttributes(each, AttributeScope::Channel, reader, channel.attributes);
          }}});
    if (colour)
        channel.drawables.push_back("FBO_COLOR");
    if (depth)
        channel.drawables.push_back("FBO_DEPTH");
    if (stencil)
        channel.drawables.push_back("FBO_STENCIL");
    return channel;
}

Window readWindow(const Statement& block, ValueReader& reader) {
    Window window;
    window.place = block.place;
    reader.block(block, "a window",
                 {{"name", [&](const auto& each) { reader.text(each, window.name); }},
                  {"viewport", [&](const auto& each) { viewport(each, reader, window.viewport); }},
                  {"attributes",
                   [&](const auto& each) {
                       readAttributes(each, AttributeScope::Window, reader, window.attributes);
                   }},
                  {"channel", [&](const auto& each) {
                       window.channels.push_back(readChannel(each, reader));
                   }}});
    return window;
}

Pipe readPipe(const Statement& block, ValueReader& reader) {
    Pipe pipe;
    pipe.place = block.place;
    reader.block(
        block, "a pipe",
        {{"name", [&](const auto& each) { reader.text(each, pipe.name); }},
         {"port",
          [&](const auto& each) {
              readInVain(each, reader, "renderers draw without a window system",
                         [&] { number(each, reader, pipe.port); });
          }},
         {"device",
          [&](const auto& each) {
              readInVain(each, reader, "`eyrie renderer --device` says what a renderer draws on",
                         [&] { number(each, reader, pipe.device); });
          }},
         {"viewport", [&](const auto& each) { viewport(each, reader, pipe.viewport); }},
         {"attributes",
          [&](const auto& each) {
              readAttributes(each, AttributeScope::Pipe, reader, pipe.attributes);
          }},
         {"window", [&](const auto& each) { pipe.windows.push_back(readWindow(each, reader)); }}});
    return pipe;
}

}  // namespace

Connection readConnection(const Statement& block, ValueReader& reader) {
    Connection connection;
    const auto port = [&](const Statement& each) {
        readInVain(each, reader, kAddresses,
                   [&] { reader.wholeNumber(each, 0, kMostPort, connection.port); });
    };
    const auto text = [&](std::string& target) {
        return [&reader, &target](const Statement& each) {
            readInVain(each, reader, kAddresses, [&] { reader.text(each, target); });
        };
    };
    reader.block(block, "a connection",
                 {{"type",
                   [&](const auto& each) {
                       using Name = std::string;
                       reader.choice<Name>(each,
                                           {{"TCPIP", "TCPIP"},
                                            {"PIPE", "PIPE"},
                                            {"RSP", "RSP"},
                                            {"RDMA", "RDMA"},
                                            {"UDT", "UDT"},
                                            {"SDP", "SDP"},
                                            {"MCIP_RSP", "RSP"}},
                                           connection.type);
                       if (!connection.type.empty() && connection.type != "TCPIP")
                           reader.hasNoEffect(each, kGrpc);
                   }},
                  {"hostname", text(connection.hostname)},
                  {"interface", text(connection.interfaceName)},
                  {"port", port},
                  {"TCPIP_port", port, false, "port"},
                  {"bandwidth",
                   [&](const auto& each) {
                       readInVain(each, reader, kUnpaced, [&] {
                           reader.wholeNumber(each, 0, kMost, connection.bandwidth);
                       });
                   }},
                  {"filename", text(connection.filename)},
                  {"PIPE_filename", text(connection.filename), false, "filename"}});
    return connection;
}

void readNode(const Statement& block, ValueReader& reader, Node& node) {
    reader.block(
        block, node.isApplication ? "an appNode" : "a node",
        {{"name", [&](const auto& each) { reader.text(each, node.name); }},
         {"host", [&](const auto& each) { reader.text(each, node.host); }},
         {"connection",
          [&](const auto& each) { node.connections.push_back(readConnection(each, reader)); }},
         {"attributes",
          [&](const auto& each) {
              readAttributes(each, AttributeScope::Node, reader, node.attributes);
          }},
         {"pipe", [&](const auto& each) { node.pipes.push_back(readPipe(each, reader)); }}});
}

}  // namespace eyrie::config
