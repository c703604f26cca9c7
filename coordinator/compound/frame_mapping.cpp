// SPDX-License-Identifier: Apache-2.0
#include "coordinator/compound/frame_mapping.h"

#include <algorithm>

#include <fmt/format.h>

namespace eyrie::compound {
namespace {

using fabric::Regridding;

absl::Status noWay(const config::Destination& destination) {
    return absl::InvalidArgumentError(fmt::format(
        "an input frame for the picture of channel \"{}\" has pixels that are not among those of "
        "the compound that takes it; take it where its pixel, subpixel or zoom is split",
        destination.name));
}

/// Both views as they lie in their pictures.
FrameMapping toScale(const fabric::PixelViewport& from, const fabric::PixelViewport& to,
                     std::vector<Regridding> rest) {
    FrameMapping mapping;
    mapping.regriddings = {{Regridding::Kind::Zoom, to, from.width, from.height}};
    if (rest.empty()) {
        mapping.fromX = from.x;
        mapping.fromY = from.y;
    } else {
        rest.front().of.x -= from.x;
        rest.front().of.y -= from.y;
    }
    mapping.regriddings.insert(mapping.regriddings.end(), rest.begin(), rest.end());
    return mapping;
}

}  // namespace

absl::StatusOr<FrameMapping> mappingOf(const config::ResolvedConfiguration& resolved,
                                       const WorkList& list, const OutputFrame& frame,
                                       std::size_t framebuffer) {
    const WorkingBuffer& source = list.framebuffers[frame.framebuffer];
    const WorkingBuffer& target = list.framebuffers[framebuffer];
    std::vector<Regridding> way = source.lattice.regriddings;
    if (frame.zoom)
        way.push_back(*frame.zoom);
    const config::Destination& shown = resolved.destinations[target.destination];
    const std::vector<Regridding>& begun = target.lattice.regriddings;
    if (source.destination != target.destination) {
        const config::Destination& from = resolved.destinations[source.destination];
        if (!begun.empty() || from.panorama.view.isEmpty() || shown.panorama.view.isEmpty())
            return noWay(shown);
        return toScale(from.panorama.view, shown.panorama.view, std::move(way));
    }
    if (way.size() < begun.size() || !std::equal(begun.begin(), begun.end(), way.begin()))
        return noWay(shown);
    way.erase(way.begin(), way.begin() + static_cast<std::ptrdiff_t>(begun.size()));
    return FrameMapping{std::move(way), 0, 0};
}

}  // namespace eyrie::compound
