// SPDX-License-Identifier: Apache-2.0
#include "cli/png_file.h"

#include <csetjmp>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <fmt/format.h>
#include <png.h>

#include "fabric/status.h"
#include "renderer/mesh/output_file.h"

namespace eyrie::cli {
namespace {

class PngFile final : public PictureFile {
public:
    PngFile(mesh::OutputFile file, int width)
        : file_(std::move(file)), row_(static_cast<std::size_t>(width) * 3) {
        png_ = png_create_write_struct(PNG_LIBPNG_VER_STRING, this, fail, ignore);
        if (png_ != nullptr)
            info_ = png_create_info_struct(png_);
    }
    ~PngFile() override { png_destroy_write_struct(&png_, &info_); }
    PngFile(const PngFile&) = delete;
    PngFile& operator=(const PngFile&) = delete;

    absl::Status begin(int width, int height) {
        if (png_ == nullptr || info_ == nullptr)
            return absl::ResourceExhaustedError("PNG encoder: no memory");
        return guarded([=, this] {
            png_set_write_fn(png_, this, write, nullptr);
            png_set_IHDR(png_, info_, static_cast<png_uint_32>(width),
                         static_cast<png_uint_32>(height), 8, PNG_COLOR_TYPE_RGB,
                         PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
            png_set_sRGB(png_, info_, PNG_sRGB_INTENT_PERCEPTUAL);
            png_write_info(png_, info_);
        });
    }

    absl::Status append(const fabric::Image& rows) override {
        const auto width = static_cast<std::size_t>(rows.area.width);
        for (auto y = static_cast<std::size_t>(rows.area.height); y-- > 0;) {
            auto out = row_.begin();
            for (std::size_t x = 0; x < width; ++x) {
                const fabric::Rgba& pixel = rows.colour[y * width + x];
                *out++ = pixel.r;
                *out++ = pixel.g;
                *out++ = pixel.b;
            }
            RETURN_IF_ERROR(guarded([this] { png_write_row(png_, row_.data()); }));
        }
        return absl::OkStatus();
    }

    absl::Status commit() override {
        RETURN_IF_ERROR(guarded([this] { png_write_end(png_, info_); }));
        return file_.commit();
    }

private:
    /// Runs a step of libpng, which leaves it by longjmp when it fails: nothing that a step makes
    /// may need a destructor.
    template <typename Step>
    absl::Status guarded(const Step& step) {
        if (setjmp(png_jmpbuf(png_)) != 0)
            return written_.ok() ? absl::InternalError(problem_) : written_;
        step();
        return absl::OkStatus();
    }

    static void write(png_structp png, png_bytep bytes, std::size_t size) {
        auto* self = static_cast<PngFile*>(png_get_io_ptr(png));
        self->written_ = self->file_.write(std::as_bytes(std::span(bytes, size)));
        if (!self->written_.ok())
            png_error(png, "cannot write");
    }
    static void fail(png_structp png, png_const_charp message) {
        auto* self = static_cast<PngFile*>(png_get_error_ptr(png));
        self->problem_ = fmt::format("PNG encoder: {}", message);
        png_longjmp(png, 1);
    }
    static void ignore(png_structp, png_const_charp) {}

    mesh::OutputFile file_;
    std::vector<std::uint8_t> row_;
    png_structp png_ = nullptr;
    png_infop info_ = nullptr;
    absl::Status written_;
    std::string problem_;
};

}  // namespace

absl::StatusOr<std::unique_ptr<PictureFile>> createPng(const std::string& path, int width,
                                                       int height) {
    ASSIGN_OR_RETURN(mesh::OutputFile file, mesh::OutputFile::create(path));
    auto png = std::make_unique<PngFile>(std::move(file), width);
    RETURN_IF_ERROR(png->begin(width, height));
    return png;
}

absl::StatusOr<std::vector<std::byte>> encodePng(const fabric::Image& image) {
    std::vector<std::uint8_t> rgb;
    rgb.reserve(image.colour.size() * 3);
    for (const fabric::Rgba& pixel : image.colour)
        rgb.insert(rgb.end(), {pixel.r, pixel.g, pixel.b});
    png_image png{};
    png.version = PNG_IMAGE_VERSION;
    png.width = static_cast<png_uint_32>(image.area.width);
    png.height = static_cast<png_uint_32>(image.area.height);
    png.format = PNG_FORMAT_RGB;
    const auto bottomUp = -image.area.width * 3;  // a negative stride starts at the last row
    png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(png);
    std::vector<std::byte> bytes(size);
    if (png_image_write_to_memory(&png, bytes.data(), &size, 0, rgb.data(), bottomUp, nullptr) == 0)
        return absl::InternalError(fmt::format("PNG encoder: {}", png.message));
    bytes.resize(size);
    return bytes;
}

}  // namespace eyrie::cli
