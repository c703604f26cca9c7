// SPDX-License-Identifier: Apache-2.0
#include "coordinator/frame/problem.h"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "fabric/frustum.h"

namespace eyrie::coordinator {
namespace {

/// Of a ball that fills a field of view of 45 degrees the nearest is .8 of its size away.
constexpr double kLeastSceneMetres = 2 * fabric::kNearMetres;

}  // namespace

std::string problemOf(const Situation& situation) {
    if (situation.sceneIsEmpty)
        return "the scene is empty; start with data, or set a scene that names a terrain or a mesh";
    if (situation.ready > 0)
        return {};
    if (situation.opening > 0)
        return "opening the scene…";
    if (!situation.openError.empty())
        return fmt::format("the scene cannot be opened: {}", situation.openError);
    if (situation.howToJoin.empty())
        return "no renderer is connected; this server starts those again that end, and its log "
               "says why they do";
    return fmt::format("no renderer is connected; start one with `{}`", situation.howToJoin);
}

std::string noteOf(std::size_t ready, std::size_t wanted) {
    if (ready >= wanted)
        return {};
    return fmt::format(
        "{} of the {} renderers that the configuration wants {} ready; all is drawn, by fewer, and "
        "so later",
        ready, wanted, ready == 1 ? "is" : "are");
}

std::string noteOfSize(const fabric::Box& bounds) {
    const double size = bounds.isEmpty() ? 0 : glm::length(bounds.size());
    if (!(size > 0 && size < kLeastSceneMetres))
        return {};
    return fmt::format(
        "the scene is {:.2g} mm across, and nothing is drawn that is nearer to the eye than {:g} "
        "mm: scale it up, with transform.scale in a scene file",
        size * 1000, fabric::kNearMetres * 1000);
}

}  // namespace eyrie::coordinator
