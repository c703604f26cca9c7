// SPDX-License-Identifier: Apache-2.0
#include "coordinator/frame/pipe_renderers.h"

#include <algorithm>
#include <random>

#include <fmt/format.h>
#include <gmock/gmock.h>

namespace eyrie::coordinator {
namespace {

using testing::ElementsAre;
using testing::Pair;

using Ids = std::vector<std::string>;

std::vector<config::RendererFacts> any(const Ids& ids) {
    std::vector<config::RendererFacts> facts;
    for (const std::string& id : ids) facts.push_back({id, "", ""});
    return facts;
}

std::vector<Pipe> pipes(std::size_t count) {
    std::vector<Pipe> pipes;
    for (std::size_t i = 0; i < count; ++i) pipes.push_back({i / 2, i % 2});
    return pipes;
}

Ids idsOf(const RendererOfPipe& placed) {
    Ids ids;
    for (const auto& [pipe, id] : placed) ids.push_back(id);
    return ids;
}

TEST(PipeRenderers, TakePipesInTurnAtFirst) {
    PipeRenderers renderers;
    EXPECT_THAT(renderers.place(pipes(3), any({"a", "b"}), {}),
                ElementsAre(Pair(Pipe{0, 0}, "a"), Pair(Pipe{0, 1}, "b"), Pair(Pipe{1, 0}, "a")));
}

TEST(PipeRenderers, KeepTheirPipesWhenAnotherDiesAndItsSuccessorTakesThoseOfTheDead) {
    PipeRenderers renderers;
    EXPECT_THAT(idsOf(renderers.place(pipes(3), any({"a", "b", "c"}), {})),
                ElementsAre("a", "b", "c"));
    EXPECT_THAT(idsOf(renderers.place(pipes(3), any({"b", "c"}), {})), ElementsAre("b", "b", "c"));
    EXPECT_THAT(idsOf(renderers.place(pipes(3), any({"b", "c", "d"}), {})),
                ElementsAre("d", "b", "c"));
}

TEST(PipeRenderers, KeepPipesThatHaveNothingToDoMeanwhile) {
    PipeRenderers renderers;
    renderers.place(pipes(4), any({"a", "b", "c", "d"}), {});
    renderers.place({{1, 0}}, any({"a", "b", "c", "d"}), {});
    EXPECT_THAT(renderers.place({{0, 1}, {1, 1}}, any({"a", "b", "c", "d"}), {}),
                ElementsAre(Pair(Pipe{0, 1}, "b"), Pair(Pipe{1, 1}, "d")));
}

TEST(PipeRenderers, DoThePipesOfTheNodeThatTheyAreForBeforeOthers) {
    std::vector<config::Node> nodes(2);
    nodes[0].name = "strong";
    nodes[0].host = "strong.lab";
    nodes[1].name = "weak";
    const config::RendererFacts spare{"spare", "", ""};
    const config::RendererFacts weak{"w", "weak", ""};
    const config::RendererFacts strong{"s", "strong.lab", ""};
    const config::RendererFacts next{"t", "strong", ""};
    PipeRenderers renderers;
    EXPECT_THAT(idsOf(renderers.place(pipes(3), {spare, weak, strong}, nodes)),
                ElementsAre("s", "s", "w"));
    EXPECT_THAT(idsOf(renderers.place(pipes(3), {spare, weak}, nodes)),
                ElementsAre("spare", "spare", "w"));
    EXPECT_THAT(idsOf(renderers.place(pipes(3), {spare, weak, next}, nodes)),
                ElementsAre("t", "t", "w"));
    EXPECT_THAT(idsOf(renderers.place(pipes(3), {weak}, nodes)), ElementsAre("w", "w", "w"));
}

TEST(PipeRenderers, ShareAllPipesEvenlyWhoeverComesAndGoes) {
    std::mt19937 random(42);
    const auto upTo = [&](std::size_t most) {
        return std::uniform_int_distribution<std::size_t>(0, most)(random);
    };
    PipeRenderers renderers;
    for (int i = 0; i < 500; ++i) {
        std::vector<Pipe> wanted = pipes(12);
        std::erase_if(wanted, [&](const Pipe&) { return upTo(3) == 0; });
        Ids ids;
        for (int id = 0; id < 6; ++id)
            if (ids.empty() || upTo(2) != 0)
                ids.push_back(fmt::format("r{}", id));
        const RendererOfPipe placed = renderers.place(wanted, any(ids), {});
        ASSERT_EQ(placed.size(), wanted.size());
        std::vector<std::ptrdiff_t> counts;
        for (const std::string& id : ids) counts.push_back(std::ranges::count(idsOf(placed), id));
        const auto [fewest, most] = std::ranges::minmax(counts);
        EXPECT_LE(most - fewest, 1) << "after " << i;
        for (const Pipe& pipe : wanted) EXPECT_TRUE(std::ranges::count(ids, placed.at(pipe)) == 1);
    }
}

}  // namespace
}  // namespace eyrie::coordinator
