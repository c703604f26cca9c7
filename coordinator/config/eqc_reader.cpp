// SPDX-License-Identifier: Apache-2.0
#include "coordinator/config/eqc_reader.h"

#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "coordinator/config/attribute_table.h"
#include "coordinator/config/eqc_grammar.h"
#include "coordinator/config/frames_under_way.h"
#include "coordinator/config/same_names.h"
#include "coordinator/config/section_readers.h"
#include "coordinator/config/upgrade.h"

namespace eyrie::config {
namespace {

constexpr std::array<std::string_view, 3> kVersions{"1.0", "1.1", kNewestVersion};
constexpr std::int64_t kMostLatency = 1000;

Node& addNode(const Statement& block, Configuration& configuration) {
    Node& node = configuration.nodes.emplace_back();
    node.place = block.place;
    return node;
}

/// As in Equalizer, there is one: what another block says is added to it.
void readAppNode(const Statement& block, ValueReader& reader, Configuration& configuration) {
    const auto before = std::ranges::find_if(configuration.nodes, &Node::isApplication);
    if (before == configuration.nodes.end()) {
        Node& node = addNode(block, configuration);
        node.isApplication = true;
        return readNode(block, reader, node);
    }
    reader.findings().warning(block.place,
                              fmt::format("there is an appNode already, at {}: what is here is "
                                          "added to it; call other machines 'node'",
                                          describe(before->place)));
    readNode(block, reader, *before);
}

void readConfig(const Statement& block, ValueReader& reader, Configuration& configuration) {
    reader.block(
        block, "a config",
        {{"name", [&](const auto& each) { reader.text(each, configuration.name); }},
         {"latency",
          [&](const auto& each) {
              reader.wholeNumber(each, 0, kMostLatency, configuration.latency);
              if (configuration.latency >= kMostFramesUnderWay)
                  reader.findings().warning(
                      each.place,
                      fmt::format("'latency' is {}; no more than {} frames are under way at once, "
                                  "as with a latency of {}",
                                  configuration.latency, kMostFramesUnderWay,
                                  kMostFramesUnderWay - 1));
          }},
         {"attributes",
          [&](const auto& each) {
              readAttributes(each, AttributeScope::Config, reader, configuration.attributes);
          }},
         {"appNode", [&](const auto& each) { readAppNode(each, reader, configuration); }},
         {"node", [&](const auto& each) { readNode(each, reader, addNode(each, configuration)); }},
         {"observer",
          [&](const auto& each) { configuration.observers.push_back(readObserver(each, reader)); }},
         {"layout",
          [&](const auto& each) {
              configuration.layouts.push_back(readLayout(each, configuration, reader));
          }},
         {"canvas",
          [&](const auto& each) {
              configuration.canvases.push_back(readCanvas(each, configuration, reader));
          }},
         {"compound", [&](const auto& each) {
              configuration.compounds.push_back(readCompound(each, configuration, reader));
          }}});
}

class FileReader {
public:
    FileReader(ValueReader& reader, Configuration& configuration)
        : reader_(reader), configuration_(configuration) {}

    void read(const std::vector<Statement>& statements) {
        for (const Statement& statement : statements) {
            if (statement.keyword == "global")
                readGlobals(statement);
            else if (statement.keyword == "server")
                readServer(statement);
            else if (statement.keyword == "config")
                config(statement);
            else if (!statement.keyword.empty())
                reader_.findings().error(statement.place,
                                         fmt::format("'{}' at the top; expected global, server or "
                                                     "config",
                                                     statement.keyword));
        }
        if (configs_ == 0 && !reader_.findings().hasErrors())
            reader_.findings().error({}, "there is no config");
    }

private:
    void readGlobals(const Statement& block) {
        if (block.form != Statement::Form::Block)
            return reader_.expected(block, "a block { }");
        for (const Statement& statement : block.statements)
            readGlobal(statement, reader_, configuration_.globals);
    }
    void readServer(const Statement& block) {
        reader_.block(block, "a server",
                      {{"connection",
                        [this](const auto& each) {
                            configuration_.connections.push_back(readConnection(each, reader_));
                        }},
                       {"config", [this](const auto& each) { config(each); }}});
    }
    void config(const Statement& block) {
        if (++configs_ > 1)
            return reader_.findings().warning(block.place,
                                              "only the first config of a server is used");
        readConfig(block, reader_, configuration_);
    }

    ValueReader& reader_;
    Configuration& configuration_;
    int configs_ = 0;
};

}  // namespace

Configuration readStatements(const EqcText& statements, Findings& findings) {
    Configuration configuration;
    configuration.version = statements.version;
    if (!configuration.version.empty() &&
        std::ranges::find(kVersions, configuration.version) == kVersions.end())
        findings.error(statements.versionPlace,
                       fmt::format("the file is of version {}; 1.0, 1.1 and 1.2 are read",
                                   configuration.version));
    ValueReader reader(findings);
    FileReader(reader, configuration).read(statements.statements);
    warnOfSameNames(configuration, findings);
    return configuration;
}

Configuration readEqc(std::string_view text, Findings& findings) {
    Configuration configuration = readStatements(parseEqc(text, findings), findings);
    if (!findings.hasErrors())
        upgrade(configuration);
    return configuration;
}

}  // namespace eyrie::config
