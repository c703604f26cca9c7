// SPDX-License-Identifier: Apache-2.0
// Prints how good the shares of a load equalizer are: the figures of docs/benchmarks/farm.md.
#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include <fmt/format.h>

#include "tests/coordinator/balanced_scene.h"
#include "tests/coordinator/hot_tenths.h"

namespace {

using namespace eyrie;
using namespace eyrie::equalizer;

std::uniform_real_distribution<double> timesOff(double noise) {
    return std::uniform_real_distribution<double>(1 - noise, 1 + noise);
}

/// One of three renderers is ten times slower, load is even, and the first frame's times are
/// random. `within`: so many ms of 100 / 2.1, and for the slow one `slowWithin`.
void printSlowOne(const char* settings, double within, double slowWithin) {
    constexpr int kRuns = 2000, kFrames = 80;
    std::mt19937 random(7);
    std::exponential_distribution<double> loading(.2);
    int after20 = 0, after60 = 0, latest = 0;
    for (int run = 0; run < kRuns; ++run) {
        Balanced balanced = loadBalanced(3, settings);
        balanced.draw([&](const auto&) { return loading(random); });
        int there = 0;  // the frames before the first from which on all are within
        for (int frame = 0; frame < kFrames; ++frame) {
            const auto ms = balanced.draw([&](const config::ResolvedCompound& part) {
                return (&part == &balanced.at(2) ? 10 : 1) * Spot{{0, 0, 1, 1}}(part);
            });
            if (std::abs(ms[1] - 100 / 2.1) > within || std::abs(ms[2] - 100 / 2.1) > slowWithin)
                there = frame + 1;
        }
        after20 += there > 20 ? 1 : 0;
        after60 += there > 60 ? 1 : 0;
        latest = std::max(latest, there);
    }
    fmt::print(
        "{:28} there after {} frames at most; not after 20: {:.1f} %, not after 60: {:.1f} %\n",
        settings, latest, 100. * after20 / kRuns, 100. * after60 / kRuns);
}

/// Nine tenths of the load in a tenth of the whole, and one renderer so many times slower.
void printHotTenths(double slower, double noise) {
    double sum = 0, worst = 0;
    int frames = 0, above = 0;
    for (unsigned seed = 1; seed <= 3; ++seed) {
        std::mt19937 random(seed);
        auto off = timesOff(noise);
        for (const auto& [mode, hot] : kHotTenths)
            for (int count = 2; count <= 8; ++count) {
                Balanced balanced = loadBalanced(count, std::string("mode ") + mode);
                const Spot spot{hot};
                const double best = spot.total() / (count - 1 + 1 / slower);
                const auto slow = 1 + random() % static_cast<unsigned>(count);
                for (int frame = 0; frame <= 40; ++frame) {
                    double longest = 0;
                    balanced.draw([&](const config::ResolvedCompound& part) {
                        const double ms = spot(part) * (&part == &balanced.at(slow) ? slower : 1);
                        longest = std::max(longest, ms);
                        return ms * off(random);
                    });
                    if (frame <= 20)
                        continue;
                    ++frames;
                    sum += longest / best;
                    above += longest / best > 1.15 ? 1 : 0;
                    worst = std::max(worst, longest / best);
                }
            }
    }
    fmt::print(
        "{:2} times slower, times {:2.0f} % off: {:.3f} of the best, {:.1f} % above 15 %, at worst "
        "{:.2f}\n",
        slower, 100 * noise, sum / frames, 100. * above / frames, worst);
}

}  // namespace

int main() {
    printSlowOne("mode DB", 4, 20);
    printSlowOne("mode 2D", 4, 20);
    printSlowOne("mode 2D boundary [ 31 31 ]", 4, 26);
    for (const double noise : {0., .1, .2}) printHotTenths(1, noise);
    printHotTenths(2, .1);
    printHotTenths(4, .1);
    printHotTenths(10, 0);
    printHotTenths(10, .1);
}
