// SPDX-License-Identifier: Apache-2.0
#include "cli/imagery_facts.h"

#include <fmt/format.h>

namespace eyrie::cli {
namespace {

double texels(const terrain::ImagerySummary& imagery) {
    return static_cast<double>(imagery.columns) * static_cast<double>(imagery.rows);
}

/// Of covered texels: holes take next to nothing.
double bytesPerTexel(const terrain::ImagerySummary& imagery) {
    return static_cast<double>(imagery.bytes) / static_cast<double>(imagery.coveredTexels);
}

double coverage(const terrain::ImagerySummary& imagery) {
    return static_cast<double>(imagery.coveredTexels) / texels(imagery);
}

}  // namespace

JsonObject imageryJson(const terrain::ImagerySummary& imagery) {
    JsonObject json;
    json.count("columns", imagery.columns)
        .count("rows", imagery.rows)
        .number("coverage", coverage(imagery))
        .count("bytes", imagery.bytes)
        .number("bytesPerTexel", bytesPerTexel(imagery))
        .number("psnrDb", imagery.psnrDb);
    return json;
}

std::string imageryText(const terrain::ImagerySummary& imagery) {
    return fmt::format("{} x {} texels, {:.0f} % covered, BC1 of {:.2f} dB, {:.3f} bytes a texel",
                       imagery.columns, imagery.rows, 100 * coverage(imagery), imagery.psnrDb,
                       bytesPerTexel(imagery));
}

}  // namespace eyrie::cli
