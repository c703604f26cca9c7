// SPDX-License-Identifier: Apache-2.0
#include "bench/decompositions/ways.h"

#include <functional>

#include <fmt/format.h>

namespace eyrie::bench {
namespace {

constexpr int kPipes = 4;

/// One child for each pipe.
std::string each(const std::function<std::string(int)>& child) {
    std::string text;
    for (int i = 0; i < kPipes; ++i) text += child(i);
    return text;
}

/// A child on channel i that does `share` of the work, in frame f<i>.
std::string shared(const std::function<std::string(int)>& share) {
    return each([&](int i) {
        return fmt::format("compound {{ channel \"c{}\" {} outputframe {{ name \"f{}\" }} }}\n", i,
                           share(i), i);
    });
}

std::string rangeOf(int i) { return fmt::format("range [ {} {} ]", i * .25, (i + 1) * .25); }

std::string columnOf(int i) { return fmt::format("viewport [ {} 0 .25 1 ]", i * .25); }

/// Each gets a quarter of the picture of all, in shares of the data, and hands it on.
std::string directSend() {
    return each([](int i) {
        std::string outputs;
        std::string inputs;
        for (int to = 0; to < kPipes; ++to) {
            if (to == i)
                continue;
            outputs += fmt::format("outputframe {{ name \"d{}.{}\" {} }} ", i, to, columnOf(to));
            inputs += fmt::format("inputframe {{ name \"d{}.{}\" }} ", to, i);
        }
        return fmt::format(
            "compound {{ channel \"c{0}\" compound {{ {1} {2} }} {3} "
            "outputframe {{ name \"f{0}\" {4} }} }}\n",
            i, rangeOf(i), outputs, inputs, columnOf(i));
    });
}

/// First neighbours exchange halves, then those two apart quarters.
std::string binarySwap() {
    return each([](int i) {
        const double half = (i & 1) * .5;
        const double quarter = half + ((i & 2) != 0 ? .25 : 0);
        const double others = half + ((i & 2) != 0 ? 0 : .25);
        return fmt::format(
            "compound {{ channel \"c{0}\" compound {{ compound {{ {1} "
            "outputframe {{ name \"h{0}\" viewport [ 0 {2} 1 .5 ] }} }} "
            "inputframe {{ name \"h{3}\" }} "
            "outputframe {{ name \"q{0}\" viewport [ 0 {4} 1 .25 ] }} }} "
            "inputframe {{ name \"q{5}\" }} "
            "outputframe {{ name \"f{0}\" viewport [ 0 {6} 1 .25 ] }} }}\n",
            i, rangeOf(i), .5 - half, i ^ 1, others, i ^ 2, quarter);
    });
}

/// Each adds its share to what comes from the one before.
std::string stream() {
    return each([](int i) {
        return fmt::format(
            "compound {{ channel \"c{0}\" compound {{ {1} }} {2} outputframe {{ name \"{3}\" }} "
            "}}\n",
            i, rangeOf(i), i == 0 ? "" : fmt::format("inputframe {{ name \"s{}\" }}", i - 1),
            i + 1 == kPipes ? "f0" : fmt::format("s{}", i));
    });
}

/// Two pairs of pipes, each a compound by `outer` whose two halves are cut by `inner`.
std::string nested(const std::function<std::string(int)>& outer,
                   const std::function<std::string(int)>& inner, bool takeTurns) {
    std::string text;
    for (int pair = 0; pair < 2; ++pair)
        text += fmt::format(
            "compound {{ channel \"c{0}\" {1} compound {{ {2} }} "
            "compound {{ channel \"c{3}\" {4} outputframe {{ name \"n{5}\" }} }} "
            "inputframe {{ name \"n{5}\" }} outputframe {{ name \"f{6}\" }} }}\n",
            2 * pair, outer(pair), inner(0), 2 * pair + 1, inner(1), pair, takeTurns ? 0 : pair);
    return text;
}

std::string halfRange(int i) { return fmt::format("range [ {} {} ]", i * .5, (i + 1) * .5); }

std::string halfViewport(int i) { return fmt::format("viewport [ {} 0 .5 1 ]", i * .5); }

std::string turn(int i) { return fmt::format("period 2 phase {}", i); }

std::string queue(const std::string& size) {
    return fmt::format("outputtiles {{ name \"queue\" size {} }}\n", size) +
           shared([](int) { return "inputtiles { name \"queue\" }"; });
}

std::string timeMultiplexed() {
    return each([](int i) {
        return fmt::format(
            "compound {{ channel \"c{0}\" period 4 phase {0} outputframe {{ name \"f0\" }} }}\n",
            i);
    });
}

std::string twoEyes() {
    return "compound { channel \"c0\" eye [ LEFT ] outputframe { name \"f0\" } }\n"
           "compound { channel \"c1\" eye [ RIGHT ] outputframe { name \"f1\" } }\n";
}

std::string zoomed(const char* by) {
    return fmt::format(
        "compound {{ channel \"c1\" zoom [ {0} {0} ] outputframe {{ name \"f0\" }} }}\n", by);
}

}  // namespace

std::vector<Way> allWays() {
    const auto pixel = [](int i) { return fmt::format("pixel [ {} {} 2 2 ]", i % 2, i / 2); };
    const auto subpixel = [](int i) { return fmt::format("subpixel [ {} 4 ]", i); };
    return {{"2D", Meaning::OneChannel, false, shared(columnOf)},
            {"DB", Meaning::OneChannel, false, shared(rangeOf)},
            {"direct-send", Meaning::OneChannel, false, directSend()},
            {"binary swap", Meaning::OneChannel, false, binarySwap()},
            {"stream", Meaning::OneChannel, false, stream()},
            {"DB of 2D", Meaning::OneChannel, false, nested(halfRange, halfViewport, false)},
            {"2D of DB", Meaning::OneChannel, false, nested(halfViewport, halfRange, false)},
            {"stereo", Meaning::OneChannel, true, twoEyes()},
            {"time-multiplex", Meaning::OneChannel, false, timeMultiplexed()},
            {"time-multiplex of 2D", Meaning::OneChannel, false, nested(turn, halfViewport, true)},
            {"tiles", Meaning::OneChannel, false, queue("[ 64 64 ]")},
            {"chunks", Meaning::OneChannel, false, queue(".125")},
            {"pixel", Meaning::EveryFourth, false, shared(pixel)},
            {"subpixel", Meaning::MeanOfFour, false, shared(subpixel)},
            {"zoom 2", Meaning::TwiceAsFine, false, zoomed("2")},
            {"zoom 0.5", Meaning::HalfAsFine, false, zoomed(".5")}};
}

std::string configurationOf(const std::vector<Way>& ways, int width, int height) {
    const std::string window = fmt::format("window {{ viewport [ 0 0 {} {} ] ", width, height);
    std::string text = "server { config { latency 3 appNode {\n";
    for (int i = 0; i < kPipes; ++i)
        text += fmt::format("pipe {{ {}{}channel {{ name \"c{}\" }} }} }}\n",
                            i == 0 ? window + "channel { name \"shown\" } } " : "", window, i);
    text += "}\nobserver { eye_base .06 }\n";
    std::string canvas = "canvas {\n";
    std::string compounds;
    for (const Way& way : ways) {
        text += fmt::format("layout {{ name \"{}\" view {{ observer 0 mode {} }} }}\n", way.name,
                            way.isStereo ? "STEREO" : "MONO");
        canvas += fmt::format("layout \"{}\" ", way.name);
        compounds += fmt::format(
            "compound {{ channel ( segment 0 layout \"{}\" view 0 ) buffer [ COLOR DEPTH ]\n{}"
            "inputframe {{ name \"f0\" }} inputframe {{ name \"f1\" }} "
            "inputframe {{ name \"f2\" }} inputframe {{ name \"f3\" }} }}\n",
            way.name, way.compounds);
    }
    return text + canvas + "\nsegment { channel \"shown\" } }\n" + compounds + "} }\n";
}

}  // namespace eyrie::bench
