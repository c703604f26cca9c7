// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

/// What a frame shows, held against the full-resolution source.
namespace eyrie::cli::bench {

/// One picture's errors. Displacements are of surface points, in pixels on the screen, from where
/// the source has them: measured by an independent ray caster (renderer/truth). Pixels are those of
/// the size asked for: errors of a picture drawn smaller are stretched with it.
struct FrameError {
    double seconds = 0;         ///< of the flight
    double promisedPixels = 0;  ///< tauAchieved
    double p50Pixels = 0;
    double p99Pixels = 0;
    double maxPixels = 0;
    std::size_t compared = 0;     ///< pixels
    std::size_t holes = 0;        ///< nothing drawn where the source is hit (edges excepted)
    std::size_t falseHits = 0;    ///< drawn where the source is not hit (edges excepted)
    std::size_t misplaced = 0;    ///< another surface shown than the front one (edges excepted)
    double silhouettePixels = 0;  ///< largest distance of a drawn outline from the source's
    /// Colour, against a picture of the same view drawn at JudgedFrames::finestTauPixels.
    double psnrDb = 0;
    double ssim = 1;
    double flip = 0;            ///< mean of FLIP (Andersson et al. 2020), 0 to 1
    std::size_t triangles = 0;  ///< and points
    double drawnTauPixels = 0;  ///< at which the cut was made, in pixels of the picture
    double stretch = 1;         ///< of the picture's pixels to those asked for
    bool complete = true;       ///< no coarser data stand for some that were not loaded yet
    /// Of several channels whose renderers may have drawn different data: these need not meet, and
    /// what is seen between them is a hole or misplaced.
    bool mayHaveSeams = false;
};

/// What rasterisation rounds, in pixels as they are drawn.
inline constexpr double kRasterPixels = 1.0 / 256;

/// Whether neither picture nor source shows anything: there is nothing to measure.
inline bool isEmpty(const FrameError& error) {
    return error.compared == 0 && error.holes == 0 && error.falseHits == 0 && error.misplaced == 0;
}

/// Whether away from outlines something is missing, too much, or shown before what hides it, but
/// between channels where there may be seams.
bool hasWrongPixels(const FrameError& error);

/// Whether a frame's surface is nowhere farther off than it promises, but for the 1/256 of its own
/// pixels that rasterisation rounds; and it has no wrong pixels.
bool keepsPromise(const FrameError& error);

/// A frame that came closest to its promise, or broke it: worth looking at. PNG files' bytes.
struct WorstFrame {
    FrameError error;
    std::string picturePng;
    std::string heatMapPng;  ///< displacement per pixel
};

/// One level of a model decimated uniformly: the same spacing everywhere, whatever the view.
struct UniformLevel {
    double triangles = 0;       ///< in view, mean of its pictures along the flight
    double trianglesWhole = 0;  ///< drawn where nothing out of view is left out
    double p99Pixels = 0;       ///< of these pictures, measured as those of a run are
    double maxPixels = 0;
};

/// Of a flight at one tau, or at one frame time.
struct MeasuredErrors {
    std::vector<FrameError> frames;
    std::vector<WorstFrame> worst;
};

}  // namespace eyrie::cli::bench
