// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/colour_file.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <optional>

#include <fmt/format.h>
#include <gdal_priv.h>

#include "fabric/status.h"
#include "renderer/import/raster_file.h"
#include "renderer/import/strip_order.h"
#include "renderer/import/whole_decoding.h"

namespace eyrie::import {
namespace {

constexpr int kBands = 4;

/// Which bands of a file hold what, and what their values mean.
struct ColourRule {
    std::array<int, 3> colours{1, 1, 1};  ///< bands, from 1
    int alpha = 0;                        ///< 0: none
    bool hasMask = false;
    const GDALColorTable* palette = nullptr;
    std::array<std::optional<double>, 3> nodata;
    double bytePerValue = 1;
    bool isByBrightest = false;  ///< no value is said to be the most
    double alphaBytePerValue = 1;
    bool isOpaqueByLargest = false;  ///< nor of alpha
    bool isNegative = false;         ///< 0 is white
};

int bandTagged(GDALDataset& dataset, GDALColorInterp tag) {
    for (int band = 1; band <= dataset.GetRasterCount(); ++band)
        if (dataset.GetRasterBand(band)->GetColorInterpretation() == tag)
            return band;
    return 0;
}

std::array<int, 3> colourBands(GDALDataset& dataset, int alpha) {
    const std::array<int, 3> tagged = {bandTagged(dataset, GCI_RedBand),
                                       bandTagged(dataset, GCI_GreenBand),
                                       bandTagged(dataset, GCI_BlueBand)};
    if (std::none_of(tagged.begin(), tagged.end(), [](int band) { return band == 0; }))
        return tagged;
    const int colours = dataset.GetRasterCount() - (alpha != 0 ? 1 : 0);
    return colours >= 3 ? std::array{1, 2, 3} : std::array{1, 1, 1};
}

/// The largest value that each of some bands may have by its tag, of the largest; none without
/// tags.
std::optional<double> mostByTag(GDALDataset& dataset, const std::array<int, 3>& bands) {
    double most = 0;
    for (const int number : bands) {
        const char* const bits =
            dataset.GetRasterBand(number)->GetMetadataItem("NBITS", "IMAGE_STRUCTURE");
        if (bits == nullptr)
            return std::nullopt;
        most = std::max(most, std::exp2(std::clamp(std::atoi(bits), 1, 16)) - 1);
    }
    return most;
}

bool isNarrow(GDALRasterBand& band) {
    return band.GetMetadataItem("NBITS", "IMAGE_STRUCTURE") != nullptr;
}

/// Refuses bands that are no colours, or not of as many bits as the first, and what is no alpha.
absl::Status checkTypes(const std::string& path, GDALDataset& dataset,
                        const std::array<int, 3>& colours, int alpha) {
    const auto typeOf = [&](int band) { return dataset.GetRasterBand(band)->GetRasterDataType(); };
    const auto isOf8Or16Bits = [](GDALDataType type) {
        return type == GDT_Byte || type == GDT_UInt16 || type == GDT_Int16;
    };
    const GDALDataType first = typeOf(colours[0]);
    for (const int band : colours) {
        const GDALDataType type = typeOf(band);
        if (!isOf8Or16Bits(type))
            return invalid(path,
                           fmt::format("its band {} holds {} values, not colours of 8 or 16 bits; "
                                       "turn it into them with gdal_translate -ot Byte -scale",
                                       band, GDALGetDataTypeName(type)));
        if ((type == GDT_Byte) != (first == GDT_Byte))
            return invalid(path,
                           fmt::format("its band {} holds {} values and its band {} {} ones; turn "
                                       "those of 16 bits into 8 first (gdal_translate -ot Byte, "
                                       "with -scale_N for each such band N)",
                                       colours[0], GDALGetDataTypeName(first), band,
                                       GDALGetDataTypeName(type)));
    }
    if (alpha != 0 && !isOf8Or16Bits(typeOf(alpha)))
        return invalid(path, fmt::format("its band {}, alpha, holds {} values, not ones of 8 or 16 "
                                         "bits; turn it into them with gdal_translate -ot Byte "
                                         "-scale_{} 0 MOST 0 255, MOST being what is opaque",
                                         alpha, GDALGetDataTypeName(typeOf(alpha)), alpha));
    return absl::OkStatus();
}

std::string turnedToBytes(const std::string& path, double most) {
    return fmt::format("{}: values of 0 to {} turned to 8 bits", path, most);
}

absl::StatusOr<ColourRule> colourRule(const std::string& path, GDALDataset& dataset,
                                      std::vector<std::string>& notes) {
    ColourRule rule;
    rule.alpha = bandTagged(dataset, GCI_AlphaBand);
    rule.colours = colourBands(dataset, rule.alpha);
    GDALRasterBand* const first = dataset.GetRasterBand(rule.colours[0]);
    RETURN_IF_ERROR(checkTypes(path, dataset, rule.colours, rule.alpha));
    const GDALColorInterp tag = first->GetColorInterpretation();
    if (tag >= GCI_HueBand && tag <= GCI_YCbCr_CrBand)
        return invalid(path, fmt::format("its band {} is {}, and not red or grey; {}",
                                         rule.colours[0], GDALGetColorInterpretationName(tag),
                                         tag >= GCI_CyanBand && tag <= GCI_BlackBand
                                             ? "turn it into 8 bits, which GDAL reads as red, "
                                               "green and blue (gdal_translate -ot Byte -scale 0 "
                                               "65535 0 255 -co PHOTOMETRIC=CMYK)"
                                             : "turn it into red, green and blue first"));
    rule.palette = first->GetColorTable();
    const int mask = first->GetMaskFlags();
    rule.hasMask = rule.alpha == 0 && mask != GMF_ALL_VALID && mask != GMF_NODATA;
    for (std::size_t c = 0; c < 3; ++c) {
        int isSet = 0;
        const double value = dataset.GetRasterBand(rule.colours[c])->GetNoDataValue(&isSet);
        if (isSet != 0)
            rule.nodata[c] = value;
    }
    const bool isByte = first->GetRasterDataType() == GDT_Byte;
    if ((!isByte || isNarrow(*first)) && rule.palette == nullptr) {
        if (const auto most = mostByTag(dataset, rule.colours)) {
            rule.bytePerValue = 255 / *most;
            notes.push_back(turnedToBytes(path, *most));
        } else {
            rule.isByBrightest = true;
        }
    }
    if (rule.alpha != 0) {
        if (const auto most = mostByTag(dataset, {rule.alpha, rule.alpha, rule.alpha}))
            rule.alphaBytePerValue = 255 / *most;
        else
            rule.isOpaqueByLargest =
                dataset.GetRasterBand(rule.alpha)->GetRasterDataType() != GDT_Byte;
    }
    // Of those of one bit GDAL itself makes a palette.
    const char* const isNegative = dataset.GetMetadataItem("MINISWHITE", "IMAGE_STRUCTURE");
    rule.isNegative = rule.palette == nullptr && isNegative != nullptr && EQUAL(isNegative, "YES");
    if (dataset.GetRasterCount() > 4 || (dataset.GetRasterCount() == 4 && rule.alpha == 0))
        notes.push_back(fmt::format("{}: bands {}, {} and {} of {} taken for red, green and blue",
                                    path, rule.colours[0], rule.colours[1], rule.colours[2],
                                    dataset.GetRasterCount()));
    return rule;
}

std::uint8_t toByte(double value) {
    return static_cast<std::uint8_t>(std::clamp(std::lround(value), 0L, 255L));
}

struct Block {
    int columns = 0;
    int rows = 0;
};

/// What is read at once of pictures in strips: the strips themselves are in GDAL's cache.
constexpr Block kPieceOfStrips{512, kStripPieceRows};

/// What is turned at once of what is read.
constexpr int kTurnedAtOnce = 512 * 512;

/// What is stored together, unless that is much.
Block blockOf(GDALRasterBand& band) {
    Block block;
    band.GetBlockSize(&block.columns, &block.rows);
    constexpr std::int64_t kMostValues = 1 << 22;
    if (block.columns < 1 || block.rows < 1 ||
        std::int64_t{block.columns} * block.rows > kMostValues)
        return {512, 512};
    return block;
}

class ColourDataset;

/// One of the four bands; a block of one brings those of the others.
class ColourBand : public GDALRasterBand {
public:
    ColourBand(ColourDataset* owner, int number, GDALRasterBand& shape);

    GDALColorInterp GetColorInterpretation() override {
        constexpr std::array kTags = {GCI_RedBand, GCI_GreenBand, GCI_BlueBand, GCI_AlphaBand};
        return kTags[static_cast<std::size_t>(nBand - 1)];
    }

protected:
    CPLErr IReadBlock(int x, int y, void* data) override;
};

class ColourDataset : public GDALDataset {
public:
    /// Its first `columns`.
    ColourDataset(Dataset source, int columns, const ColourRule& rule)
        : source_(std::move(source)), rule_(rule) {
        GDALDataset& from = *GDALDataset::FromHandle(source_.get());
        nRasterXSize = columns;
        nRasterYSize = from.GetRasterYSize();
        for (int band = 1; band <= kBands; ++band)
            SetBand(band, new ColourBand(this, band, *from.GetRasterBand(rule.colours[0])));
    }
    ~ColourDataset() override { FlushCache(true); }

    CPLErr GetGeoTransform(double* transform) override {
        if (!transform_)
            return GDALGetGeoTransform(source_.get(), transform);
        std::copy(transform_->begin(), transform_->end(), transform);
        return CE_None;
    }
    CPLErr SetGeoTransform(double* transform) override {
        std::copy_n(transform, transform_.emplace().size(), transform_->begin());
        return CE_None;
    }
    const OGRSpatialReference* GetSpatialRef() const override {
        return GDALDataset::FromHandle(source_.get())->GetSpatialRef();
    }

    void setMost(double value) { rule_.bytePerValue = 255 / value; }

    /// 0 where it is not in strips.
    std::uint64_t stripRowBytes() const {
        GDALDataset& from = *GDALDataset::FromHandle(source_.get());
        return isInStrips(*from.GetRasterBand(rule_.colours[0])) ? rowBytes(from) : 0;
    }
    void readInOrder(int rows) {
        std::vector<GDALRasterBand*> all;
        const auto add = [&](int band) {
            all.push_back(GDALDataset::FromHandle(source_.get())->GetRasterBand(band));
        };
        for (int c = 0; c < bands(); ++c) add(rule_.colours[static_cast<std::size_t>(c)]);
        if (rule_.alpha != 0)
            add(rule_.alpha);
        order_ = StripOrder(std::move(all), rows);
    }

    /// The four channels of a rectangle, one after the other.
    CPLErr read(int i, int j, int columns, int rows, std::vector<std::uint8_t>& out) {
        const std::size_t count =
            static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows);
        order_.prepare(j, j + rows);
        out.resize(kBands * count);
        const int most = std::max(1, kTurnedAtOnce / columns);
        for (int v = 0; v < rows; v += most) {
            const int some = std::min(most, rows - v);
            if (readValues(i, j + v, columns, some) != CE_None)
                return CE_Failure;
            const auto row = static_cast<std::size_t>(columns);
            const std::size_t first = static_cast<std::size_t>(v) * row;
            const std::size_t part = static_cast<std::size_t>(some) * row;
            for (std::size_t k = 0; k < part; ++k) {
                const std::array<std::uint8_t, kBands> texel = turned(k, part);
                for (std::size_t c = 0; c < kBands; ++c) out[c * count + first + k] = texel[c];
            }
        }
        values_ = {};  // there may be hundreds of pictures
        return CE_None;
    }

    const ColourRule& rule() const { return rule_; }

    /// Takes the largest alpha for opaque where that is wanted, and returns the largest value that
    /// is not in a hole, at least 0. What cannot be read is left out: it is told when it is asked
    /// for.
    absl::StatusOr<int> findMost(const Watch& watch) {
        const Block block =
            blockOf(*GDALDataset::FromHandle(source_.get())->GetRasterBand(rule_.colours[0]));
        int most = 0;
        int opaque = 255;  // of masks that are of 16 bits for no reason, too
        for (int j = 0; j < nRasterYSize; j += block.rows) {
            RETURN_IF_ERROR(watch(static_cast<double>(j) / nRasterYSize));
            const int rows = std::min(block.rows, nRasterYSize - j);
            for (int i = 0; i < nRasterXSize; i += block.columns) {
                const int columns = std::min(block.columns, nRasterXSize - i);
                if (readValues(i, j, columns, rows) != CE_None)
                    continue;
                const std::size_t count =
                    static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows);
                most = std::max(most, brightest(count));
                const auto alphas = values_.begin() + static_cast<std::ptrdiff_t>(3 * count);
                if (rule_.isOpaqueByLargest)
                    opaque = std::max(opaque, *std::max_element(alphas, values_.end()));
            }
        }
        if (rule_.isOpaqueByLargest)
            rule_.alphaBytePerValue = 255.0 / opaque;
        values_ = {};
        return most;
    }

private:
    int bands() const { return rule_.colours[0] == rule_.colours[1] ? 1 : 3; }

    /// Into values_: colours, of grey only the first, and alpha or mask.
    CPLErr readValues(int i, int j, int columns, int rows) {
        const std::size_t count =
            static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows);
        values_.resize(kBands * count);
        for (int c = 0; c < bands(); ++c)
            if (readBand(rule_.colours[static_cast<std::size_t>(c)], i, j, columns, rows,
                         values_.data() + static_cast<std::size_t>(c) * count) != CE_None)
                return CE_Failure;
        int* const alpha = values_.data() + 3 * count;
        if (rule_.alpha != 0 && readBand(rule_.alpha, i, j, columns, rows, alpha) != CE_None)
            return CE_Failure;
        if (rule_.hasMask && readMask(i, j, columns, rows, alpha) != CE_None)
            return CE_Failure;
        return CE_None;
    }
    CPLErr readBand(int band, int i, int j, int columns, int rows, int* out) {
        return GDALRasterIO(GDALGetRasterBand(source_.get(), band), GF_Read, i, j, columns, rows,
                            out, columns, rows, GDT_Int32, 0, 0);
    }
    CPLErr readMask(int i, int j, int columns, int rows, int* out) {
        return GDALRasterIO(GDALGetMaskBand(GDALGetRasterBand(source_.get(), rule_.colours[0])),
                            GF_Read, i, j, columns, rows, out, columns, rows, GDT_Int32, 0, 0);
    }

    /// Of so many pixels in values_.
    int brightest(std::size_t count) const {
        int most = 0;
        for (std::size_t k = 0; k < count; ++k) {
            if (turned(k, count)[3] == 0)
                continue;
            for (std::size_t c = 0; c < static_cast<std::size_t>(bands()); ++c)
                if (const int value = values_[c * count + k]; value != rule_.nodata[c])
                    most = std::max(most, value);
        }
        return most;
    }

    std::array<std::uint8_t, kBands> turned(std::size_t k, std::size_t count) const {
        bool isNodata = true;
        std::array<std::uint8_t, kBands> texel{0, 0, 0, 255};
        for (std::size_t c = 0; c < 3; ++c) {
            const int value = values_[(bands() == 1 ? 0 : c) * count + k];
            isNodata = isNodata && value == rule_.nodata[c];
            const std::uint8_t byte = toByte(value * rule_.bytePerValue);
            texel[c] = rule_.isNegative ? static_cast<std::uint8_t>(255 - byte) : byte;
        }
        if (rule_.palette != nullptr)
            texel = fromPalette(values_[k]);
        if (rule_.alpha != 0)
            texel[3] = toByte(values_[3 * count + k] * rule_.alphaBytePerValue);
        else if (rule_.hasMask)
            texel[3] = values_[3 * count + k] != 0 ? 255 : 0;
        if (isNodata)
            texel[3] = 0;
        return texel;
    }

    std::array<std::uint8_t, kBands> fromPalette(int index) const {
        GDALColorEntry entry{0, 0, 0, 0};
        rule_.palette->GetColorEntryAsRGB(index, &entry);
        return {toByte(entry.c1), toByte(entry.c2), toByte(entry.c3), toByte(entry.c4)};
    }

    Dataset source_;
    ColourRule rule_;
    std::optional<std::array<double, 6>> transform_;  ///< none: the source's
    StripOrder order_;
    std::vector<int> values_;
};

ColourBand::ColourBand(ColourDataset* owner, int number, GDALRasterBand& shape) {
    poDS = owner;
    nBand = number;
    eDataType = GDT_Byte;
    nRasterXSize = owner->GetRasterXSize();
    nRasterYSize = shape.GetYSize();
    const Block block = isInStrips(shape) ? kPieceOfStrips : blockOf(shape);
    nBlockXSize = block.columns;
    nBlockYSize = block.rows;
}

CPLErr ColourBand::IReadBlock(int x, int y, void* data) {
    const int i = x * nBlockXSize;
    const int j = y * nBlockYSize;
    const int columns = std::min(nBlockXSize, nRasterXSize - i);
    const int rows = std::min(nBlockYSize, nRasterYSize - j);
    std::vector<std::uint8_t> channels;
    if (static_cast<ColourDataset*>(poDS)->read(i, j, columns, rows, channels) != CE_None)
        return CE_Failure;
    const std::size_t count = static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows);
    for (int band = 1; band <= kBands; ++band) {
        GDALRasterBlock* block = nullptr;
        auto* to = static_cast<std::uint8_t*>(data);
        if (band != nBand) {
            block = poDS->GetRasterBand(band)->GetLockedBlockRef(x, y, TRUE);
            if (block == nullptr)
                return CE_Failure;
            to = static_cast<std::uint8_t*>(block->GetDataRef());
        }
        const std::uint8_t* from = channels.data() + static_cast<std::size_t>(band - 1) * count;
        for (int v = 0; v < rows; ++v, from += columns, to += nBlockXSize)
            std::copy_n(from, columns, to);
        if (block != nullptr)
            block->DropLock();
    }
    return CE_None;
}

}  // namespace

absl::StatusOr<ColourFile> openColourFile(const std::string& path, QuietGdal& gdal) {
    ColourFile file;
    file.path = path;
    ASSIGN_OR_RETURN(Dataset dataset, openRaster(path, "a picture such as a GeoTIFF", gdal));
    RETURN_IF_ERROR(checkPlace(path, dataset.get()));
    file.wholeBytes = wholeDecodingBytes(dataset.get());
    ASSIGN_OR_RETURN(const ColourRule rule,
                     colourRule(path, *GDALDataset::FromHandle(dataset.get()), file.notes));
    std::array<double, 6> t{};
    file.isGeoreferenced = GDALGetGeoTransform(dataset.get(), t.data()) == CE_None;
    const double determinant = t[1] * t[5] - t[2] * t[4];
    if (file.isGeoreferenced && (determinant == 0 || !std::isfinite(determinant)))
        return invalid(path,
                       "its geotransform is not finite or has no area; set another "
                       "(gdal_edit.py -a_ullr)");
    const OGRSpatialReferenceH crs = crsOf(dataset.get());
    if (crs != nullptr && file.isGeoreferenced)
        file.crs.reset(OSRClone(crs));
    Georeference reference{{t[0], t[3]}, {t[1], t[4]}, {t[2], t[5]}};
    int columns = GDALGetRasterXSize(dataset.get());
    cutToOneTurn(file.isGeoreferenced ? crs : nullptr, reference, columns);
    auto colours = std::make_unique<ColourDataset>(std::move(dataset), columns, rule);
    file.dataset.reset(GDALDataset::ToHandle(colours.release()));
    if (file.isGeoreferenced)
        GDALSetGeoTransform(file.dataset.get(), geoTransform(reference).data());
    return file;
}

absl::Status findMost(ColourFile& file, const Watch& watch) {
    auto& colours = static_cast<ColourDataset&>(*GDALDataset::FromHandle(file.dataset.get()));
    if (!colours.rule().isByBrightest && !colours.rule().isOpaqueByLargest)
        return absl::OkStatus();
    ASSIGN_OR_RETURN(const int most, colours.findMost(watch));
    if (colours.rule().isByBrightest)
        file.brightest = most;
    return absl::OkStatus();
}

void turnToBytes(ColourFile& file, double most) {
    static_cast<ColourDataset*>(GDALDataset::FromHandle(file.dataset.get()))->setMost(most);
    file.notes.push_back(turnedToBytes(file.path, most));
}

std::uint64_t stripRowBytes(const ColourFile& file) {
    return static_cast<ColourDataset*>(GDALDataset::FromHandle(file.dataset.get()))
        ->stripRowBytes();
}

void readInOrder(ColourFile& file, int rows) {
    static_cast<ColourDataset*>(GDALDataset::FromHandle(file.dataset.get()))->readInOrder(rows);
}

}  // namespace eyrie::import
