// SPDX-License-Identifier: Apache-2.0
#include "coordinator/frame/configuration_keeper.h"

#include <algorithm>

#include <gmock/gmock.h>

#include "coordinator/config/eqc_reader.h"

namespace eyrie::coordinator {
namespace {

using testing::ElementsAre;

std::vector<config::RendererFacts> renderers(const std::vector<std::string>& ids) {
    std::vector<config::RendererFacts> facts;
    for (const std::string& id : ids) facts.push_back({id, "", "fake"});
    return facts;
}

fabric::Mat4 moved(double x) {
    fabric::Mat4 roomFromHead(1);
    roomFromHead[3][0] = x;
    return roomFromHead;
}

/// A stereo view in feet, seen from aside, whose shares stand still.
absl::Status setAll(ActiveConfiguration& active) {
    config::ViewState view;
    view.isStereo = true;
    view.modelUnit = .3048;
    absl::Status status = active.setView("2D", "0", view);
    status.Update(active.setHead("0", moved(.25)));
    config::ObserverState observer;
    observer.focusDistance = 2.5;
    status.Update(active.setObserver("0", observer));
    equalizer::Tuning frozen;
    frozen.isFrozen = true;
    frozen.damping = .125;
    status.Update(active.tune("load.2D", frozen));
    return status;
}

void expectAllSet(const ActiveConfiguration& active) {
    EXPECT_EQ(active.state().views[0][0].isStereo, true);
    EXPECT_EQ(active.state().views[0][0].modelUnit, .3048);
    EXPECT_EQ(active.state().heads[0], moved(.25));
    EXPECT_EQ(active.state().observers[0].focusDistance, 2.5);
    EXPECT_EQ(active.state().equalizers[0].damping, .125);
    const equalizer::EqualizerState equalizer = active.equalizers().front();
    EXPECT_EQ(equalizer.name, "load.2D");
    EXPECT_TRUE(equalizer.isFrozen);
    EXPECT_EQ(equalizer.settings.damping, .125);
}

std::vector<std::string> nodesOf(const ActiveConfiguration& active) {
    std::vector<std::string> names;
    for (const config::Node& node : active.written().nodes) names.push_back(node.name);
    return names;
}

TEST(ConfigurationKeeper, KeepsWhatWasSetWhateverTheNumberOfRenderers) {
    ConfigurationKeeper keeper(std::nullopt, "", [] {});
    keeper.with(renderers({"a", "b", "c"}));
    ASSERT_TRUE(keeper.change(setAll).ok());
    expectAllSet(*keeper.with(renderers({"b", "c"})));
    expectAllSet(*keeper.with(renderers({"b", "c", "d"})));
    keeper.with(renderers({"d"}));  // it has no layout of that name, nor its equalizer
    expectAllSet(*keeper.with(renderers({"d", "e", "f", "g"})));
}

TEST(ConfigurationKeeper, GoesOnWithTheSameConfigurationWhereOneRendererTakesAnothersPlace) {
    ConfigurationKeeper keeper(std::nullopt, "", [] {});
    const auto first = keeper.with(renderers({"a", "b", "c"}));
    EXPECT_THAT(nodesOf(*first), ElementsAre("a", "b", "c"));
    EXPECT_EQ(keeper.with(renderers({"b", "c", "d"})), first);
    EXPECT_THAT(nodesOf(*first), ElementsAre("d", "b", "c"));
    EXPECT_NE(keeper.with(renderers({"b", "d"})), first);
    EXPECT_EQ(keeper.with(renderers({"b", "d", "e"})), first) << "what it learned is lost";
    EXPECT_THAT(nodesOf(*first), ElementsAre("d", "b", "e"));
}

TEST(ConfigurationKeeper, ShowsTheChosenLayoutAgainOnceThereIsOne) {
    ConfigurationKeeper keeper(std::nullopt, "DB dynamic", [] {});
    keeper.with(renderers({"a"}));
    EXPECT_EQ(keeper.canvases().front().layout, "Simple");
    ASSERT_TRUE(
        keeper.change([](ActiveConfiguration& active) { return active.setHead("0", moved(1)); })
            .ok());
    keeper.with(renderers({"a", "b"}));
    EXPECT_EQ(keeper.canvases().front().layout, "DB dynamic");
}

TEST(ConfigurationKeeper, TellsWhatMakesAnotherPictureAndNothingElse) {
    int told = 0;
    ConfigurationKeeper keeper(std::nullopt, "", [&] { ++told; });
    keeper.with(renderers({"a", "b"}));
    EXPECT_EQ(told, 1);
    const std::uint64_t first = keeper.displayRevision();
    const auto turn = [&](double x) {
        return keeper.change(
            [=](ActiveConfiguration& active) { return active.setHead("0", moved(x)); });
    };
    ASSERT_TRUE(turn(.25).ok());
    EXPECT_EQ(told, 2);
    EXPECT_EQ(keeper.displayRevision(), first + 1);
    ASSERT_TRUE(turn(.25).ok());
    EXPECT_EQ(told, 2) << "the head is where it was";
    equalizer::Tuning frozen;
    frozen.isFrozen = true;
    ASSERT_TRUE(
        keeper.change([&](ActiveConfiguration& active) { return active.tune("load.2D", frozen); })
            .ok());
    EXPECT_EQ(told, 2) << "who draws what is not seen";
    EXPECT_EQ(keeper.displayRevision(), first + 1);
}

/// Three ranges, a pipe each.
config::Configuration ranges() {
    config::Findings findings;
    config::Configuration configuration = config::readEqc(
        "config { appNode { pipe { window { channel { name \"0\" } } } "
        "pipe { window { channel { name \"1\" } } } pipe { window { channel { name \"2\" } } } } "
        "layout { view {} } canvas { layout 0 segment { channel \"0\" } } "
        "compound { channel ( segment 0 view 0 ) buffer [ COLOR DEPTH ] "
        "compound { range [ 0 .25 ] } "
        "compound { channel \"1\" range [ .25 .5 ] outputframe { } } "
        "compound { channel \"2\" range [ .5 1 ] outputframe { } } "
        "inputframe { name \"frame.1\" } inputframe { name \"frame.2\" } } }",
        findings);
    EXPECT_FALSE(findings.hasErrors()) << describe(findings, "test");
    return configuration;
}

/// By range.
std::vector<std::string> drawing(ConfigurationKeeper& keeper, const std::vector<std::string>& ids) {
    const auto active = keeper.with(renderers(ids));
    compound::Plan plan = active->plan({}, 1, {}).value();
    std::ranges::sort(plan.draws, {},
                      [](const compound::PlannedDraw& draw) { return draw.task.range.begin; });
    return active->takersOf(plan).preferred;
}

TEST(ConfigurationKeeper, HasADeadRenderersShareAloneDrawnByAnother) {
    ConfigurationKeeper keeper(ranges(), "", [] {});
    EXPECT_THAT(drawing(keeper, {"a", "b", "c"}), ElementsAre("a", "b", "c"));
    EXPECT_THAT(drawing(keeper, {"b", "c"}), ElementsAre("b", "b", "c"));
    EXPECT_THAT(drawing(keeper, {"b", "c", "d"}), ElementsAre("d", "b", "c"));
}

/// How what is set of one keeper comes to the next, `kept` being what was kept last.
ConfigurationKeeping keeping(KeptConfiguration& kept) {
    return {kept, [&kept](const KeptConfiguration& now) { kept = now; }};
}

/// The one that is on show in its place may be chosen, too.
TEST(ConfigurationKeeper, ShowsTheChosenLayoutThoughItWasOnShowForAnother) {
    KeptConfiguration kept;
    ConfigurationKeeper keeper(
        std::nullopt, "DB static", [] {}, keeping(kept));
    keeper.with(renderers({"a"}));
    ASSERT_EQ(keeper.canvases().front().layout, "Simple");
    ASSERT_TRUE(
        keeper
            .change([](ActiveConfiguration& active) { return active.become(active.state(), true); })
            .ok());
    EXPECT_EQ(kept.layouts.at("0").layout, "Simple");
    keeper.with(renderers({"a", "b"}));
    EXPECT_EQ(keeper.canvases().front().layout, "Simple");
}

TEST(ConfigurationKeeper, KeepsAChosenLayoutByItsNameHoweverItWasAskedFor) {
    for (const char* const asked : {"0", "#0"}) {
        ConfigurationKeeper keeper(std::nullopt, "", [] {});
        keeper.with(renderers({"a"}));
        ASSERT_EQ(keeper.canvases().front().layout, "Simple");
        ASSERT_TRUE(keeper.configure({"0", asked}).ok()) << asked;
        keeper.with(renderers({"a", "b", "c"}));
        EXPECT_EQ(keeper.canvases().front().layout, "Simple") << asked;
    }
}

TEST(ConfigurationKeeper, TakesUpWhatWasSetBeforeOfHoweverManyRenderers) {
    KeptConfiguration kept;
    {
        ConfigurationKeeper keeper(
            std::nullopt, "", [] {}, keeping(kept));
        keeper.with(renderers({"a", "b", "c"}));
        ASSERT_TRUE(keeper.change(setAll).ok());
        ASSERT_TRUE(keeper.configure({"0", "DB dynamic"}).ok());
    }
    ConfigurationKeeper keeper(
        std::nullopt, "", [] {}, keeping(kept));
    keeper.with(renderers({"d"}));
    ASSERT_TRUE(
        keeper.change([](ActiveConfiguration& active) { return active.setHead("0", moved(.25)); })
            .ok());
    expectAllSet(*keeper.with(renderers({"d", "e"})));
    EXPECT_EQ(keeper.canvases().front().layout, "DB dynamic");
    ConfigurationKeeper next(
        std::nullopt, "", [] {}, keeping(kept));
    expectAllSet(*next.with(renderers({"f", "g", "h"})));
    EXPECT_EQ(next.canvases().front().layout, "DB dynamic");
    ConfigurationKeeper other(
        std::nullopt, "DB static", [] {}, keeping(kept));
    expectAllSet(*other.with(renderers({"a", "b"})));
    EXPECT_EQ(other.canvases().front().layout, "DB static") << "it begins with another";
}

/// Two layouts of one view, in that order, of two channels.
config::Configuration layouts(const std::string& first, const std::string& second) {
    config::Findings findings;
    config::Configuration configuration = config::readEqc(
        "config { appNode { pipe { window { channel { name \"a\" } } } "
        "pipe { window { channel { name \"b\" } } } } observer { name \"me\" } "
        "layout { name \"" +
            first + "\" view { observer \"me\" } } layout { name \"" + second +
            "\" view { } } canvas { name \"wall\" layout \"" + first + "\" layout \"" + second +
            "\" segment { channel \"a\" } } "
            "compound { channel ( segment 0 view 0 ) load_equalizer { mode 2D } "
            "compound { } compound { channel \"b\" outputframe { } } "
            "inputframe { name \"frame.b\" } } }",
        findings);
    EXPECT_FALSE(findings.hasErrors()) << describe(findings, "test");
    return configuration;
}

absl::Status freezeAndLookAside(ActiveConfiguration& active) {
    equalizer::Tuning frozen;
    frozen.isFrozen = true;
    absl::Status status = active.tune("load.0", frozen);
    status.Update(active.setHead("me", moved(.25)));
    config::ViewState inFeet;
    inFeet.modelUnit = .3048;
    status.Update(active.setView("plain", "0", inFeet));
    return status;
}

TEST(ConfigurationKeeper, TakesUpWhatWasSetBeforeOfAGivenConfiguration) {
    KeptConfiguration kept;
    const auto take = [&](const config::Configuration& given) {
        return ConfigurationKeeper(
            given, "", [] {}, keeping(kept));
    };
    {
        ConfigurationKeeper keeper = take(layouts("plain", "wide"));
        ASSERT_TRUE(keeper.change(freezeAndLookAside).ok());
        ASSERT_TRUE(keeper.configure({"wall", "wide"}).ok());
    }
    ConfigurationKeeper keeper = take(layouts("plain", "wide"));
    EXPECT_EQ(keeper.canvases().front().layout, "wide");
    const auto active = keeper.with(renderers({"a", "b"}));
    EXPECT_TRUE(active->equalizers().front().isFrozen);
    EXPECT_EQ(active->state().heads.front(), moved(.25));
    EXPECT_EQ(active->state().views[0][0].modelUnit, .3048);
}

/// Every name that it tells leads back to what it is of.
TEST(ConfigurationKeeper, TellsCanvasesSegmentsAndLayoutsOfOneNameApart) {
    config::Findings findings;
    const config::Configuration given = config::readEqc(
        "config { appNode { pipe { window { channel { name \"a\" } } } } "
        "layout { name \"plain\" view { } } layout { name \"plain\" view { } } "
        "canvas { name \"wall\" layout 0 segment { channel \"a\" } } "
        "canvas { name \"wall\" layout 0 layout 1 segment { name \"1\" channel \"a\" } "
        "segment { channel \"a\" } segment { name \"1\" channel \"a\" } } "
        "canvas { name \"3\" layout 0 segment { channel \"a\" } } "
        "canvas { layout 0 segment { channel \"a\" } } }",
        findings);
    EXPECT_FALSE(findings.hasErrors()) << describe(findings, "test");
    ConfigurationKeeper keeper(given, "", [] {});
    std::vector<std::string> names;
    for (const CanvasStatus& canvas : keeper.canvases()) names.push_back(canvas.name);
    EXPECT_THAT(names, ElementsAre("wall", "1", "3", "#3"));
    EXPECT_THAT(keeper.canvases()[1].segments, ElementsAre("1", "#1", "2"));
    EXPECT_THAT(keeper.canvases()[1].layouts, ElementsAre("plain", "1"));
    EXPECT_EQ(keeper.canvases()[1].layout, "plain");
    ASSERT_TRUE(keeper.configure({"1", "1"}).ok());
    EXPECT_EQ(keeper.canvases()[0].layout, "plain");
    EXPECT_EQ(keeper.canvases()[1].layout, "1");
}

TEST(ConfigurationKeeper, LeavesOutWhatAnEditedConfigurationHasNoMore) {
    KeptConfiguration kept;
    {
        ConfigurationKeeper keeper(
            layouts("plain", "wide"), "", [] {}, keeping(kept));
        ASSERT_TRUE(keeper.change(freezeAndLookAside).ok());
        ASSERT_TRUE(keeper.configure({"wall", "wide"}).ok());
    }
    ConfigurationKeeper keeper(
        layouts("narrow", "wide"), "", [] {}, keeping(kept));
    EXPECT_EQ(keeper.canvases().front().layout, "narrow") << "it begins with another";
    const auto active = keeper.with(renderers({"a", "b"}));
    EXPECT_TRUE(active->equalizers().front().isFrozen);
    EXPECT_EQ(active->state().heads.front(), moved(.25));
    EXPECT_EQ(active->state().views[0][0].modelUnit, 1) << "of a layout that is no more";
}

}  // namespace
}  // namespace eyrie::coordinator
