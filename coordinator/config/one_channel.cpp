// SPDX-License-Identifier: Apache-2.0
#include "coordinator/config/one_channel.h"

#include <variant>

namespace eyrie::config {
namespace {

template <typename T>
void inherit(const std::optional<T>& from, std::optional<T>& to) {
    if (from)
        to = from;
}

void keepDestinations(const std::vector<Compound>& from, const Compound& inherited,
                      std::vector<Compound>& to) {
    for (const Compound& each : from) {
        Compound own = inherited;
        inherit(each.eyes, own.eyes);
        inherit(each.stereoMode, own.stereoMode);
        inherit(each.anaglyphLeft, own.anaglyphLeft);
        inherit(each.anaglyphRight, own.anaglyphRight);
        if (!std::holds_alternative<DestinationIndex>(each.channel)) {
            keepDestinations(each.children, own, to);
            continue;
        }
        own.channel = each.channel;
        // A wall that an only child has is what is seen.
        if (each.children.size() == 1)
            own.children.emplace_back().surface = each.children.front().surface;
        to.push_back(own);
    }
}

}  // namespace

Configuration oneChannel(const Configuration& configuration) {
    Configuration plain = configuration;
    plain.compounds.clear();
    keepDestinations(configuration.compounds, {}, plain.compounds);
    return plain;
}

}  // namespace eyrie::config
