// SPDX-License-Identifier: Apache-2.0
#include "bench/simulator/costs.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <ranges>
#include <sstream>
#include <utility>

#include <fmt/format.h>

#include "bench/simulator/text.h"
#include "fabric/status.h"

namespace eyrie::simulator {
namespace {

absl::StatusOr<std::vector<std::string>> linesOf(const std::string& path) {
    ASSIGN_OR_RETURN(std::string text, textOf(path));
    std::istringstream in(std::move(text));
    std::vector<std::string> lines;
    for (std::string line; std::getline(in, line);) {
        if (line.ends_with('\r'))  // as Windows ends lines
            line.pop_back();
        lines.push_back(line);
    }
    return lines;
}

std::vector<std::string> fieldsOf(const std::string& line) {
    std::vector<std::string> fields;
    std::istringstream in(line);
    for (std::string field; std::getline(in, field, ',');) fields.push_back(field);
    return fields;
}

absl::StatusOr<double> numberOf(const std::string& text, const std::string& path,
                                std::size_t line) {
    char* end = nullptr;
    const double value = std::strtod(text.c_str(), &end);
    if (end == text.c_str() || *end != '\0' || !std::isfinite(value) || value < 0)
        return absl::InvalidArgumentError(
            fmt::format("{}:{}: \"{}\" must be a number, 0 or more", path, line, text));
    return value;
}

}  // namespace

absl::StatusOr<Costs> readCosts(const std::string& path) {
    Costs costs;
    const std::map<std::string, double*> known = {
        {"task_ms", &costs.taskMs},
        {"million_triangles_ms", &costs.millionTrianglesMs},
        {"megapixel_ms", &costs.megapixelMs},
        {"readback_megapixel_ms", &costs.readbackMegapixelMs},
        {"assemble_megapixel_ms", &costs.assembleMegapixelMs},
        {"merge_megapixel_ms", &costs.mergeMegapixelMs},
        {"threads", &costs.threads},
        {"overlap", &costs.overlap},
        {"packed", &costs.packed}};
    std::map<std::string, double*> missing = known;
    ASSIGN_OR_RETURN(const std::vector<std::string> lines, linesOf(path));
    for (std::size_t i = 0; i < lines.size(); ++i) {
        if (lines[i].empty() || lines[i].front() == '#')
            continue;
        const std::vector<std::string> fields = fieldsOf(lines[i]);
        const auto found = fields.size() == 2 ? known.find(fields[0]) : known.end();
        if (found == known.end())
            return absl::InvalidArgumentError(
                fmt::format("{}:{}: \"{}\" is no cost that is known; a line is name,value", path,
                            i + 1, lines[i]));
        ASSIGN_OR_RETURN(*found->second, numberOf(fields[1], path, i + 1));
        missing.erase(fields[0]);
    }
    if (!missing.empty())
        return absl::InvalidArgumentError(
            fmt::format("{}: {} missing; give each a line name,value, as bench/data/costs.csv does",
                        path, fmt::join(std::views::keys(missing), ", ")));
    costs.threads = std::max(costs.threads, 1e-3);
    costs.overlap = std::min(costs.overlap, 1.0);
    return costs;
}

absl::StatusOr<std::vector<double>> readTriangles(const std::string& path) {
    ASSIGN_OR_RETURN(const std::vector<std::string> lines, linesOf(path));
    const std::vector<std::string> names =
        lines.empty() ? std::vector<std::string>{} : fieldsOf(lines.front());
    const auto column = [&](const char* name) -> absl::StatusOr<std::size_t> {
        const auto found = std::ranges::find(names, name);
        if (found == names.end())
            return absl::InvalidArgumentError(
                fmt::format("{}:1: no column \"{}\"; `eyrie bench` writes it", path, name));
        return static_cast<std::size_t>(found - names.begin());
    };
    ASSIGN_OR_RETURN(const std::size_t triangles, column("triangles"));
    ASSIGN_OR_RETURN(const std::size_t renderers, column("renderers"));
    ASSIGN_OR_RETURN(const std::size_t pass, column("pass"));
    std::vector<double> counts;
    for (std::size_t i = 1; i < lines.size(); ++i) {
        const std::vector<std::string> fields = fieldsOf(lines[i]);
        if (fields.size() <= std::max({triangles, renderers, pass}))
            return absl::InvalidArgumentError(
                fmt::format("{}:{}: the line ends before all columns", path, i + 1));
        ASSIGN_OR_RETURN(const double drawers, numberOf(fields[renderers], path, i + 1));
        ASSIGN_OR_RETURN(const double passes, numberOf(fields[pass], path, i + 1));
        ASSIGN_OR_RETURN(const double count, numberOf(fields[triangles], path, i + 1));
        if (drawers <= 1 && passes >= 1)
            counts.push_back(count);
    }
    if (counts.empty())
        return absl::InvalidArgumentError(
            fmt::format("{}: no measured pass of one renderer", path));
    return counts;
}

}  // namespace eyrie::simulator
