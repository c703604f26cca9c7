// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/texture_files.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include <absl/status/statusor.h>
#include <fmt/format.h>

#define STB_IMAGE_STATIC
#define STB_IMAGE_IMPLEMENTATION
#define STBI_NO_HDR
#define STBI_NO_LINEAR
#define STBI_MAX_DIMENSIONS 65536
#include <stb/stb_image.h>

#include "fabric/status.h"
#include "renderer/import/companion_folder.h"
#include "renderer/import/jpeg_end.h"
#include "renderer/import/mesh_reader.h"
#include "renderer/import/reading_process.h"
#include "renderer/import/sgi_image.h"
#include "renderer/import/uri_name.h"
#include "renderer/mesh/image_codec.h"
#include "renderer/mesh/mapped_file.h"

namespace eyrie::import {
namespace {

namespace fs = std::filesystem;

constexpr float kCutoff = 0.5F;  ///< of materials whose source gives none
/// Alphas between count as half see-through.
constexpr std::uint8_t kClear = 32;
constexpr std::uint8_t kOpaque = 224;
constexpr float kToldError = 10;  ///< of coding, root of the mean square, of 255

std::string lowered(std::string text) {
    std::transform(text.begin(), text.end(), text.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return text;
}

bool isFile(const fs::path& path) {
    std::error_code ignored;
    return fs::is_regular_file(path, ignored);
}

const stbi_uc* dataOf(std::span<const std::byte> bytes) {
    return reinterpret_cast<const stbi_uc*>(bytes.data());
}

int sizeOf(std::span<const std::byte> bytes) {
    return static_cast<int>(std::min<std::size_t>(bytes.size(), 1U << 30));
}

using Texels = std::unique_ptr<stbi_uc, decltype(&stbi_image_free)>;

/// Hands out an image's bytes, and knows whether more were asked for than there are: of TGA, BMP
/// and others stb_image takes whatever it has for what lies behind their end.
class CountedBytes {
public:
    explicit CountedBytes(std::span<const std::byte> bytes) : rest_(bytes) {}

    /// Null where it cannot.
    Texels decode(int& width, int& height) {
        const stbi_io_callbacks callbacks = {read, skip, isAtEnd};
        int channels = 0;
        return {stbi_load_from_callbacks(&callbacks, this, &width, &height, &channels, 4),
                &stbi_image_free};
    }

    bool isOverrun() const { return isOverrun_; }

private:
    static int read(void* bytes, char* to, int size) {
        return static_cast<CountedBytes*>(bytes)->take(to, static_cast<std::size_t>(size));
    }
    static void skip(void* bytes, int size) {
        auto& rest = static_cast<CountedBytes*>(bytes)->rest_;
        rest = rest.subspan(std::min(static_cast<std::size_t>(size), rest.size()));
    }
    static int isAtEnd(void* bytes) { return static_cast<CountedBytes*>(bytes)->rest_.empty(); }

    /// stb_image reads ahead into a buffer of its own, the first time before anything else, and may
    /// get less then; it does so again when it needs more than that, and then there is to be some.
    int take(char* to, std::size_t size) {
        if (ahead_ == nullptr)
            ahead_ = to;
        const std::size_t count = std::min(size, rest_.size());
        isOverrun_ = isOverrun_ || (to == ahead_ ? count == 0 : count < size);
        std::memcpy(to, rest_.data(), count);
        rest_ = rest_.subspan(count);
        return static_cast<int>(count);
    }

    std::span<const std::byte> rest_;
    const char* ahead_ = nullptr;
    bool isOverrun_ = false;
};

/// Its sides, as its header has them.
absl::StatusOr<mesh::ImageShape> shapeOf(std::span<const std::byte> bytes) {
    if (looksLikeSgi(bytes))
        return sgiShapeOf(bytes);
    int width = 0, height = 0, channels = 0;
    if (stbi_info_from_memory(dataOf(bytes), sizeOf(bytes), &width, &height, &channels) == 0)
        return absl::InvalidArgumentError("is of no format known here");
    constexpr int kMost = mesh::kMaxImageSide;
    if (width < 1 || height < 1 || width > kMost || height > kMost)
        return absl::InvalidArgumentError(
            fmt::format("has {} x {} texels, more than {} a side", width, height, kMost));
    mesh::ImageShape shape;
    shape.width = static_cast<std::uint32_t>(width);
    shape.height = static_cast<std::uint32_t>(height);
    return shape;
}

/// The texels of a JPEG that lacks its end, where nothing else is missing: they are the same then
/// whatever follows, and are not where zeros and ones take the place of something. Null otherwise.
Texels decodeWithoutEnd(std::span<const std::byte> bytes, int& width, int& height) {
    const auto decodedWith = [&](std::string_view between) {
        return CountedBytes(withJpegEnd(bytes, between)).decode(width, height);
    };
    Texels none(nullptr, &stbi_image_free);
    if (!isOneJpegScan(bytes))
        return none;
    Texels texels = decodedWith("");  // for zeros
    const Texels others = decodedWith(std::string(64, '\xAA'));
    const auto size =
        sizeof(fabric::Rgba) * static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    return texels && others && std::memcmp(texels.get(), others.get(), size) == 0
               ? std::move(texels)
               : std::move(none);
}

absl::StatusOr<std::vector<fabric::Rgba>> decode(std::span<const std::byte> bytes,
                                                 mesh::ImageShape& shape) {
    if (looksLikeSgi(bytes))
        return decodeSgi(bytes, shape);
    ASSIGN_OR_RETURN(shape, shapeOf(bytes));
    int width = 0, height = 0;
    CountedBytes counted(bytes);
    const bool lacksEnd = lacksJpegEnd(bytes);
    const Texels texels =
        lacksEnd ? decodeWithoutEnd(bytes, width, height) : counted.decode(width, height);
    if (!texels && !lacksEnd)
        return absl::InvalidArgumentError(fmt::format("is damaged ({})", stbi_failure_reason()));
    if (!texels || counted.isOverrun())
        return absl::InvalidArgumentError("is damaged (it ends too early)");
    shape.width = static_cast<std::uint32_t>(width);
    shape.height = static_cast<std::uint32_t>(height);
    std::vector<fabric::Rgba> result(std::size_t{shape.width} * shape.height);
    std::memcpy(result.data(), texels.get(), result.size() * sizeof(fabric::Rgba));
    return result;
}

/// How much of an image shows, and how.
struct AlphaUse {
    bool hasAlpha = false;
    bool isSoft = false;  ///< half see-through more than it is holes
};

/// By a guess, where the format does not say what alpha is for.
AlphaUse guessedAlphaUseOf(const std::vector<fabric::Rgba>& texels) {
    std::size_t notOpaque = 0, between = 0;
    for (const fabric::Rgba& texel : texels) {
        notOpaque += texel.a < kOpaque ? 1 : 0;
        between += texel.a < kOpaque && texel.a >= kClear ? 1 : 0;
    }
    return {notOpaque > 0, 2 * between > notOpaque};
}

/// Reads, decodes and codes images; runs in a process of its own.
class Loading {
public:
    Loading(const TriangleMesh& mesh, const std::string& path)
        : mesh_(mesh), path_(path), imageOf_(mesh.textures.size(), -1) {
        result_.materials = mesh.materials;
    }

    absl::StatusOr<TriangleMesh> run();
    /// ResourceExhausted where run() takes more, as the images' headers have it.
    absl::Status checkMemory(std::uint64_t memoryBytes) const;

private:
    absl::StatusOr<std::span<const std::byte>> open(std::size_t texture,
                                                    std::optional<mesh::MappedFile>& file) const;
    absl::Status load(std::size_t texture);
    AlphaUse alphaUseOf(std::size_t texture, const std::vector<fabric::Rgba>& texels);
    void settleAlpha(std::size_t texture, const AlphaUse& use);
    void noteErrors();

    const TriangleMesh& mesh_;
    const std::string& path_;
    std::vector<std::int32_t> imageOf_;
    std::size_t takenForOpaque_ = 0;
    TriangleMesh result_;  ///< materials, images and notes
};

AlphaUse Loading::alphaUseOf(std::size_t texture, const std::vector<fabric::Rgba>& texels) {
    bool isUsed = false, isStated = false;
    for (const mesh::Material& material : mesh_.materials) {
        const bool isAsked = (material.flags & kAlphaByImage) != 0;
        if (material.image != static_cast<std::int32_t>(texture) ||
            !(isAsked || material.isSeeThrough()))
            continue;
        isUsed = true;
        isStated = isStated || !isAsked;
    }
    const auto isAny = [&texels](auto has) {
        return std::ranges::any_of(texels, has, &fabric::Rgba::a);
    };
    if (isStated)
        return {isAny([](std::uint8_t alpha) { return alpha < 255; }), false};
    if (!isUsed)
        return {};
    if (!isAny([](std::uint8_t alpha) { return alpha >= kClear; })) {
        ++takenForOpaque_;
        return {};
    }
    return guessedAlphaUseOf(texels);
}

void Loading::settleAlpha(std::size_t texture, const AlphaUse& use) {
    for (mesh::Material& material : result_.materials) {
        if (material.image != static_cast<std::int32_t>(texture))
            continue;
        const bool isAsked = (material.flags & kAlphaByImage) != 0;
        if (!use.hasAlpha)
            material.alphaCutoff = 0;
        else if (isAsked && use.isSoft)
            material.flags |= mesh::kIsBlended;
        else if (isAsked && !material.isBlended())
            material.alphaCutoff = kCutoff;
    }
}

/// Its bytes, those of `file` where the mesh has only its name.
absl::StatusOr<std::span<const std::byte>> Loading::open(
    std::size_t texture, std::optional<mesh::MappedFile>& file) const {
    const TextureSource& source = mesh_.textures[texture];
    if (!source.bytes.empty())
        return source.bytes;
    const std::string found = findTexture(source.name, path_);
    if (found.empty())
        return absl::NotFoundError("is not there");
    ASSIGN_OR_RETURN(file, mesh::MappedFile::open(found));
    return file->bytes();
}

absl::Status Loading::checkMemory(std::uint64_t memoryBytes) const {
    constexpr std::uint64_t kTexelBytes = 2 * sizeof(fabric::Rgba);  // as decoded, and copied
    std::uint64_t largest = 0, coded = 0;
    for (std::size_t i = 0; i < mesh_.textures.size(); ++i) {
        std::optional<mesh::MappedFile> file;
        const auto bytes = open(i, file);
        const auto shape = bytes.ok() ? shapeOf(*bytes) : bytes.status();
        if (!shape.ok())
            continue;  // which run() says
        largest = std::max(largest, std::uint64_t{shape->width} * shape->height);
        coded += shape->bytesFrom(0);
    }
    const std::uint64_t needed = kTexelBytes * largest + coded;
    if (needed <= memoryBytes)
        return absl::OkStatus();
    return absl::ResourceExhaustedError(
        fmt::format("reading its {} textures takes about {} MiB of memory, of which it may use {}; "
                    "make them smaller, or allow more memory",
                    mesh_.textures.size(), (needed >> 20) + 1, memoryBytes >> 20));
}

absl::Status Loading::load(std::size_t texture) {
    const TextureSource& source = mesh_.textures[texture];
    std::optional<mesh::MappedFile> file;
    ASSIGN_OR_RETURN(const std::span<const std::byte> bytes, open(texture, file));
    mesh::ImageShape shape;
    ASSIGN_OR_RETURN(std::vector<fabric::Rgba> texels, decode(bytes, shape));
    const AlphaUse use = alphaUseOf(texture, texels);
    shape.flags = source.flags | (use.hasAlpha ? mesh::kHasAlpha : 0);
    settleAlpha(texture, use);
    imageOf_[texture] = static_cast<std::int32_t>(result_.images.size());
    result_.images.push_back(mesh::encodeImage(shape, std::move(texels)));
    return absl::OkStatus();
}

void Loading::noteErrors() {
    std::size_t coarse = 0;
    std::size_t worst = 0;
    const auto errorOf = [this](std::size_t texture) {
        const std::int32_t image = imageOf_[texture];
        return image < 0 ? 0 : result_.images[static_cast<std::size_t>(image)].shape.rmsError;
    };
    for (std::size_t i = 0; i < imageOf_.size(); ++i) {
        coarse += errorOf(i) > kToldError ? 1 : 0;
        worst = errorOf(i) > errorOf(worst) ? i : worst;
    }
    if (coarse > 0)
        result_.notes.push_back(fmt::format(
            "{} of {} textures lose more than {} of 255 (RMS) by compression, which takes 4 x 4 "
            "texels as one: '{}' {:.0f}; made wider and higher they lose less",
            coarse, imageOf_.size(), kToldError, mesh_.textures[worst].name, errorOf(worst)));
}

absl::StatusOr<TriangleMesh> Loading::run() {
    std::size_t failed = 0;
    std::string first;
    for (std::size_t i = 0; i < mesh_.textures.size(); ++i)
        if (const absl::Status loaded = load(i); !loaded.ok()) {
            settleAlpha(i, {});
            if (failed++ == 0)
                first =
                    fmt::format("'{}' {}", mesh_.textures[i].name,
                                std::string_view(loaded.message().data(), loaded.message().size()));
        }
    for (mesh::Material& material : result_.materials)
        material.image =
            material.hasImage() ? imageOf_[static_cast<std::size_t>(material.image)] : -1;
    if (failed > 0)
        result_.notes.push_back(fmt::format(
            "{} of {} textures cannot be read, and their materials have their colour alone: {}",
            failed, mesh_.textures.size(), first));
    if (takenForOpaque_ > 0)
        result_.notes.push_back(
            fmt::format("{} of {} textures have no opacity at all, and nobody would see them: they "
                        "are taken for opaque",
                        takenForOpaque_, mesh_.textures.size()));
    noteErrors();
    return std::move(result_);
}

/// Whether anything is to be decoded.
bool areAnyThere(const std::vector<TextureSource>& textures, const std::string& path) {
    return std::ranges::any_of(textures, [&path](const TextureSource& texture) {
        return !texture.bytes.empty() || !findTexture(texture.name, path).empty();
    });
}

/// In a process of its own, too; what else happens there happens to who reads the images.
absl::Status checkMemory(const TriangleMesh& mesh, const std::string& path,
                         std::uint64_t memoryBytes, const ReadingLimits& limits,
                         const ImportControl& control) {
    const auto check = [&]() -> absl::StatusOr<TriangleMesh> {
        RETURN_IF_ERROR(Loading(mesh, path).checkMemory(memoryBytes));
        return TriangleMesh();
    };
    const absl::Status checked = readInOwnProcess(check, limits, control).status();
    return absl::IsResourceExhausted(checked) ? fabric::withContext(checked, path)
                                              : absl::OkStatus();
}

/// Has done with what is said until images are there.
void replaceColours(TriangleMesh& mesh) {
    const auto isReplaced = [&mesh](std::size_t vertex) {
        const mesh::Material& material = mesh.materials[mesh.materialOf[vertex]];
        return material.hasImage() && (material.flags & kReplacesColour) != 0;
    };
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        if (!isReplaced(i))
            continue;
        if (mesh.colours.empty())
            mesh.colours.assign(mesh.positions.size(), kPlainColour);
        mesh.colours[i] = {255, 255, 255, mesh.colours[i].a};
    }
    for (mesh::Material& material : mesh.materials)
        material.flags &= ~(kAlphaByImage | kReplacesColour);
}

/// Blended materials of which everything is opaque need not be.
void dropIdleBlending(TriangleMesh& mesh) {
    std::vector<bool> isClear(mesh.materials.size(), false);
    for (std::size_t i = 0; i < mesh.materials.size(); ++i) {
        const std::int32_t image = mesh.materials[i].image;
        isClear[i] = image >= 0 && mesh.images[static_cast<std::size_t>(image)].shape.hasAlpha();
    }
    for (std::size_t i = 0; i < mesh.colours.size(); ++i)
        if (mesh.colours[i].a < 255)
            isClear[mesh.materialOf[i]] = true;
    for (std::size_t i = 0; i < mesh.materials.size(); ++i)
        if (!isClear[i])
            mesh.materials[i].flags &= ~mesh::kIsBlended;
}

/// Numbers materials by what they are, and leaves none where all are plain.
void mergeMaterials(TriangleMesh& mesh) {
    std::vector<std::uint16_t> numberOf;
    std::vector<mesh::Material> merged;
    for (const mesh::Material& material : mesh.materials) {
        const auto known = std::find(merged.begin(), merged.end(), material);
        numberOf.push_back(static_cast<std::uint16_t>(known - merged.begin()));
        if (known == merged.end())
            merged.push_back(material);
    }
    if (merged == std::vector<mesh::Material>(1)) {
        mesh.materials.clear();
        mesh.materialOf.clear();
        mesh.textureCoordinates.clear();
        return;
    }
    for (std::uint16_t& material : mesh.materialOf) material = numberOf[material];
    mesh.materials = std::move(merged);
    if (mesh.images.empty())
        mesh.textureCoordinates.clear();
}

void noteFarPlaces(TriangleMesh& mesh) {
    const auto isFar = [&mesh](std::size_t vertex) {
        const glm::vec2 place = mesh.textureCoordinates[vertex];
        return mesh.materials[mesh.materialOf[vertex]].hasImage() &&
               !(std::abs(place.x) <= kMostImageSides && std::abs(place.y) <= kMostImageSides);
    };
    std::size_t far = 0;
    for (std::size_t i = 0; i < mesh.textureCoordinates.size(); ++i) far += isFar(i) ? 1 : 0;
    if (far > 0)
        mesh.notes.push_back(
            fmt::format("texture coordinates of {} of {} vertices are no numbers or more than {} "
                        "sides of the image away, and textures lie wrong there: take whole "
                        "numbers off them",
                        far, mesh.positions.size(), kMostImageSides));
}

/// The file that `name` means as it stands.
std::string findAsNamed(const std::string& name, const std::string& path) {
    std::string plain = name;
    std::replace(plain.begin(), plain.end(), '\\', '/');
    const fs::path folder = fs::path(path).parent_path();
    const fs::path last = fs::path(plain).filename();
    if (last.empty())
        return {};
    const auto isFound = [](const fs::path& file) {
        return isFile(file) && mayBeCompanion(file.string());
    };
    for (const fs::path& candidate : {folder / plain, folder / last})
        if (isFound(candidate))
            return candidate.string();
    std::error_code ignored;
    for (const fs::directory_entry& entry :
         fs::directory_iterator(folder.empty() ? fs::path(".") : folder, ignored))
        if (lowered(entry.path().filename().string()) == lowered(last.string()) &&
            isFound(entry.path()))
            return entry.path().string();
    return {};
}

}  // namespace

std::string findTexture(const std::string& name, const std::string& path) {
    std::string found = findAsNamed(name, path);
    const std::string plain = withoutPercents(name);
    return found.empty() && plain != name ? findAsNamed(plain, path) : found;
}

std::string findTexture(const std::string& name, const std::string& path,
                        const std::string& companion) {
    std::string found = findTexture(name, path);
    return found.empty() ? findTexture(name, companion) : found;
}

absl::Status loadTextures(TriangleMesh& mesh, const std::string& path, const ImportControl& control,
                          std::uint64_t memoryBytes) {
    if (mesh.materials.empty())
        return absl::OkStatus();
    if (!mesh.textures.empty()) {
        const ReadingLimits limits = ReadingLimits::forTextures(mesh.textures.size());
        const bool areAny = areAnyThere(mesh.textures, path);
        if (memoryBytes != 0 && areAny)
            RETURN_IF_ERROR(checkMemory(mesh, path, memoryBytes, limits, control));
        const auto load = [&] { return Loading(mesh, path).run(); };
        auto loaded = areAny ? readInOwnProcess(load, limits, control) : load();
        RETURN_IF_ERROR(control.check());
        if (loaded.ok()) {
            mesh.materials = std::move(loaded->materials);
            mesh.images = std::move(loaded->images);
            mesh.notes.insert(mesh.notes.end(), loaded->notes.begin(), loaded->notes.end());
        } else {
            for (mesh::Material& material : mesh.materials) {
                material.image = -1;
                material.alphaCutoff = 0;
            }
            mesh.notes.push_back(
                fmt::format("none of {} textures can be read, and their materials have their "
                            "colour alone: {}",
                            mesh.textures.size(),
                            std::string_view(loaded.status().message().data(),
                                             loaded.status().message().size())));
        }
        mesh.textures.clear();
    }
    replaceColours(mesh);
    dropIdleBlending(mesh);
    mergeMaterials(mesh);
    noteFarPlaces(mesh);
    return absl::OkStatus();
}

}  // namespace eyrie::import
