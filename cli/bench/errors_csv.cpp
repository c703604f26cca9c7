// SPDX-License-Identifier: Apache-2.0
#include "cli/bench/errors_csv.h"

#include <fmt/format.h>

namespace eyrie::cli::bench {

std::string errorsCsvHead() {
    return "tau,seconds,promised_px,p50_px,p99_px,max_px,compared,holes,false_hits,misplaced,"
           "silhouette_px,psnr_db,ssim,flip,triangles\n";
}

std::string errorsCsv(double tauPixels, const MeasuredErrors& measured) {
    std::string csv;
    for (const FrameError& e : measured.frames)
        csv += fmt::format("{},{:.3f},{},{},{},{},{},{},{},{},{:.2f},{:.2f},{:.5f},{:.5f},{}\n",
                           tauPixels, e.seconds, e.promisedPixels, e.p50Pixels, e.p99Pixels,
                           e.maxPixels, e.compared, e.holes, e.falseHits, e.misplaced,
                           e.silhouettePixels, e.psnrDb, e.ssim, e.flip, e.triangles);
    return csv;
}

}  // namespace eyrie::cli::bench
