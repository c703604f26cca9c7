// SPDX-License-Identifier: Apache-2.0
#include "renderer/draw/node_work.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>

namespace eyrie::draw {
namespace {

/// Of what the nodes cover together, each way.
constexpr int kCells = 32;

/// A node's box on the screen.
struct Silhouette {
    fabric::PixelViewport pixels;
    double nearest;  ///< depth along the view
    double farthest;
};

Silhouette silhouetteOf(const lod::ObjectView& view, const fabric::Box& box) {
    const fabric::Box seen = fabric::transformed(box, view.viewFromObject());
    return {view.coveredPixels(box), -seen.max.z, -seen.min.z};
}

/// For each cell, how far the nearest box reaches.
class Cells {
public:
    explicit Cells(std::span<const Silhouette> all) {
        reach_.fill(std::numeric_limits<double>::infinity());
        for (const Silhouette& one : all) area_ = enclosing(area_, one.pixels);
        for (const Silhouette& one : all)
            forEach(one, [&](double& reach) { reach = std::min(reach, one.farthest); });
    }

    /// What of a node's cells it is not hidden in.
    double shareSeen(const Silhouette& one) {
        int all = 0;
        int seen = 0;
        forEach(one, [&](const double& reach) {
            ++all;
            seen += one.nearest <= reach ? 1 : 0;
        });
        return all > 0 ? static_cast<double>(seen) / all : 0;
    }

private:
    static int cellOf(int pixel, int begin, int length) {
        const std::int64_t cell = std::int64_t{pixel - begin} * kCells / std::max(length, 1);
        return static_cast<int>(std::clamp<std::int64_t>(cell, 0, kCells - 1));
    }

    template <typename Visit>
    void forEach(const Silhouette& one, const Visit& visit) {
        const fabric::PixelViewport& pixels = one.pixels;
        if (pixels.isEmpty())
            return;
        const int left = cellOf(pixels.x, area_.x, area_.width);
        const int right = cellOf(pixels.x + pixels.width - 1, area_.x, area_.width);
        const int top = cellOf(pixels.y + pixels.height - 1, area_.y, area_.height);
        for (int y = cellOf(pixels.y, area_.y, area_.height); y <= top; ++y)
            for (int x = left; x <= right; ++x)
                visit(reach_[static_cast<std::size_t>(y * kCells + x)]);
    }

    fabric::PixelViewport area_;
    std::array<double, std::size_t{kCells} * kCells> reach_;
};

}  // namespace

std::vector<double> workOf(const mesh::EymFile& file, const lod::ObjectView& view,
                           std::span<const CutNode> nodes) {
    std::vector<Silhouette> silhouettes;
    silhouettes.reserve(nodes.size());
    for (const CutNode& node : nodes)
        silhouettes.push_back(silhouetteOf(view, file.bounds(node.node)));
    Cells cells(silhouettes);
    std::vector<double> work;
    work.reserve(nodes.size());
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        const std::uint32_t triangles = file.nodes()[nodes[i].node].indexCount / 3;
        const double elements = nodes[i].points > 0 ? nodes[i].points : triangles;
        work.push_back(elements * (1 + (kWorkOfSeen - 1) * cells.shareSeen(silhouettes[i])));
    }
    return work;
}

}  // namespace eyrie::draw
