// SPDX-License-Identifier: Apache-2.0
#include "coordinator/frame/active_configuration.h"

#include <algorithm>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <glm/ext/matrix_transform.hpp>
#include <gmock/gmock.h>

#include "coordinator/config/default_config.h"
#include "coordinator/config/eqc_reader.h"
#include "coordinator/frame/kept_settings.h"

namespace eyrie::coordinator {
namespace {

using testing::HasSubstr;

config::Configuration read(const std::string& text) {
    config::Findings findings;
    config::Configuration configuration = config::readEqc(text, findings);
    EXPECT_FALSE(findings.hasErrors()) << describe(findings, "test");
    return configuration;
}

/// Two layouts, of which the second, with a wall one metre off and an observer whose left eye is
/// two metres off, is not shown.
ActiveConfiguration hiddenWall() {
    return ActiveConfiguration(
        read("config { appNode { pipe { window { channel { name \"0\" } } } } "
             "observer { eye_left [ 0 0 -2 ] } layout { name \"plain\" view {} } "
             "layout { name \"wall\" view { observer 0 "
             "wall { bottom_left [ -1 -1 -1 ] bottom_right [ 1 -1 -1 ] top_left [ -1 1 -1 ] } } } "
             "canvas { layout \"plain\" layout \"wall\" segment { channel \"0\" } } }"));
}

void expectRefused(ActiveConfiguration& active, const config::ViewState& settings) {
    const config::ConfigurationState before = active.state();
    const absl::Status status = active.setView("wall", "0", settings);
    EXPECT_TRUE(absl::IsInvalidArgument(status)) << status;
    EXPECT_THAT(std::string(status.message()), HasSubstr("not before the wall"));
    EXPECT_EQ(active.state(), before);
    EXPECT_TRUE(active.plan({}, 1, {}).ok());
    ASSERT_TRUE(active.switchLayout("0", "wall").ok());
    EXPECT_TRUE(active.plan({}, 2, {}).ok());
}

TEST(ActiveConfiguration, RefusesAWallBehindAnEyeEvenWhereItIsNotShown) {
    ActiveConfiguration active = hiddenWall();
    config::ViewState settings;
    settings.surface = config::Wall{{-1, -1, 1}, {1, -1, 1}, {-1, 1, 1}};
    expectRefused(active, settings);
}

TEST(ActiveConfiguration, RefusesToShowAnEyeThatIsBehindTheWall) {
    ActiveConfiguration active = hiddenWall();
    config::ViewState settings;
    settings.isStereo = true;
    expectRefused(active, settings);
}

/// A channel that shows what another has drawn, beside one that draws by another's help.
TEST(ActiveConfiguration, RefusesPicksInWhatOthersHaveDrawn) {
    const ActiveConfiguration active(
        read("config { appNode { pipe { window { channel { name \"wall\" } "
             "channel { name \"desk\" } channel { name \"help\" } } } } "
             "layout { view {} } canvas { layout 0 segment { channel \"wall\" } } "
             "canvas { layout 0 segment { channel \"desk\" } } "
             "compound { compound { channel ( canvas 0 segment 0 view 0 ) outputframe {} "
             "compound {} compound { channel \"help\" outputframe {} } "
             "inputframe { name \"frame.help\" } } "
             "compound { channel ( canvas 1 segment 0 view 0 ) task [ CLEAR ASSEMBLE ] "
             "inputframe { name \"frame.wall\" } } } }"));
    FrameRequest request;
    request.shown = {Shown{}};
    EXPECT_TRUE(active.seen(request).ok()) << active.seen(request).status();
    request.shown.front().canvas = "1";
    const absl::Status refused = active.seen(request).status();
    EXPECT_TRUE(absl::IsUnimplemented(refused)) << refused;
    EXPECT_THAT(std::string(refused.message()),
                HasSubstr("channel 'desk' shows what others have drawn"));
}

/// Two channels beside each other, whose border goes by what they take; `seen` has the layout.
ActiveConfiguration twoBesideEachOther(const std::string& seen = "layout { view { } } ") {
    const std::string window = "window { viewport [ 0 0 640 480 ] channel { name \"";
    return ActiveConfiguration(
        read("config { appNode { pipe { " + window + "0\" } } } pipe { " + window + "1\" } } } } " +
             seen +
             "canvas { layout 0 segment { channel \"0\" } } "
             "compound { channel ( segment 0 view 0 ) load_equalizer { mode VERTICAL } "
             "compound { } compound { channel \"1\" outputframe { } } "
             "inputframe { name \"frame.1\" } } }"));
}

/// Of the left half, one eye sees something at its left end and the other at its right: what is
/// seen of it is all of it, and it is cut in its middle. If the last eye alone counted, all of it
/// would lie at the cut that there is.
TEST(ActiveConfiguration, CountsWhatBothEyesCover) {
    ActiveConfiguration active =
        twoBesideEachOther("observer { } layout { view { mode STEREO observer 0 } } ");
    const compound::Plan first = active.plan({}, 1, {}).value();
    ASSERT_EQ(first.draws.size(), 4U);
    std::vector<ActiveConfiguration::Taken> taken;
    bool isSecondEye = false;
    for (const compound::PlannedDraw& draw : first.draws) {
        const fabric::PixelViewport& area = draw.task.pixelViewport;
        const bool isLeft = area.x == 0;
        ActiveConfiguration::Taken& each = taken.emplace_back();
        each.milliseconds = each.stages.total = isLeft ? 45 : 5;
        each.covered = area;
        if (!isLeft)
            continue;
        EXPECT_EQ(area.width, 640);
        each.covered.width /= 20;
        if (std::exchange(isSecondEye, true))
            each.covered.x = area.width - each.covered.width;
    }
    active.record(0, first, 1, taken);
    const compound::Plan second = active.plan({}, 2, {}).value();
    EXPECT_LT(second.draws.front().task.pixelViewport.width, .44 * 1280);
}

/// Seen by two eyes through a wall, by an observer with these settings.
config::Configuration room(const std::string& observer) {
    return read(
        "config { appNode { pipe { window { channel { name \"0\" } } } } observer { " + observer +
        " } layout { view { mode STEREO observer 0 "
        "wall { bottom_left [ -1 -1 -2 ] bottom_right [ 1 -1 -2 ] top_left [ -1 1 -2 ] } } } "
        "canvas { layout 0 segment { channel \"0\" } } }");
}

/// What is drawn of a picture asked for at `width` x `height` after many frames of `milliseconds`:
/// by a channel of `drawn` pixels for one of `shown`, with a resolution that goes by that.
fabric::PixelViewport settled(const std::string& shown, const std::string& drawn, int width,
                              int height, double milliseconds) {
    ActiveConfiguration active(read(
        "config { appNode { pipe { window { viewport [ 0 0 " + shown +
        " ] channel { name \"0\" } } } pipe { window { viewport [ 0 0 " + drawn +
        " ] channel { name \"1\" } } } } layout { view { } } "
        "canvas { layout 0 segment { channel \"0\" } } "
        "compound { channel ( segment 0 view 0 ) compound { channel \"1\" "
        "DFR_equalizer { framerate 20 } outputframe { } } inputframe { name \"frame.1\" } } }"));
    FrameRequest request;
    request.width = width;
    request.height = height;
    request.completeness = fabric::Completeness::Interactive;
    fabric::PixelViewport area;
    for (std::uint64_t number = 1; number <= 30; ++number) {
        const absl::StatusOr<compound::Plan> plan = active.plan(request, number, {});
        if (!plan.ok() || plan->draws.size() != 1) {
            ADD_FAILURE() << plan.status();
            return {};
        }
        area = plan->draws[0].task.pixelViewport;
        ActiveConfiguration::Taken taken{area, {}, milliseconds};
        taken.stages.total = milliseconds;
        active.record(0, *plan, number, std::span(&taken, 1));
    }
    return area;
}

TEST(ActiveConfiguration, ReducesPicturesToTheirOwnLeastWhateverTheWindow) {
    EXPECT_EQ(settled("1280 800", "1280 800", 320, 200, 1e6).height, 128);
}

TEST(ActiveConfiguration, EnlargesPicturesToWhatTheChannelHasAndRenderersDraw) {
    EXPECT_EQ(settled("320 200", "1280 800", 640, 400, .01),
              (fabric::PixelViewport{0, 0, 1280, 800}));
    EXPECT_EQ(settled("320 200", "40000 40000", 10000, 200, .01).width, fabric::kMaxViewPixels);
}

/// Draws the session's next frame, all of whose load lies in a tenth of the picture, from `begin`
/// on. Returns how wide the left one's part was, of the whole.
double drawNext(ActiveConfiguration& active, std::uint64_t session, std::uint64_t number,
                double begin) {
    FrameRequest request;
    request.session = session;
    const compound::Plan plan = active.plan(request, number, {}).value();
    std::vector<ActiveConfiguration::Taken> taken;
    for (const compound::PlannedDraw& draw : plan.draws) {
        const fabric::PixelViewport& area = draw.task.pixelViewport;
        const double from = std::max(begin * request.width, double{1} * area.x);
        const double to = std::min((begin + .1) * request.width, double{1} * area.x + area.width);
        ActiveConfiguration::Taken& each = taken.emplace_back();
        each.milliseconds = each.stages.total = 1 + std::max(0.0, to - from);
        each.covered = area;
    }
    active.record(session, plan, number, taken);
    return 1. * plan.draws.front().task.pixelViewport.width / request.width;
}

TEST(ActiveConfiguration, SharesEachSessionsFramesOutByWhatItsOwnTake) {
    ActiveConfiguration active = twoBesideEachOther();
    double left = .5;
    double right = .5;
    for (std::uint64_t number = 1; number < 40; number += 2) {
        left = drawNext(active, 1, number, .1);
        right = drawNext(active, 2, number + 1, .8);
    }
    EXPECT_NEAR(left, .15, .02);
    EXPECT_NEAR(right, .85, .02);
}

TEST(ActiveConfiguration, BeginsASessionWithWhatTheLastOneLearned) {
    ActiveConfiguration active = twoBesideEachOther();
    std::uint64_t number = 0;
    while (number < 20) drawNext(active, 1, ++number, .1);
    EXPECT_NEAR(drawNext(active, 2, ++number, .1), .15, .02) << "as of the one before";
    for (std::uint64_t session = 3; session < 30; ++session)
        EXPECT_NEAR(drawNext(active, session, ++number, .1), .15, .05);
    EXPECT_NEAR(drawNext(active, 1, ++number, .1), .15, .05) << "forgotten by now, and begun again";
}

TEST(ActiveConfiguration, TunesTheEqualizersOfAllSessions) {
    ActiveConfiguration active = twoBesideEachOther();
    drawNext(active, 1, 1, .1);
    drawNext(active, 2, 2, .8);
    equalizer::Tuning frozen;
    frozen.isFrozen = true;
    ASSERT_TRUE(active.tune("0", frozen).ok());
    for (const std::uint64_t session : {1, 2}) {
        const double before = drawNext(active, session, 2 + session, .1);
        for (std::uint64_t number = 10 * session; number < 10 * session + 5; ++number)
            EXPECT_EQ(drawNext(active, session, number, .8), before);
    }
}

TEST(ActiveConfiguration, ComparesDepthsOfDataThatAnEqualizerIsToldToDivide) {
    ActiveConfiguration active = twoBesideEachOther();
    const auto drawDepth = [&active] {
        const compound::Plan plan = active.plan({}, 1, {}).value();
        return plan.draws.size() == 2 && std::ranges::all_of(plan.draws, [](const auto& draw) {
                   return draw.task.wantsDepth;
               });
    };
    EXPECT_FALSE(drawDepth());
    equalizer::Tuning tuning;
    tuning.mode = config::SplitMode::Db;
    ASSERT_TRUE(active.tune("0", tuning).ok());
    EXPECT_TRUE(drawDepth());
    tuning.mode = config::SplitMode::TwoD;
    ASSERT_TRUE(active.tune("0", tuning).ok());
    EXPECT_FALSE(drawDepth());
}

std::vector<fabric::Sight> sightsOf(ActiveConfiguration& active) {
    std::vector<fabric::Sight> sights;
    const absl::StatusOr<compound::Plan> plan = active.plan({}, 1, {});
    EXPECT_TRUE(plan.ok()) << plan.status();
    if (plan.ok())
        for (const compound::PlannedDraw& draw : plan->draws)
            sights.push_back(draw.task.sight.value_or(fabric::Sight{}));
    return sights;
}

/// Whoever asks for it, and however.
TEST(ActiveConfiguration, DividesNoDataWhoseDepthsNobodySends) {
    ActiveConfiguration active(read(
        "config { appNode { pipe { window { channel { name \"a\" } channel { name \"b\" } } } } "
        "layout { view {} } canvas { layout 0 segment { channel \"a\" } } compound { channel ( "
        "segment 0 view 0 ) load_equalizer {} compound {} compound { channel \"b\" "
        "outputframe { name \"f\" buffer [ COLOR ] } } inputframe { name \"f\" } } }"));
    const config::ConfigurationState before = active.state();
    equalizer::Tuning tuning;
    tuning.mode = config::SplitMode::Db;
    EXPECT_THAT(std::string(active.tune("0", tuning).message()),
                HasSubstr("the outputframe \"f\" at 1:"));
    config::ConfigurationState wanted = before;
    wanted.equalizers.at(0) = tuning;
    EXPECT_TRUE(absl::IsInvalidArgument(active.become(wanted)));
    KeptSettings kept;
    kept.equalizers["0"] = tuning;
    EXPECT_EQ(kept.restore(active).size(), 1U);
    EXPECT_EQ(active.state(), before);
}

/// The helper has nothing to draw while the view shows one eye.
TEST(ActiveConfiguration, ShowsNoEyesForWhichDataWouldBeDividedWithoutDepths) {
    ActiveConfiguration active(read(
        "config { appNode { pipe { window { channel { name \"a\" } channel { name \"b\" } } } } "
        "layout { name \"l\" view { mode MONO } } canvas { layout 0 segment { channel \"a\" } } "
        "compound { channel ( segment 0 view 0 ) load_equalizer { } compound { } compound { eye [ "
        "LEFT RIGHT ] channel \"b\" outputframe { name \"f\" buffer [ COLOR ] } } inputframe { "
        "name \"f\" } } }"));
    equalizer::Tuning db;
    db.mode = config::SplitMode::Db;
    ASSERT_TRUE(active.tune("0", db).ok());
    config::ViewState stereo;
    stereo.isStereo = true;
    const absl::Status status = active.setView("l", "0", stereo);
    EXPECT_TRUE(absl::IsInvalidArgument(status)) << status;
    EXPECT_THAT(std::string(status.message()), HasSubstr("cannot divide data"));
    EXPECT_TRUE(active.plan({}, 1, {}).ok());
}

TEST(ActiveConfiguration, ShowsWhatAnObserverSeesWithOtherEyesAndAnotherFocus) {
    ActiveConfiguration changed(room(""));
    ActiveConfiguration written(
        room("eye_base .2 focus_distance 5 focus_mode relative_to_observer"));
    const std::vector<fabric::Sight> before = sightsOf(changed);
    ASSERT_EQ(before.size(), 2U);
    ASSERT_TRUE(changed.setObserver("0", {.2, 5, config::FocusMode::RelativeToObserver}).ok());
    EXPECT_EQ(sightsOf(changed), sightsOf(written));
    ASSERT_TRUE(changed.setObserver("0", {.2, {}, {}}).ok());
    EXPECT_NE(sightsOf(changed), sightsOf(written)) << "the focus has no part in it";
    ASSERT_TRUE(changed.setObserver("0", {}).ok());
    EXPECT_EQ(sightsOf(changed), before);
    EXPECT_FALSE(changed.setObserver("nobody", {}).ok());
}

TEST(ActiveConfiguration, KnowsWhetherWhatIsOnDisplayIsAnother) {
    ActiveConfiguration active = hiddenWall();
    const config::OnDisplay before = active.onDisplay();
    config::ViewState settings;
    settings.modelUnit = 10;
    ASSERT_TRUE(active.setView("wall", "0", settings).ok());
    EXPECT_EQ(active.onDisplay(), before) << "it is not shown";
    ASSERT_TRUE(active.switchLayout("0", "wall").ok());
    const config::OnDisplay wall = active.onDisplay();
    EXPECT_NE(wall, before);
    ASSERT_TRUE(active.setView("wall", "0", {}).ok());
    EXPECT_NE(active.onDisplay(), wall);
    ASSERT_TRUE(active.setView("wall", "0", settings).ok());
    EXPECT_EQ(active.onDisplay(), wall);
    ASSERT_TRUE(
        active.setHead("0", glm::translate(fabric::Mat4(1.0), fabric::Vec3(0, 0, .1))).ok());
    EXPECT_NE(active.onDisplay(), wall);
    ASSERT_TRUE(active.setHead("0", fabric::Mat4(1.0)).ok());
    ASSERT_TRUE(active.setObserver("0", {.2, {}, {}}).ok());
    EXPECT_NE(active.onDisplay(), wall);
    ASSERT_TRUE(active.setObserver("0", {}).ok());
    ASSERT_TRUE(active.switchLayout("0", "plain").ok());
    EXPECT_EQ(active.onDisplay(), before);
}

/// All layouts of one that is made show the same.
TEST(ActiveConfiguration, HasTheSameOnDisplayHoweverItIsDrawn) {
    const std::vector<config::RendererFacts> renderers(4, {"a", "", "fake"});
    const ActiveConfiguration one(config::defaultConfiguration(std::span(renderers).first(1)));
    ActiveConfiguration four(config::defaultConfiguration(renderers));
    EXPECT_EQ(four.onDisplay(), one.onDisplay());
    for (const std::string& layout : config::layoutNames(four.written())) {
        ASSERT_TRUE(four.switchLayout("0", layout).ok());
        EXPECT_EQ(four.onDisplay(), one.onDisplay()) << layout;
    }
}

}  // namespace
}  // namespace eyrie::coordinator
