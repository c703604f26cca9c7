// SPDX-License-Identifier: Apache-2.0
#include "coordinator/compound/equalizer/load_model.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace eyrie::equalizer {
namespace {

/// Of how much longer or shorter than foretold a part took, as a logarithm: so much is its child's
/// where children explain times.
constexpr double kOfChildren = .7;
constexpr double kMostSurprising = 10;
/// Children are believed once places foretold more than noise wrong, and this much more than they;
/// where by places parts are to stay that are not balanced, less will do.
constexpr double kNoise = .15;
constexpr double kClearly = .3;
constexpr double kRather = .6;
/// Of an average of frames, the last one's part.
constexpr double kOfLast = .5;

}  // namespace

LoadModel::LoadModel(int columns, int rows, std::size_t children)
    : places_{LoadMap(columns, rows), std::vector<double>(children, 1.0)}, children_(places_) {}

void LoadModel::record(std::span<const Measured> parts, bool areBalanced) {
    std::vector<Area> areas;
    for (const Measured& part : parts) areas.push_back(part.part);
    const bool areNew = areas != parts_;
    parts_ = std::move(areas);
    learn(parts, 0, areNew, places_);
    learn(parts, kOfChildren, areNew, children_);
    if (believesChildren_)
        believesChildren_ = children_.wrong <= places_.wrong;
    else if (areNew || areBalanced)
        believesChildren_ = places_.wrong > kNoise && children_.wrong < kClearly * places_.wrong;
    else
        believesChildren_ = children_.wrong < kRather * places_.wrong;
}

void LoadModel::learn(std::span<const Measured> parts, double ofChildren, bool areNew,
                      Explanation& explanation) {
    auto& [map, slowness, wrong] = explanation;
    std::vector<double> foretold;
    double sum = 0;
    double taken = 0;
    for (const Measured& part : parts) {
        foretold.push_back(map.load(part.part) * slowness[part.child]);
        sum += foretold.back();
        taken += part.milliseconds;
    }
    if (!(sum > 0))
        return;
    double off = 0;
    double logarithms = 0;
    for (std::size_t i = 0; i < parts.size(); ++i) {
        foretold[i] *= taken / sum;
        off += std::abs(parts[i].milliseconds - foretold[i]) / taken;
        const double surprise = foretold[i] > 0 ? parts[i].milliseconds / foretold[i] : 1;
        slowness[parts[i].child] *=
            std::pow(std::clamp(surprise, 1 / kMostSurprising, kMostSurprising), ofChildren);
        logarithms += std::log(slowness[parts[i].child]);
    }
    if (areNew)
        wrong += kOfLast * (off - wrong);
    // Slower all together is more load, not slower children.
    const double mean = std::exp(logarithms / static_cast<double>(parts.size()));
    std::vector<LoadMap::Measured> loads;
    for (const Measured& part : parts) {
        slowness[part.child] /= mean;
        loads.push_back({part.part, part.region, part.milliseconds / slowness[part.child]});
    }
    map.record(loads);
}

}  // namespace eyrie::equalizer
