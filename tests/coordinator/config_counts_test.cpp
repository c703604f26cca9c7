// SPDX-License-Identifier: Apache-2.0
// Of what each of Equalizer's files has how many, counted in its text by regular expressions alone,
// which share nothing with the reader.
#include <filesystem>
#include <map>
#include <numeric>
#include <regex>
#include <string>
#include <string_view>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "coordinator/config/eqc_grammar.h"
#include "coordinator/config/eqc_reader.h"
#include "coordinator/config/eqc_writer.h"
#include "coordinator/config/upgrade.h"
#include "eqc_samples.h"

namespace eyrie::config {
namespace {

/// By keyword; nodes are those of the application, too.
using Counts = std::map<std::string, std::size_t>;

Counts noCounts() {
    Counts counts;
    for (const char* const keyword : {"node", "pipe", "window", "channel", "observer", "layout",
                                      "view", "canvas", "segment", "compound"})
        counts[keyword] = 0;
    return counts;
}

/// Keywords that open a block, outside comments, texts and characters; references open none.
Counts blocksIn(const std::string& text) {
    static const std::regex kIgnored(R"re("[^"]*"|'[^']'|#[^\n]*|//[^\n]*)re");
    static const std::regex kBlock(R"re(\b([A-Za-z]+)\s*\{)re");
    const std::string bare = std::regex_replace(text, kIgnored, " ");
    Counts counts = noCounts();
    for (std::sregex_iterator block(bare.begin(), bare.end(), kBlock), end; block != end; ++block) {
        const std::string keyword = block->str(1) == "appNode" ? "node" : block->str(1);
        if (const auto known = counts.find(keyword); known != counts.end())
            ++known->second;
    }
    return counts;
}

std::size_t sizeOf(const std::vector<Compound>& compounds) {
    return std::accumulate(
        compounds.begin(), compounds.end(), compounds.size(),
        [](std::size_t sum, const Compound& compound) { return sum + sizeOf(compound.children); });
}

Counts countsOf(const Configuration& configuration) {
    Counts counts = noCounts();
    counts["node"] = configuration.nodes.size();
    for (const Node& node : configuration.nodes) {
        counts["pipe"] += node.pipes.size();
        for (const Pipe& pipe : node.pipes) {
            counts["window"] += pipe.windows.size();
            for (const Window& window : pipe.windows) counts["channel"] += window.channels.size();
        }
    }
    counts["observer"] = configuration.observers.size();
    counts["layout"] = configuration.layouts.size();
    for (const Layout& layout : configuration.layouts) counts["view"] += layout.views.size();
    counts["canvas"] = configuration.canvases.size();
    for (const Canvas& canvas : configuration.canvases) counts["segment"] += canvas.segments.size();
    counts["compound"] = sizeOf(configuration.compounds);
    return counts;
}

TEST(EqcCounts, OfEachOfEqualizersFilesAreThoseOfItsText) {
    Counts all = noCounts();
    for (const std::string& name : samples()) {
        SCOPED_TRACE(name);
        const std::string text = contents(std::filesystem::path(kSamples) / name);
        const Counts written = blocksIn(text);
        Findings findings;
        Configuration read = readStatements(parseEqc(text, findings), findings);
        EXPECT_FALSE(findings.hasErrors()) << describe(findings, name);
        EXPECT_EQ(countsOf(read), written);
        EXPECT_EQ(blocksIn(writeEqc(read)), written);
        upgrade(read);
        for (const auto& [keyword, count] : countsOf(read)) {
            EXPECT_GE(count, written.at(keyword)) << keyword;
            all[keyword] += written.at(keyword);
        }
    }
    EXPECT_EQ(all, (Counts{{"node", 108},
                           {"pipe", 158},
                           {"window", 194},
                           {"channel", 220},
                           {"observer", 48},
                           {"layout", 87},
                           {"view", 97},
                           {"canvas", 52},
                           {"segment", 99},
                           {"compound", 457}}));
}

/// Else a count that agrees says nothing.
TEST(EqcCounts, LeaveOutCommentsTextsAndReferences) {
    Counts expected = noCounts();
    expected["node"] = 2;
    expected["channel"] = 1;
    EXPECT_EQ(blocksIn("# node {\nnode { // pipe {\n channel{ name \"view {\" quote '\"' } }\n"
                       "appNode\n{ channel ( node 0 ) subchannel { } }"),
              expected);
}

}  // namespace
}  // namespace eyrie::config
