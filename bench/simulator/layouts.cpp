// SPDX-License-Identifier: Apache-2.0
#include "bench/simulator/layouts.h"

#include <bit>

#include <fmt/format.h>

#include "coordinator/config/frames_under_way.h"

namespace eyrie::simulator {
namespace {

std::string channelOf(int renderer) {
    return renderer == 0 ? std::string() : fmt::format("channel \"c{}\" ", renderer);
}

std::string range(int first, int end, int of) {
    return fmt::format("range [ {:.9f} {:.9f} ] ", static_cast<double>(first) / of,
                       static_cast<double>(end) / of);
}

/// Strip `index` of `count`, from below.
std::string strip(int index, int count) {
    return fmt::format("viewport [ 0 {:.9f} 1 {:.9f} ] ", static_cast<double>(index) / count,
                       1.0 / count);
}

/// Part `index` of a grid near square, which 2D cuts a picture into.
std::string tile(int index, int count) {
    int columns = 1;
    while (columns * columns < count || count % columns != 0) ++columns;
    const int rows = count / columns;
    const int row = index / columns;
    return fmt::format("viewport [ {:.9f} {:.9f} {:.9f} {:.9f} ] ",
                       static_cast<double>(index % columns) / columns,
                       static_cast<double>(row) / rows, 1.0 / columns, 1.0 / rows);
}

/// Each draws `share(i)` and sends it to the destination.
template <typename Share>
std::string gathered(int count, const Share& share) {
    std::string text;
    for (int i = 0; i < count; ++i)
        text += "compound { " + channelOf(i) + share(i) +
                (i == 0 ? "}\n" : fmt::format("outputframe {{ name \"f{0}\" }} }}\n", i));
    for (int i = 1; i < count; ++i) text += fmt::format("inputframe {{ name \"f{}\" }}\n", i);
    return text;
}

/// Each merges the strip of its own number of all others.
std::string directSend(int count) {
    std::string text;
    for (int i = 0; i < count; ++i) {
        text += "compound { " + channelOf(i) + "compound { " + range(i, i + 1, count);
        for (int to = 0; to < count; ++to)
            if (to != i)
                text +=
                    fmt::format("outputframe {{ name \"s{}.{}\" {}}} ", i, to, strip(to, count));
        text += "}\n";
        for (int of = 0; of < count; ++of)
            if (of != i)
                text += fmt::format("inputframe {{ name \"s{}.{}\" }} ", of, i);
        text += i == 0 ? "}\n"
                       : fmt::format("outputframe {{ name \"f{}\" buffer [ COLOR ] {}}} }}\n", i,
                                     strip(i, count));
    }
    for (int i = 1; i < count; ++i) text += fmt::format("inputframe {{ name \"f{}\" }}\n", i);
    return text;
}

/// In each of log2(count) stages two swap halves of what they have (Ma, Painter, Hansen, Krogh:
/// "Parallel Volume Rendering Using Binary-Swap Compositing", 1994).
std::string binarySwap(int count) {
    std::string text;
    for (int i = 0; i < count; ++i) {
        text += "compound { " + channelOf(i) + "\n";
        int mine = 0;  // strip of `parts`
        for (int parts = 2; parts <= count; parts *= 2) {
            const int partner = i ^ (parts / 2);
            const bool keepsUpper = i > partner;
            text += parts == 2 ? "compound { " + range(i, i + 1, count)
                               : fmt::format(
                                     "compound {{ task [ ASSEMBLE READBACK ] inputframe {{ "
                                     "name \"x{}.{}\" }} ",
                                     i ^ (parts / 4), parts / 2);
            text += fmt::format("outputframe {{ name \"x{}.{}\" {}}} }}\n", i, parts,
                                strip(2 * mine + (keepsUpper ? 0 : 1), parts));
            mine = 2 * mine + (keepsUpper ? 1 : 0);
        }
        text += fmt::format("inputframe {{ name \"x{}.{}\" }} ", i ^ (count / 2), count);
        text += i == 0 ? "}\n"
                       : fmt::format("outputframe {{ name \"f{}\" buffer [ COLOR ] {}}} }}\n", i,
                                     strip(mine, count));
    }
    for (int i = 1; i < count; ++i) text += fmt::format("inputframe {{ name \"f{}\" }}\n", i);
    return text;
}

std::string withResources(int renderers, int width, int height, int latency,
                          const std::string& compound) {
    std::string text = fmt::format("server {{ config {{ latency {} appNode {{\n", latency);
    for (int i = 0; i < renderers; ++i)
        text += fmt::format(
            "pipe {{ window {{ viewport [ 0 0 {} {} ] channel {{ name \"c{}\" }} }} }}\n", width,
            height, i);
    return text +
           "} layout { view { } } canvas { layout 0 segment { channel \"c0\" } }\n"
           "compound { channel ( segment 0 view 0 )\n" +
           compound + "} } }\n";
}

}  // namespace

std::vector<Layout> layoutsOf(int renderers, int width, int height) {
    const auto whole = [&](const std::string& compound, int latency = 0) {
        return withResources(renderers, width, height, latency, compound);
    };
    if (renderers == 1)
        return {{"one", whole("")}};
    const std::string depth = "buffer [ COLOR DEPTH ]\n";
    std::vector<Layout> layouts = {
        {"2D", whole(gathered(renderers, [&](int i) { return tile(i, renderers); }))},
        {"DB",
         whole(depth + gathered(renderers, [&](int i) { return range(i, i + 1, renderers); }))},
        {"direct send", whole(depth + directSend(renderers))}};
    if (std::has_single_bit(static_cast<unsigned>(renderers)))
        layouts.push_back({"binary swap", whole(depth + binarySwap(renderers))});
    layouts.push_back(
        {"DPlex",
         whole(gathered(renderers,
                        [&](int i) { return fmt::format("phase {} period {} ", i, renderers); }),
               static_cast<int>(config::framesUnderWay(renderers - 1)) - 1)});
    return layouts;
}

}  // namespace eyrie::simulator
