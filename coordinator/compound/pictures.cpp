// SPDX-License-Identifier: Apache-2.0
#include "coordinator/compound/pictures.h"

#include <algorithm>
#include <set>

#include "coordinator/config/destinations.h"
#include "coordinator/config/stereo_window.h"

namespace eyrie::compound {
namespace {

using config::Compound;
using config::Destination;

/// What the view and the compound of an output's first destination says about two eyes.
struct StereoSettings {
    config::StereoMode mode = config::StereoMode::Auto;
    std::optional<config::ColourMask> left;
    std::optional<config::ColourMask> right;
};

config::StereoMode globalMode(const config::Configuration& configuration) {
    const config::Attribute* const setting =
        find(configuration.globals, "EQ_COMPOUND_IATTR_STEREO_MODE");
    if (setting == nullptr)
        return config::StereoMode::Auto;
    const auto* const words = std::get_if<config::Attribute::Words>(&setting->value);
    if (words == nullptr || words->words.empty())
        return config::StereoMode::Auto;
    const std::string& word = words->words.front();
    if (word == "QUAD")
        return config::StereoMode::Quad;
    if (word == "ANAGLYPH" || word == "anaglyph")
        return config::StereoMode::Anaglyph;
    return word == "PASSIVE" ? config::StereoMode::Passive : config::StereoMode::Auto;
}

std::optional<config::ColourMask> globalMask(const config::Configuration& configuration,
                                             std::string_view name) {
    const config::Attribute* const setting = find(configuration.globals, name);
    if (setting == nullptr)
        return std::nullopt;
    const auto* const words = std::get_if<config::Attribute::Words>(&setting->value);
    if (words == nullptr)
        return std::nullopt;
    const auto has = [&](std::string_view word) {
        return std::ranges::find(words->words, word) != words->words.end();
    };
    return config::ColourMask{has("RED"), has("GREEN"), has("BLUE")};
}

StereoSettings settingsOf(const config::Configuration& configuration,
                          const config::ResolvedConfiguration& resolved, const Output& output) {
    StereoSettings settings{
        globalMode(configuration),
        globalMask(configuration, "EQ_COMPOUND_IATTR_STEREO_ANAGLYPH_LEFT_MASK"),
        globalMask(configuration, "EQ_COMPOUND_IATTR_STEREO_ANAGLYPH_RIGHT_MASK")};
    std::vector<StereoSettings> path;  // from the root down
    for (const config::ResolvedCompound& each : resolved.compounds) {
        path.resize(static_cast<std::size_t>(each.depth));
        StereoSettings own = path.empty() ? settings : path.back();
        if (each.compound != nullptr) {
            own.mode = each.compound->stereoMode.value_or(own.mode);
            own.left = each.compound->anaglyphLeft ? each.compound->anaglyphLeft : own.left;
            own.right = each.compound->anaglyphRight ? each.compound->anaglyphRight : own.right;
        }
        if (each.destination && isPartOf(resolved.destinations[*each.destination], output)) {
            const config::DestinationIndex& shown = resolved.destinations[*each.destination].index;
            own.mode =
                configuration.layouts[shown.layout].views[shown.view].stereoMode.value_or(own.mode);
            return own;
        }
        path.push_back(own);
    }
    return settings;
}

config::Eyes allEyes(const config::ResolvedConfiguration& resolved, const Output& output) {
    config::Eyes eyes;
    for (const Destination& each : resolved.destinations)
        if (isPartOf(each, output))
            eyes = {eyes.cyclop || each.eyes.cyclop, eyes.left || each.eyes.left,
                    eyes.right || each.eyes.right};
    return eyes;
}

/// Whether one picture shows both eyes, wherever two are shown: one channel has them, and its
/// window does not part them.
bool areTogether(const config::Configuration& configuration,
                 const config::ResolvedConfiguration& resolved, const Output& output) {
    return std::ranges::all_of(resolved.destinations, [&](const Destination& each) {
        return !isPartOf(each, output) ||
               (each.eyes.left == each.eyes.right &&
                !(each.eyes.left && config::isOfStereoWindow(configuration, each.channel)));
    });
}

Stereo configuredStereo(config::StereoMode mode, bool together) {
    switch (mode) {
        case config::StereoMode::Auto:
            return together ? Stereo::Anaglyph : Stereo::Separate;
        case config::StereoMode::Anaglyph:
            return Stereo::Anaglyph;
        case config::StereoMode::Quad:
        case config::StereoMode::Passive:
            break;
    }
    return Stereo::Separate;
}

config::PixelSize sizeOf(const config::Configuration& configuration,
                         const config::ResolvedConfiguration& resolved, const Output& output) {
    for (const Destination& each : resolved.destinations)
        if (isPartOf(each, output))
            return output.segment
                       ? config::PixelSize{each.segmentOnCanvas.width, each.segmentOnCanvas.height}
                       : each.canvas;
    if (output.size)  // nothing is shown there
        return *output.size;
    const config::Canvas& canvas = configuration.canvases[output.canvas];
    if (output.segment && canvas.segments[*output.segment].channel) {
        const auto pixels =
            config::pixelsOf(configuration, *canvas.segments[*output.segment].channel);
        return {pixels.width, pixels.height};
    }
    return config::configuredSize(configuration, canvas).value_or(config::PixelSize{1, 1});
}

/// Where a destination is in an output, in one eye's picture.
fabric::PixelViewport placeOf(const Destination& destination, const Output& output) {
    fabric::PixelViewport place = destination.onSegment;
    if (!output.segment) {
        place.x += destination.segmentOnCanvas.x;
        place.y += destination.segmentOnCanvas.y;
    }
    return place;
}

/// What the left and the right glass of an anaglyph see of a segment that shows one eye: that,
/// unless another segment shows the other eye there.
std::optional<Pass> passThroughGlass(const config::ResolvedConfiguration& resolved,
                                     const Output& output, const Destination& destination,
                                     Eye eye) {
    const fabric::PixelViewport place = placeOf(destination, output);
    const bool isElsewhere =
        std::ranges::any_of(resolved.destinations, [&](const Destination& other) {
            return isPartOf(other, output) && passFor(other, output, eye) &&
                   !intersection(placeOf(other, output), place).isEmpty();
        });
    return isElsewhere ? std::nullopt
                       : passFor(destination, output, eye == Eye::Left ? Eye::Right : Eye::Left);
}

/// The destinations of an output, in one eye's picture.
std::vector<PicturePart> partsOf(const config::ResolvedConfiguration& resolved,
                                 const Output& output, const Picture& picture, Eye eye,
                                 WorkList& list) {
    std::vector<PicturePart> parts;
    for (std::size_t i = 0; i < resolved.destinations.size(); ++i) {
        const Destination& each = resolved.destinations[i];
        if (!isPartOf(each, output))
            continue;
        std::optional<Pass> pass = passFor(each, output, eye);
        if (!pass && picture.stereo == Stereo::Anaglyph)
            pass = passThroughGlass(resolved, output, each, eye);
        const fabric::PixelViewport place = placeOf(each, output);
        const fabric::PixelViewport shown = intersection(place, picture.area);
        if (!pass || shown.isEmpty())
            continue;
        const fabric::PixelViewport& own = each.partOfPanorama;
        parts.push_back(
            {list.pictureOf(resolved, i, *pass),
             {own.x + shown.x - place.x, own.y + shown.y - place.y, shown.width, shown.height},
             shown.x,
             shown.y});
    }
    return parts;
}

/// The framebuffers in which something is drawn or assembled.
std::set<std::size_t> filledBy(std::span<const Step> steps) {
    std::set<std::size_t> filled;
    for (const Step& step : steps)
        if (!std::holds_alternative<Clear>(step) && !std::holds_alternative<ReadBack>(step))
            filled.insert(std::visit([](const auto& each) { return each.framebuffer; }, step));
    return filled;
}

fabric::PixelViewport placeOf(const PicturePart& part) {
    return {part.x, part.y, part.part.width, part.part.height};
}

bool isShownByAnother(const PicturePart& part, const std::vector<PicturePart>& parts,
                      const std::set<std::size_t>& filled) {
    return std::ranges::any_of(parts, [&](const PicturePart& other) {
        return filled.contains(other.framebuffer) &&
               intersection(placeOf(other), placeOf(part)) == placeOf(part);
    });
}

}  // namespace

bool isPartOf(const Destination& destination, const Output& output) {
    return destination.isShown && destination.index.canvas == output.canvas &&
           (!output.segment || destination.index.segment == *output.segment);
}

std::optional<Pass> passFor(const Destination& destination, const Output& output, Eye eye) {
    const config::Eyes& shown = destination.eyes;
    if (eye == Eye::Left && shown.left)
        return Pass{Eye::Left, Eye::Left};
    if (eye == Eye::Right && shown.right)
        return Pass{Eye::Right, Eye::Right};
    const bool isAskedFor = output.eye || output.stereo != Stereo::Configured;
    if (shown.cyclop)
        return Pass{Eye::Cyclop, isAskedFor ? eye : Eye::Cyclop};
    if (eye != Eye::Cyclop)
        return std::nullopt;  // the segment is the other eye's
    if (shown.left)
        return Pass{Eye::Left, eye};
    return shown.right ? std::optional(Pass{Eye::Right, eye}) : std::nullopt;
}

ShownEyes shownEyes(const config::Configuration& configuration,
                    const config::ResolvedConfiguration& resolved, const Output& output) {
    if (output.eye)
        return {{*output.eye}, Stereo::Separate, false};
    if (output.stereo != Stereo::Configured)
        return {{Eye::Left, Eye::Right}, output.stereo, false};
    const config::Eyes eyes = allEyes(resolved, output);
    if (!eyes.left && !eyes.right)
        return {{Eye::Cyclop}, Stereo::Separate, true};
    if (!eyes.left || !eyes.right)
        return {{eyes.left ? Eye::Left : Eye::Right}, Stereo::Separate, false};
    const StereoSettings settings = settingsOf(configuration, resolved, output);
    return {{Eye::Left, Eye::Right},
            configuredStereo(settings.mode, areTogether(configuration, resolved, output)),
            false};
}

std::vector<Picture> picturesOf(const config::Configuration& configuration,
                                const config::ResolvedConfiguration& resolved, const Output& output,
                                std::size_t index, WorkList& list) {
    const ShownEyes shown = shownEyes(configuration, resolved, output);
    Picture picture;
    picture.output = index;
    picture.whole = sizeOf(configuration, resolved, output);
    const fabric::PixelViewport whole{0, 0, picture.whole.width, picture.whole.height};
    picture.area = output.part ? intersection(*output.part, whole) : whole;
    picture.withDepth = output.wantsDepth && shown.stereo != Stereo::Anaglyph;
    picture.stereo = shown.stereo;
    const StereoSettings settings = settingsOf(configuration, resolved, output);
    picture.leftMask = settings.left.value_or(picture.leftMask);
    picture.rightMask = settings.right.value_or(picture.rightMask);
    std::vector<Picture> pictures;
    for (const Eye eye : shown.eyes) {
        std::vector<PicturePart> parts = partsOf(resolved, output, picture, eye, list);
        if (shown.stereo != Stereo::Separate && !pictures.empty()) {
            pictures.back().right = std::move(parts);
            continue;
        }
        pictures.push_back(picture);
        pictures.back().parts = std::move(parts);
        if (shown.stereo == Stereo::Separate && !shown.isPlain)
            pictures.back().eye = eye;
    }
    return pictures;
}

void leaveOutEmptyParts(std::span<const Step> steps, std::vector<Picture>& pictures) {
    const std::set<std::size_t> filled = filledBy(steps);
    for (Picture& picture : pictures)
        for (std::vector<PicturePart>* const parts : {&picture.parts, &picture.right}) {
            const std::vector<PicturePart> all = *parts;
            std::erase_if(*parts, [&](const PicturePart& part) {
                return !filled.contains(part.framebuffer) && isShownByAnother(part, all, filled);
            });
        }
}

}  // namespace eyrie::compound
