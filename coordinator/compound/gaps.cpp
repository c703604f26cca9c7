// SPDX-License-Identifier: Apache-2.0
#include "coordinator/compound/gaps.h"

#include <algorithm>
#include <string>
#include <vector>

#include <fmt/format.h>

namespace eyrie::compound {
namespace {

using fabric::PixelViewport;

std::string describe(std::span<const Gap> gaps, const PixelViewport& whole) {
    PixelViewport area;
    fabric::Range range = gaps.front().range;
    double share = 0;
    for (const Gap& each : gaps) {
        area = enclosing(area, each.area);
        range = {std::min(range.begin, each.range.begin), std::max(range.end, each.range.end)};
        share += static_cast<double>(each.area.area()) / static_cast<double>(whole.area()) *
                 (each.range.end - each.range.begin) * each.ofPixels;
    }
    std::string where;
    if (area != whole)
        where += fmt::format(", in viewport [ {:.4g} {:.4g} {:.4g} {:.4g} ]",
                             double(area.x - whole.x) / whole.width,
                             double(area.y - whole.y) / whole.height,
                             double(area.width) / whole.width, double(area.height) / whole.height);
    if (range != fabric::Range{})
        where += fmt::format(", in range [ {:.7g} {:.7g} ]", range.begin, range.end);
    return fmt::format("nothing draws {:.3g} % of what is shown{}: it is background", 100 * share,
                       where);
}

config::Place placeOf(std::size_t destination, const config::ResolvedConfiguration& resolved) {
    for (const config::ResolvedCompound& each : resolved.compounds)
        if (each.destination == destination)
            return each.place();
    return {};
}

}  // namespace

void warnOfGaps(const config::ResolvedConfiguration& resolved, const WorkList& list,
                std::span<const Picture> pictures, std::span<const Contents> contents,
                config::Findings& findings) {
    for (const Picture& picture : pictures)
        for (const std::vector<PicturePart>* const parts : {&picture.parts, &picture.right})
            for (const PicturePart& part : *parts) {
                const std::size_t destination = list.framebuffers[part.framebuffer].destination;
                const Contents& there = contents[part.framebuffer];
                if (const Blind* const blind = list.blindOf(part.framebuffer)) {
                    // An eye moves before its wall; what cannot be drawn is so wherever it is.
                    const auto& [why, place] = *blind;
                    if (absl::IsInvalidArgument(why))
                        findings.warning(place,
                                         fmt::format("{}: {}",
                                                     there.all().empty() ? "nothing is shown"
                                                                         : "a part shows nothing",
                                                     std::string(why.message())));
                    continue;
                }
                if (there.all().empty()) {
                    if (list.drawOf(part.framebuffer) != nullptr)
                        findings.warning(
                            placeOf(destination, resolved),
                            "what is drawn does not reach the picture, which is background: other "
                            "channels give it as an outputframe, which is taken as an inputframe");
                    continue;
                }
                const std::vector<Gap> gaps = there.gaps(part.part);
                if (!gaps.empty())
                    findings.warning(placeOf(destination, resolved), describe(gaps, part.part));
            }
}

}  // namespace eyrie::compound
