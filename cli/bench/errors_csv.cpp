// SPDX-License-Identifier: Apache-2.0
#include "cli/bench/errors_csv.h"

#include <fmt/format.h>

namespace eyrie::cli::bench {
namespace {

std::string lineOf(const BenchRun& run, const FrameError& e) {
    return fmt::format(
        "{},{},{},{:.3f},{},{},{},{},{},{},{},{},{:.2f},{:.2f},{:.5f},{:.5f},{},{},{:.4f},{:d}\n",
        run.label, run.tauPixels, run.renderers, e.seconds, e.promisedPixels, e.p50Pixels,
        e.p99Pixels, e.maxPixels, e.compared, e.holes, e.falseHits, e.misplaced, e.silhouettePixels,
        e.psnrDb, e.ssim, e.flip, e.triangles, e.drawnTauPixels, e.stretch, e.complete);
}

}  // namespace

std::string errorsCsv(const std::vector<BenchRun>& runs) {
    std::string lines;
    for (const BenchRun& run : runs)
        if (run.measured)
            for (const FrameError& error : run.measured->frames) lines += lineOf(run, error);
    if (lines.empty())
        return {};
    return "asked,tau,renderers,seconds,promisedPx,p50Px,p99Px,maxPx,compared,holes,falseHits,"
           "misplaced,silhouettePx,psnrDb,ssim,flip,triangles,drawnTau,stretch,complete\n" +
           lines;
}

}  // namespace eyrie::cli::bench
