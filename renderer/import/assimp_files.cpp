// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/assimp_files.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include <absl/status/statusor.h>
#include <assimp/DefaultIOSystem.h>
#include <assimp/MemoryIOWrapper.h>

#include "renderer/import/amf_text.h"
#include "renderer/import/collada_text.h"
#include "renderer/import/companion_folder.h"
#include "renderer/import/dxf_text.h"
#include "renderer/import/obj_text.h"
#include "renderer/import/obj_textures.h"
#include "renderer/import/off_text.h"
#include "renderer/import/texture_files.h"
#include "renderer/import/uri_name.h"
#include "renderer/import/x3d_text.h"
#include "renderer/mesh/mapped_file.h"

namespace eyrie::import {
namespace {

bool isMended(const AssimpFormat& format) {
    constexpr std::array kExtensions = {".amf", ".x3d", ".dae", ".dxf", ".obj", ".off"};
    return std::ranges::count(kExtensions, format.extension) > 0;
}

/// Nothing where it may be read as it is.
std::optional<std::string> mended(std::string_view source, const AssimpFormat& format) {
    if (format.extension == ".amf")
        return amfForAssimp(source);
    if (format.extension == ".obj")
        return objForAssimp(source);
    if (format.extension == ".off")
        return offForAssimp(source);
    if (format.extension == ".dxf")
        return dxfForAssimp(source);
    return format.extension == ".x3d" ? x3dForAssimp(source) : colladaForAssimp(source);
}

/// The source, and what else may be read with it.
class SourceFiles : public Assimp::DefaultIOSystem {
public:
    explicit SourceFiles(const std::string& path) : path_(path) {}

    bool Exists(const char* name) const override {
        return mayRead(name) && DefaultIOSystem::Exists(name);
    }

    Assimp::IOStream* Open(const char* name, const char* mode) override {
        return mayRead(name) ? DefaultIOSystem::Open(name, mode) : nullptr;
    }

protected:
    bool isSource(const std::string& name) const { return name == path_; }
    bool mayRead(const std::string& name) const { return isSource(name) || mayBeCompanion(name); }

    const std::string path_;
};

/// Files as glTF's URIs name them, which Assimp takes for plain names.
class UriFiles : public SourceFiles {
public:
    using SourceFiles::SourceFiles;

    bool Exists(const char* name) const override {
        return SourceFiles::Exists(name) || SourceFiles::Exists(withoutPercents(name).c_str());
    }

    Assimp::IOStream* Open(const char* name, const char* mode) override {
        return SourceFiles::Exists(name) ? SourceFiles::Open(name, mode)
                                         : SourceFiles::Open(withoutPercents(name).c_str(), mode);
    }
};

/// For Assimp, which deletes it.
Assimp::IOStream* streamOf(std::string_view text) {
    auto bytes = std::make_unique<std::uint8_t[]>(text.size());
    std::ranges::copy(text, bytes.get());
    return std::make_unique<Assimp::MemoryIOStream>(bytes.release(), text.size(), true).release();
}

std::string_view textOf(const mesh::MappedFile& file) {
    const auto bytes = file.bytes();
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

class MendedFiles : public SourceFiles {
public:
    using SourceFiles::SourceFiles;

    Assimp::IOStream* Open(const char* name, const char* mode) override {
        const AssimpFormat* format = findAssimpFormat(name);
        if (format == nullptr || !isMended(*format) || !mayRead(name))
            return SourceFiles::Open(name, mode);
        const absl::StatusOr<mesh::MappedFile> file = mesh::MappedFile::open(name);
        const std::optional<std::string> text =
            file.ok() ? mended(textOf(*file), *format) : std::nullopt;
        return text ? streamOf(*text) : SourceFiles::Open(name, mode);
    }
};

/// An OBJ and its material files, whose names, too, mean what findTexture() finds.
class ObjFiles : public MendedFiles {
public:
    using MendedFiles::MendedFiles;

    Assimp::IOStream* Open(const char* name, const char* mode) override {
        const std::string found = isSource(name) ? "" : findTexture(asNamed(name), path_);
        if (isSource(name) || (found.empty() && !mayRead(name)))
            return MendedFiles::Open(name, mode);
        const auto file = mesh::MappedFile::open(found.empty() ? name : found);
        return file.ok() ? streamOf(mtlForAssimp(textOf(*file))) : MendedFiles::Open(name, mode);
    }

private:
    /// As the OBJ names it: Assimp puts the OBJ's folder before that, and leaves blanks after it.
    std::string asNamed(std::string_view name) const {
        std::string folder = std::filesystem::path(path_).parent_path().string();
        if (!folder.empty() && folder.back() != '/')
            folder += '/';
        if (name.starts_with(folder))
            name.remove_prefix(folder.size());
        return std::string(name.substr(0, name.find_last_not_of(" \t") + 1));
    }
};

}  // namespace

std::unique_ptr<Assimp::IOSystem> assimpFiles(const AssimpFormat& format, const std::string& path) {
    if (format.isGltf())
        return std::make_unique<UriFiles>(path);
    if (format.extension == ".obj")
        return std::make_unique<ObjFiles>(path);
    if (isMended(format))
        return std::make_unique<MendedFiles>(path);
    return std::make_unique<SourceFiles>(path);
}

}  // namespace eyrie::import
