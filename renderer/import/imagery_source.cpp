// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/imagery_source.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <set>
#include <utility>

#include <fmt/format.h>
#include <glm/common.hpp>

#include "fabric/status.h"
#include "renderer/import/colour_file.h"
#include "renderer/import/colour_warp.h"
#include "renderer/import/layered_dems.h"
#include "renderer/import/raster_file.h"

namespace eyrie::import {
namespace {

using terrain::TexelRect;
using terrain::TexturePyramid;

/// A texel may be this many octaves larger than the shorter side of the finest picture's
/// pixel: 2^(1/4).
constexpr double kOctavesOfSlack = 0.25;
constexpr double kEquallyFine = 0.01;

struct Layer {
    ColourFile file;
    ColourPlace place;
    Dataset warped;  ///< its texels of `box`
    TexelRect box;   ///< of the finest level
};

class LayeredImagery : public ImagerySource {
public:
    /// Best layer first, over `frame`.
    LayeredImagery(std::vector<Layer> layers, const TexturePyramid& pyramid,
                   const terrain::GridFrame& frame, std::uint64_t readingBytes)
        : layers_(std::move(layers)),
          pyramid_(pyramid),
          readingBytes_(readingBytes),
          isLastRowFirst_(frame.perRow.y > 0),
          seenColumns_(middlesWithin(frame.columns, pyramid)),
          seenRows_(middlesWithin(frame.rows, pyramid)) {}

    const TexturePyramid& pyramid() const override { return pyramid_; }
    bool isLastRowFirst() const override { return isLastRowFirst_; }
    std::uint64_t readingBytes() const override { return readingBytes_; }

    bool mayHave(const TexelRect& window) const override {
        const TexelRect inside = withinLevel(window);
        return std::ranges::any_of(layers_, [&](const Layer& layer) {
            const TexelRect part = intersection(inside, layer.box);
            return part.columns > 0 && part.rows > 0;
        });
    }

    absl::Status read(const TexelRect& window, std::span<fabric::Rgba> out) override {
        std::fill(out.begin(), out.end(), fabric::Rgba{0, 0, 0, 0});
        const TexelRect inside = withinLevel(window);
        for (const Layer& layer : layers_) {
            const TexelRect part = intersection(inside, layer.box);
            if (part.columns > 0 && part.rows > 0)
                RETURN_IF_ERROR(add(layer, part, window, out.data()));
        }
        coverRim(inside, window, out.data());
        repeatBorder(inside, window, out.data());
        return absl::OkStatus();
    }

    std::vector<std::string> findings() const override { return findings_; }

private:
    /// Texels over so many posts whose middle lies before the last of them.
    static std::int64_t middlesWithin(std::int32_t posts, const TexturePyramid& pyramid) {
        return std::llround(std::ceil((posts - 1) / pyramid.texelPosts(0) - 0.5));
    }

    static TexelRect intersection(const TexelRect& a, const TexelRect& b) {
        const std::int64_t x = std::max(a.x, b.x);
        const std::int64_t y = std::max(a.y, b.y);
        return {x, y,
                static_cast<std::int32_t>(
                    std::max<std::int64_t>(0, std::min(a.x + a.columns, b.x + b.columns) - x)),
                static_cast<std::int32_t>(
                    std::max<std::int64_t>(0, std::min(a.y + a.rows, b.y + b.rows) - y))};
    }

    TexelRect withinLevel(const TexelRect& window) const {
        return intersection(window, {0, 0, static_cast<std::int32_t>(pyramid_.width(0)),
                                     static_cast<std::int32_t>(pyramid_.height(0))});
    }

    /// Fills in what has no better picture so far.
    absl::Status add(const Layer& layer, const TexelRect& part, const TexelRect& window,
                     fabric::Rgba* out) {
        constexpr int kBands = 4;
        buffer_.resize(static_cast<std::size_t>(part.columns) *
                       static_cast<std::size_t>(part.rows));
        QuietGdal gdal;
        if (GDALDatasetRasterIO(layer.warped.get(), GF_Read, static_cast<int>(part.x - layer.box.x),
                                static_cast<int>(part.y - layer.box.y), part.columns, part.rows,
                                buffer_.data(), part.columns, part.rows, GDT_Byte, kBands, nullptr,
                                kBands, kBands * part.columns, 1) != CE_None)
            return absl::DataLossError(fmt::format("{}: its pixels cannot be read ({}); {}",
                                                   layer.file.path, gdal.takeError(),
                                                   whyUnreadable(layer.file.path)));
        note(layer.file.path, gdal.takeWarning());
        const fabric::Rgba* from = buffer_.data();
        for (std::int32_t v = 0; v < part.rows; ++v) {
            fabric::Rgba* to = out + (part.y + v - window.y) * window.columns + (part.x - window.x);
            for (std::int32_t u = 0; u < part.columns; ++u, ++to, ++from)
                if (to->a < 128 && from->a > to->a)
                    *to = *from;
        }
        return absl::OkStatus();
    }

    /// The first of each picture.
    void note(const std::string& path, const std::string& warning) {
        if (!warning.empty() && warned_.insert(path).second)
            findings_.push_back(fmt::format(
                "{}: some of its pixels may be wrong ({}); look at them, or have it made anew",
                path, warning));
    }

    /// The last texels' middles may lie beyond the last posts, where a picture of all of the
    /// terrain need not reach: these are what is beside them.
    void coverRim(const TexelRect& inside, const TexelRect& window, fabric::Rgba* out) const {
        const auto at = [&](std::int64_t x, std::int64_t y) -> fabric::Rgba& {
            return out[(y - window.y) * window.columns + (x - window.x)];
        };
        const auto cover = [](fabric::Rgba& texel, const fabric::Rgba& beside) {
            if (texel.a < 128)
                texel = beside;
        };
        const std::int64_t endX = inside.x + inside.columns;
        const std::int64_t endY = inside.y + inside.rows;
        if (endX > seenColumns_ && inside.x < seenColumns_)
            for (std::int64_t y = inside.y; y < endY; ++y) cover(at(endX - 1, y), at(endX - 2, y));
        if (endY > seenRows_ && inside.y < seenRows_)
            for (std::int64_t x = inside.x; x < endX; ++x) cover(at(x, endY - 1), at(x, endY - 2));
    }

    /// Precondition: `inside` is not empty.
    static void repeatBorder(const TexelRect& inside, const TexelRect& window, fabric::Rgba* out) {
        const std::int64_t left = inside.x - window.x;
        const std::int64_t top = inside.y - window.y;
        for (std::int64_t v = top; v < top + inside.rows; ++v) {
            fabric::Rgba* const row = out + v * window.columns;
            std::fill(row, row + left, row[left]);
            std::fill(row + left + inside.columns, row + window.columns,
                      row[left + inside.columns - 1]);
        }
        for (std::int64_t v = 0; v < window.rows; ++v) {
            const std::int64_t source = std::clamp(v, top, top + inside.rows - 1);
            if (source != v)
                std::copy_n(out + source * window.columns, window.columns,
                            out + v * window.columns);
        }
    }

    std::vector<Layer> layers_;
    TexturePyramid pyramid_;
    std::uint64_t readingBytes_;
    bool isLastRowFirst_;       ///< pictures begin in the north; so do rows that go towards lower y
    std::int64_t seenColumns_;  ///< whose middles lie within the terrain: all, or all but the last
    std::int64_t seenRows_;
    std::vector<fabric::Rgba> buffer_;
    std::set<std::string> warned_;  ///< paths
    std::vector<std::string> findings_;
};

/// Lays pictures over a terrain.
class Overlay {
public:
    Overlay(const terrain::GridFrame& frame, const std::string& crsWkt) {
        grid_.frame = frame;
        if (crsWkt.empty())
            return;
        grid_.crs.reset(OSRNewSpatialReference(crsWkt.c_str()));
        OSRSetAxisMappingStrategy(grid_.crs.get(), OAMS_TRADITIONAL_GIS_ORDER);
        const double metres = OSRGetLinearUnits(grid_.crs.get(), nullptr);
        grid_.frame.origin /= metres;
        grid_.frame.perColumn /= metres;
        grid_.frame.perRow /= metres;
    }

    absl::Status add(const std::string& path) {
        ASSIGN_OR_RETURN(ColourFile file, openColourFile(path, gdal_));
        if (!file.isGeoreferenced)
            notes_.push_back(
                fmt::format("{} is not georeferenced: stretched over the whole terrain", path));
        else if (file.crs && !grid_.crs)
            return invalid(path,
                           "has a CRS but the terrain has none; give the elevation model its "
                           "own (gdal_edit.py -a_srs) and import it again");
        else if (!file.crs && grid_.crs)
            notes_.push_back(fmt::format("{} has no CRS: taken to be in the terrain's", path));
        ASSIGN_OR_RETURN(const ColourPlace place, placeOf(file, grid_, gdal_));
        if (place.isCutOff)
            notes_.push_back(fmt::format(
                "{}: a part of it is left out, as where a map goes on past 180 degrees; cut it "
                "there (gdal_translate -projwin) and move what lies beyond by a turn (-a_ullr)",
                path));
        const fabric::Vec2 last(grid_.frame.columns - 1, grid_.frame.rows - 1);
        names_ += (names_.empty() ? "" : ", ") + path;
        const bool overlaps =
            place.low.x < last.x && place.low.y < last.y && place.high.x > 0 && place.high.y > 0;
        if (overlaps) {
            layers_.push_back({std::move(file), place, nullptr, {}});
            return absl::OkStatus();
        }
        notes_.insert(notes_.end(), file.notes.begin(), file.notes.end());
        notes_.push_back(fmt::format("{} lies beside the terrain; it is left out", path));
        return absl::OkStatus();
    }

    absl::StatusOr<OpenImagery> open(std::uint64_t memoryBytes, const ImportControl& control) {
        if (layers_.empty())
            return absl::InvalidArgumentError(fmt::format(
                "{}: no picture overlaps the terrain; check their coordinates and CRS (gdalinfo)",
                names_));
        ASSIGN_OR_RETURN(const std::uint64_t whole, wholeBytes(memoryBytes));
        RETURN_IF_ERROR(findMostOfAll(control));
        RETURN_IF_ERROR(turnAllToBytes());
        for (const Layer& layer : layers_)
            notes_.insert(notes_.end(), layer.file.notes.begin(), layer.file.notes.end());
        sortByRank();
        const double octaves = -std::log2(layers_.front().place.pixelPosts) - kOctavesOfSlack;
        const int shift = std::max(static_cast<int>(std::ceil(octaves)), coarsestShift());
        if (!TexturePyramid::isPossible(grid_.frame.columns, grid_.frame.rows, shift))
            return absl::ResourceExhaustedError(fmt::format(
                "{}: its pixels are {:.3g} of a post, too fine for {} x {} posts (at most {} "
                "texels a post, and {} tiles of {} squared in all); thin it out (gdal_translate "
                "-outsize), or import a part of the terrain",
                layers_.front().file.path, layers_.front().place.pixelPosts, grid_.frame.columns,
                grid_.frame.rows, 1 << terrain::kMaxTexelShift, terrain::kMaxTextureTiles,
                terrain::kTextureSide));
        const TexturePyramid pyramid(grid_.frame.columns, grid_.frame.rows, shift);
        for (Layer& layer : layers_) {
            layer.box = boxOf(layer.place, pyramid);
            ASSIGN_OR_RETURN(layer.warped, warpedTo(layer.file, grid_, shift, layer.box, gdal_));
        }
        // What the cache grows by is taken twice, and as much is left to others.
        const std::uint64_t most = (memoryBytes - std::min(memoryBytes, whole)) / 3;
        ASSIGN_OR_RETURN(const std::uint64_t strips, readStripsInOrder(shift, most));
        notes_.push_back(fmt::format("imagery of {} x {} texels, 2^{} a post", pyramid.width(0),
                                     pyramid.height(0), shift));
        return OpenImagery{std::make_unique<LayeredImagery>(std::move(layers_), pyramid,
                                                            grid_.frame, whole + strips),
                           std::move(notes_)};
    }

private:
    /// That GDAL's cache has for strips anyway.
    static constexpr std::uint64_t kRoom = kGdalCacheBytes / 2;

    /// Bytes of memory for pictures that are decoded whole. ResourceExhausted where that is more
    /// than there is.
    absl::StatusOr<std::uint64_t> wholeBytes(std::uint64_t memoryBytes) const {
        const ColourFile* largest = &layers_.front().file;
        std::uint64_t all = 0;
        int pictures = 0;
        for (const Layer& layer : layers_) {
            const ColourFile& file = layer.file;
            all += file.wholeBytes;
            pictures += file.wholeBytes > 0 ? 1 : 0;
            if (file.wholeBytes > largest->wholeBytes)
                largest = &file;
        }
        if (all <= memoryBytes + kRoom)
            return all;
        return absl::ResourceExhaustedError(fmt::format(
            "{}: can only be decoded whole{}, which takes {} MB of memory, and --memory leaves {} "
            "MB; allow more, or store it in tiles first (gdal_translate -co TILED=YES)",
            largest->path,
            pictures > 1 ? fmt::format(", as {} more of the pictures", pictures - 1) : "",
            (all >> 20) + 1, memoryBytes >> 20));
    }

    absl::Status findMostOfAll(const ImportControl& control) {
        for (std::size_t k = 0; k < layers_.size(); ++k)
            RETURN_IF_ERROR(findMost(layers_[k].file, [&](double fraction) {
                control.report(
                    "looking for the brightest",
                    (static_cast<double>(k) + fraction) / static_cast<double>(layers_.size()));
                return control.check();
            }));
        return absl::OkStatus();
    }

    /// By the brightest of all.
    absl::Status turnAllToBytes() {
        double most = 0;
        const ColourFile* any = nullptr;
        for (const Layer& layer : layers_)
            if (layer.file.brightest) {
                most = std::max(most, *layer.file.brightest);
                any = &layer.file;
            }
        if (any != nullptr && !(most > 0))
            return invalid(any->path, "has no pixel above 0; is it the picture you mean?");
        for (Layer& layer : layers_)
            if (layer.file.brightest)
                turnToBytes(layer.file, most);
        return absl::OkStatus();
    }

    /// The finest first; of those hardly coarser than the finest of them, the one named last.
    void sortByRank() {
        std::vector<double> sizes;
        for (const Layer& layer : layers_) sizes.push_back(layer.place.pixelPosts);
        std::sort(sizes.begin(), sizes.end());
        std::vector<double> finest;  // of each group
        for (const double size : sizes)
            if (finest.empty() || finest.back() < size * (1 - kEquallyFine))
                finest.push_back(size);
        const auto group = [&](const Layer& layer) {
            return std::upper_bound(finest.begin(), finest.end(), layer.place.pixelPosts);
        };
        std::reverse(layers_.begin(), layers_.end());
        std::stable_sort(layers_.begin(), layers_.end(),
                         [&](const Layer& a, const Layer& b) { return group(a) < group(b); });
    }

    /// Of texels no larger than the terrain, so that one has its middle there.
    int coarsestShift() const {
        const int cells = std::min(grid_.frame.columns, grid_.frame.rows) - 1;
        return std::max(terrain::kMinTexelShift, -static_cast<int>(std::log2(cells)));
    }

    /// The texels that a picture may cover.
    static TexelRect boxOf(const ColourPlace& place, const TexturePyramid& pyramid) {
        const double texels = std::exp2(pyramid.texelShift());
        const fabric::Vec2 size(static_cast<double>(pyramid.width(0)),
                                static_cast<double>(pyramid.height(0)));
        const fabric::Vec2 low =
            glm::clamp(glm::floor(place.low * texels) - 1.0, fabric::Vec2(0.0), size - 1.0);
        const fabric::Vec2 high = glm::clamp(glm::ceil(place.high * texels) + 1.0, low + 1.0, size);
        return {static_cast<std::int64_t>(low.x), static_cast<std::int64_t>(low.y),
                static_cast<std::int32_t>(high.x - low.x),
                static_cast<std::int32_t>(high.y - low.y)};
    }

    /// Returns the bytes of memory that takes.
    absl::StatusOr<std::uint64_t> readStripsInOrder(int shift, std::uint64_t most) {
        std::vector<int> rows(layers_.size());
        std::vector<std::uint64_t> bytes(layers_.size());
        for (std::size_t k = 0; k < layers_.size(); ++k) {
            const Layer& layer = layers_[k];
            const std::uint64_t rowBytes = stripRowBytes(layer.file);
            if (rowBytes == 0)
                continue;
            ASSIGN_OR_RETURN(rows[k], rowsAtOnce(layer.file, grid_, shift, layer.box, gdal_));
            bytes[k] = rowBytes * static_cast<std::uint64_t>(rows[k]);
        }
        const std::uint64_t all = std::accumulate(bytes.begin(), bytes.end(), std::uint64_t{0});
        const std::uint64_t more = std::min(std::max(all, kRoom) - kRoom, most);
        GDALSetCacheMax64(static_cast<GIntBig>(kGdalCacheBytes + more));
        for (std::size_t k = 0; k < layers_.size(); ++k)
            if (bytes[k] <= kRoom + more)
                readInOrder(layers_[k].file, rows[k]);
            else
                notes_.push_back(fmt::format(
                    "{}: is stored row by row, of which {} MB are needed at a time, and --memory "
                    "leaves {} MB: it is decoded again and again; allow more, or store it in tiles "
                    "first (gdal_translate -co TILED=YES)",
                    layers_[k].file.path, (bytes[k] >> 20) + 1, (kRoom + more) >> 20));
        // Their small blocks leave gaps in the heap, about as much again: measured.
        return more + std::min(all, kRoom + more);
    }

    QuietGdal gdal_;
    TexelGrid grid_;
    std::vector<Layer> layers_;
    std::vector<std::string> notes_;
    std::string names_;
};

}  // namespace

absl::StatusOr<OpenImagery> openImagery(const std::vector<std::string>& paths,
                                        const terrain::GridFrame& frame, const std::string& crsWkt,
                                        std::uint64_t memoryBytes, const ImportControl& control) {
    Overlay overlay(frame, crsWkt);
    for (const std::string& path : paths) {
        RETURN_IF_ERROR(control.check());
        RETURN_IF_ERROR(overlay.add(path));
    }
    return overlay.open(memoryBytes, control);
}

}  // namespace eyrie::import
