// SPDX-License-Identifier: Apache-2.0
#include "coordinator/config/idle_equalizers.h"

#include <algorithm>
#include <string>
#include <string_view>

#include <fmt/format.h>

namespace eyrie::config {
namespace {

using Kind = EqualizerKind;

bool sharesOut(const Equalizer& equalizer) {
    return equalizer.kind == Kind::Load || equalizer.kind == Kind::Tree;
}

bool draws(const Compound& compound) {
    return compound.children.empty() ? !compound.tasks || compound.tasks->draw
                                     : std::ranges::any_of(compound.children, draws);
}

/// Why it does nothing; nothing where it does something.
std::string_view idleReason(const Equalizer& equalizer, const ResolvedCompound& own) {
    const bool isForOnePicture =
        sharesOut(equalizer) || equalizer.kind == Kind::Tile || equalizer.kind == Kind::Dfr;
    if (isForOnePicture && !own.destination)
        return "its compound is no part of a view's picture, as with channel ( segment 0 view 0 )";
    const bool isForChildren =
        sharesOut(equalizer) || equalizer.kind == Kind::View || equalizer.kind == Kind::Framerate;
    if (isForChildren && std::ranges::none_of(own.compound->children, draws))
        return "its compound has no children that draw";
    if (equalizer.kind == Kind::Monitor && own.compound->inputFrames.empty())
        return "its compound has no inputframe";
    return {};
}

/// Of a boundary, whose usual values are a pixel and next to nothing, or of a resistance.
void warnOfOtherMode(const Equalizer& equalizer, std::string_view what,
                     const std::optional<fabric::Vec2>& pixels, const std::optional<double>& share,
                     Findings& findings) {
    constexpr double kUsualPixels = 1;
    constexpr double kUsualShare = 1e-5;
    const bool isDb = equalizer.mode == SplitMode::Db;
    if (isDb && !share && pixels && (pixels->x > kUsualPixels || pixels->y > kUsualPixels))
        findings.warning(equalizer.place,
                         fmt::format("a {0} in pixels has no effect in mode DB; write a share of "
                                     "the data, such as {0} .01",
                                     what));
    if (!isDb && !pixels && share && *share > kUsualShare)
        findings.warning(equalizer.place,
                         fmt::format("a {0} that is a share of the data has an effect in mode DB "
                                     "only; write pixels, such as {0} [ 16 16 ]",
                                     what));
}

/// Whether no cut can lie within the whole.
bool isWhole(const Equalizer& equalizer, const fabric::PixelViewport& picture) {
    if (equalizer.mode == SplitMode::Db)
        return equalizer.boundaryRange.value_or(0) >= 1;
    const fabric::Vec2 boundary = equalizer.boundaryPixels.value_or(fabric::Vec2(1, 1));
    return !picture.isEmpty() &&
           (equalizer.mode == SplitMode::Horizontal || boundary.x >= picture.width) &&
           (equalizer.mode == SplitMode::Vertical || boundary.y >= picture.height);
}

void warnOfSettings(const Equalizer& equalizer, const ResolvedCompound& own, Findings& findings) {
    warnOfOtherMode(equalizer, "boundary", equalizer.boundaryPixels, equalizer.boundaryRange,
                    findings);
    warnOfOtherMode(equalizer, "resistance", equalizer.resistancePixels, equalizer.resistanceRange,
                    findings);
    if (isWhole(equalizer, own.pixelViewport))
        findings.warning(equalizer.place,
                         "the boundary is as large as what is shared out, so one child draws all "
                         "of it; write a smaller one");
}

/// Of compounds below a tile equalizer's that read back what others draw.
void warnOfUntaken(const Compound& compound, Findings& findings) {
    for (const Compound& child : compound.children) {
        if (child.outputFrames.empty())
            warnOfUntaken(child, findings);
        else if (!child.children.empty() && draws(child))
            findings.warning(child.place,
                             "what is drawn for this compound's outputframe takes no tiles of the "
                             "tile_equalizer above: the frame would cover others' tiles; give "
                             "outputframes to the compounds that draw instead");
    }
}

}  // namespace

void warnOfIdleEqualizers(std::span<const ResolvedCompound> tree, Findings& findings) {
    for (const ResolvedCompound& own : tree)
        for (const Equalizer& each : own.compound->equalizers) {
            if (const std::string_view reason = idleReason(each, own); !reason.empty())
                findings.warning(each.place,
                                 fmt::format("the equalizer has no effect: {}", reason));
            else if (sharesOut(each))
                warnOfSettings(each, own, findings);
            else if (each.kind == Kind::Tile)
                warnOfUntaken(*own.compound, findings);
        }
}

}  // namespace eyrie::config
