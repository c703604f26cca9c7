// SPDX-License-Identifier: Apache-2.0
#include "coordinator/config/unseen.h"

#include <string>

#include <fmt/format.h>

namespace eyrie::config {
namespace {

/// The compounds of one destination.
struct Makers {
    const ResolvedCompound* first = nullptr;
    bool makeAnything = false;
};

std::string namesOf(const Eyes& eyes) {
    if (eyes.cyclop)
        return "CYCLOP";
    return fmt::format("{}{}{}", eyes.left ? "LEFT" : "", eyes.left && eyes.right ? " and " : "",
                       eyes.right ? "RIGHT" : "");
}

}  // namespace

void warnOfUnseen(const ResolvedConfiguration& resolved, Findings& findings) {
    std::vector<Makers> makers(resolved.destinations.size());
    for (const ResolvedCompound& each : resolved.compounds) {
        if (!each.destination)
            continue;
        Makers& own = makers[*each.destination];
        if (own.first == nullptr)
            own.first = &each;
        own.makeAnything = own.makeAnything || each.tasks.draw || each.tasks.assemble;
    }
    for (std::size_t i = 0; i < makers.size(); ++i) {
        const Destination& shown = resolved.destinations[i];
        if (makers[i].first != nullptr && !makers[i].makeAnything && !shown.eyes.isEmpty() &&
            !shown.pixelViewport.isEmpty())
            findings.warning(makers[i].first->place(),
                             fmt::format("no compound draws or assembles what the view shows, that "
                                         "of the eye {}: it is background",
                                         namesOf(shown.eyes)));
    }
}

}  // namespace eyrie::config
