// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/mesh_sharing.h"

#include <algorithm>
#include <tuple>
#include <unordered_map>
#include <utility>

#include <oneapi/tbb/parallel_sort.h>

namespace eyrie::import {
namespace {

/// A position that a part has.
struct PartPoint {
    std::uint64_t position = 0;
    std::uint64_t part = 0;
};

/// Rows at the end of a file.
template <typename Row>
struct Appended {
    RowFile<Row> file;
    std::uint64_t count = 0;
    std::vector<Row> pending = {};

    absl::Status add(const Row& row) {
        pending.push_back(row);
        return pending.size() * sizeof(Row) < kRowBufferBytes ? absl::OkStatus() : flush();
    }
    absl::Status flush() {
        RETURN_IF_ERROR(file.write(count, pending));
        count += pending.size();
        pending.clear();
        return absl::OkStatus();
    }
};

std::size_t groupOf(std::uint64_t position, std::size_t groups) {
    return (position * 0x9E3779B97F4A7C15ULL >> 32) % groups;
}

/// Each position of each part once.
absl::StatusOr<Appended<PartPoint>> pointsOf(const MeshSplit& split, const std::string& outPath,
                                             const ImportControl& control) {
    ASSIGN_OR_RETURN(auto file, RowFile<PartPoint>::create(outPath));
    Appended<PartPoint> points{std::move(file)};
    for (std::size_t part = 0; part < split.parts.size(); ++part) {
        RETURN_IF_ERROR(control.check());
        control.report("borders",
                       0.5 * static_cast<double>(part) / static_cast<double>(split.parts.size()));
        const SplitNode& node = split.part(part);
        std::vector<std::uint64_t> positions;
        positions.reserve(3 * (node.end - node.begin));
        RETURN_IF_ERROR(split.triangles[node.file].forBlocks(
            node.begin, node.end, [&](std::span<const SpooledTriangle> block) {
                for (const SpooledTriangle& row : block)
                    positions.insert(positions.end(), row.positions.begin(), row.positions.end());
                return absl::OkStatus();
            }));
        oneapi::tbb::parallel_sort(positions.begin(), positions.end());
        positions.erase(std::unique(positions.begin(), positions.end()), positions.end());
        for (const std::uint64_t position : positions)
            RETURN_IF_ERROR(points.add({position, part}));
    }
    RETURN_IF_ERROR(points.flush());
    return points;
}

/// Those that more than one part has: a row for each two of them, either way.
absl::Status addShared(std::vector<PartPoint> points, Appended<SharedPoint>& shared) {
    oneapi::tbb::parallel_sort(
        points.begin(), points.end(), [](const PartPoint& a, const PartPoint& b) {
            return std::tie(a.position, a.part) < std::tie(b.position, b.part);
        });
    for (std::size_t begin = 0, end = 0; begin < points.size(); begin = end) {
        while (end < points.size() && points[end].position == points[begin].position) ++end;
        for (std::size_t i = begin; i < end && end - begin > 1; ++i)
            for (std::size_t j = begin; j < end; ++j)
                if (i != j)
                    RETURN_IF_ERROR(
                        shared.add({points[i].position, static_cast<std::uint32_t>(points[i].part),
                                    static_cast<std::uint32_t>(points[j].part)}));
    }
    return absl::OkStatus();
}

absl::StatusOr<GroupedRows<SharedPoint>> sharedPoints(const MeshSplit& split, std::uint64_t atOnce,
                                                      const std::string& outPath,
                                                      const ImportControl& control) {
    ASSIGN_OR_RETURN(const Appended<PartPoint> points, pointsOf(split, outPath, control));
    const std::size_t groups = static_cast<std::size_t>(points.count / atOnce) + 1;
    ASSIGN_OR_RETURN(
        const auto byPlace,
        groupRows(
            points.file, points.count, groups,
            [&](const PartPoint& point) { return groupOf(point.position, groups); }, outPath));
    ASSIGN_OR_RETURN(auto file, RowFile<SharedPoint>::create(outPath));
    Appended<SharedPoint> shared{std::move(file)};
    for (std::size_t group = 0; group < groups; ++group) {
        RETURN_IF_ERROR(control.check());
        ASSIGN_OR_RETURN(std::vector<PartPoint> all, byPlace.read(group));
        RETURN_IF_ERROR(addShared(std::move(all), shared));
    }
    RETURN_IF_ERROR(shared.flush());
    return groupRows(
        shared.file, shared.count, split.parts.size(),
        [](const SharedPoint& point) { return point.part; }, outPath);
}

/// The other parts at the positions of one.
class Neighbours {
public:
    explicit Neighbours(const std::vector<SharedPoint>& points) : isShared_(kBits, false) {
        for (const SharedPoint& point : points) {
            others_[point.position].push_back(point.other);
            isShared_[placeOf(point.position)] = true;
        }
    }

    /// Each once, ascending, into `hosts`.
    void of(const SpooledTriangle& triangle, std::vector<std::uint32_t>& hosts) const {
        hosts.clear();
        for (const std::uint64_t position : triangle.positions)
            if (isShared_[placeOf(position)])
                if (const auto found = others_.find(position); found != others_.end())
                    hosts.insert(hosts.end(), found->second.begin(), found->second.end());
        std::sort(hosts.begin(), hosts.end());
        hosts.erase(std::unique(hosts.begin(), hosts.end()), hosts.end());
    }

private:
    static constexpr std::size_t kBits = std::size_t{1} << 24;
    static std::size_t placeOf(std::uint64_t position) { return groupOf(position, kBits); }

    std::unordered_map<std::uint64_t, std::vector<std::uint32_t>> others_;
    std::vector<bool> isShared_;  ///< by place: most positions are told from this
};

absl::StatusOr<GroupedRows<Guest>> guestsOf(const MeshSplit& split,
                                            const GroupedRows<SharedPoint>& points,
                                            const std::string& outPath,
                                            const ImportControl& control) {
    ASSIGN_OR_RETURN(auto file, RowFile<Guest>::create(outPath));
    Appended<Guest> guests{std::move(file)};
    std::vector<std::uint32_t> hosts;
    for (std::uint32_t part = 0; part < split.parts.size(); ++part) {
        RETURN_IF_ERROR(control.check());
        control.report("borders", 0.5 + 0.5 * part / static_cast<double>(split.parts.size()));
        ASSIGN_OR_RETURN(const std::vector<SharedPoint> own, points.read(part));
        const Neighbours neighbours(own);
        const SplitNode& node = split.part(part);
        const auto addAll = [&](std::span<const SpooledTriangle> block) {
            for (const SpooledTriangle& row : block) {
                neighbours.of(row, hosts);
                for (const std::uint32_t host : hosts)
                    RETURN_IF_ERROR(guests.add({row, part, host}));
            }
            return absl::OkStatus();
        };
        RETURN_IF_ERROR(split.triangles[node.file].forBlocks(node.begin, node.end, addAll));
    }
    RETURN_IF_ERROR(guests.flush());
    return groupRows(
        guests.file, guests.count, split.parts.size(),
        [](const Guest& guest) { return guest.host; }, outPath);
}

}  // namespace

absl::StatusOr<MeshSharing> findSharing(const MeshSplit& split, std::uint64_t atOnce,
                                        const std::string& outPath, const ImportControl& control) {
    control.report("borders", 0);
    ASSIGN_OR_RETURN(auto points, sharedPoints(split, atOnce, outPath, control));
    ASSIGN_OR_RETURN(auto guests, guestsOf(split, points, outPath, control));
    control.report("borders", 1);
    return MeshSharing{std::move(points), std::move(guests)};
}

}  // namespace eyrie::import
