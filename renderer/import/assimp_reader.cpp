// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/assimp_reader.h"

#include <algorithm>
#include <cstddef>
#include <exception>
#include <filesystem>
#include <iterator>
#include <memory>
#include <new>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include <absl/status/status.h>
#include <assimp/IOSystem.hpp>
#include <assimp/Importer.hpp>
#include <assimp/config.h>
#include <assimp/scene.h>
#include <fmt/format.h>

#include "fabric/status.h"
#include "renderer/import/assimp_caveats.h"
#include "renderer/import/assimp_files.h"
#include "renderer/import/assimp_formats.h"
#include "renderer/import/assimp_log.h"
#include "renderer/import/assimp_meshes.h"
#include "renderer/import/gltf_buffers.h"
#include "renderer/import/gltf_chunks.h"
#include "renderer/import/gltf_extensions.h"
#include "renderer/import/gltf_unpacking.h"
#include "renderer/import/obj_materials.h"
#include "renderer/import/stl_colours.h"
#include "renderer/import/stl_length.h"
#include "renderer/import/stl_text.h"
#include "renderer/import/three_mf.h"
#include "renderer/mesh/mapped_file.h"

namespace eyrie::import {
namespace {

/// An AC3D file without the further textures that a race track's surfaces have (skid marks,
/// shadows): of several Assimp takes the last.
std::string withFirstTextures(std::span<const std::byte> bytes) {
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    std::string kept;
    for (std::size_t at = 0; at < text.size();) {
        const std::size_t end = std::min(text.find('\n', at), text.size() - 1) + 1;
        std::string_view line = text.substr(at, end - at);
        at = end;
        const std::string_view use = line.substr(std::min(line.find_last_of("\" "), line.size()));
        const bool isTexture = line.starts_with("texture ");
        if (!isTexture ||
            !(use.starts_with(" tiled") || use.starts_with(" skids") || use.starts_with(" shad")))
            kept += line;
    }
    return kept;
}

std::string_view textOf(const mesh::MappedFile& file) {
    const auto bytes = file.bytes();
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// What Assimp reads instead of a file that it would take for another or refuse; nothing for
/// others.
absl::StatusOr<std::optional<std::string>> instead(const mesh::MappedFile& file,
                                                   const std::string& path,
                                                   const AssimpFormat& format,
                                                   std::vector<std::string>& notes) {
    if (format.extension.starts_with(".ac"))
        return withFirstTextures(file.bytes());
    if (format.isGltf())
        return unpackGltf(file.bytes(), path, notes);
    if (format.extension == ".stl") {
        std::optional<std::string> text = stlTextForAssimp(textOf(file));
        return text ? std::move(text) : stlForAssimp(file.bytes());
    }
    return std::nullopt;
}

/// Null with the importer's own message where it cannot.
absl::StatusOr<const aiScene*> parse(Assimp::Importer& importer, const mesh::MappedFile& file,
                                     const std::string& path, const AssimpFormat& format,
                                     std::vector<std::string>& notes) {
    ASSIGN_OR_RETURN(const std::optional<std::string> text, instead(file, path, format, notes));
    if (text)
        return importer.ReadFileFromMemory(text->data(), text->size(), 0,
                                           format.isGltf()              ? "glb"
                                           : format.extension == ".stl" ? "stl"
                                                                        : "ac");
    if (format.extension == ".3mf") {
        ASSIGN_OR_RETURN(notes, notesOf3mf(path));
    }
    const aiScene* scene = importer.ReadFile(path, 0);
    if (scene != nullptr && format.extension == ".obj")
        notes = applyObjMaterials(path, textOf(file), *scene);
    return scene;
}

absl::StatusOr<TriangleMesh> read(const std::string& path, const AssimpFormat& format) {
    try {
        const AssimpLog log;
        Assimp::Importer importer;
        importer.SetPropertyInteger(AI_CONFIG_IMPORT_MD3_HANDLE_MULTIPART, 0);  // this file alone
        importer.SetPropertyInteger(AI_CONFIG_IMPORT_NO_SKELETON_MESHES, 1);  // none made of bones
        importer.SetIOHandler(assimpFiles(format, path).release());           // which it deletes
        std::vector<std::string> notes;
        ASSIGN_OR_RETURN(const mesh::MappedFile file, mesh::MappedFile::open(path));
        ASSIGN_OR_RETURN(const aiScene* scene, parse(importer, file, path, format, notes));
        if (scene != nullptr) {
            absl::StatusOr<TriangleMesh> mesh = gatherMeshes(*scene, format, textOf(file));
            std::ranges::move(log.notes(), std::back_inserter(notes));
            if (mesh.ok())
                std::ranges::move(notes, std::back_inserter(mesh->notes));
            return mesh;
        }
        const std::string why = importer.GetErrorString();
        if (why.find("bad_alloc") != std::string::npos)
            throw std::bad_alloc();
        return absl::InvalidArgumentError(
            fmt::format("cannot be read as {}: {}; export it again, or in another format",
                        format.extension.substr(1), why.empty() ? "no reason is given" : why));
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const std::exception& error) {
        return absl::InvalidArgumentError(
            fmt::format("cannot be read as {}: {}; export it again, or in another format",
                        format.extension.substr(1), error.what()));
    }
}

/// Which of glTF's two a file ought to have that has the other; nothing where it is right.
std::optional<std::string_view> otherEndingOf(std::span<const std::byte> bytes,
                                              const AssimpFormat& format) {
    if (format.extension == ".gltf" && isGlb(bytes))
        return ".glb";
    std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    if (text.starts_with(kByteOrderMark))
        text.remove_prefix(kByteOrderMark.size());
    if (format.extension == ".glb" && text.starts_with('{'))
        return ".gltf";
    return std::nullopt;
}

}  // namespace

absl::StatusOr<TriangleMesh> readWithAssimp(const std::string& path, const ReadingLimits& limits,
                                            const ImportControl& control) {
    // Says what is wrong with the path better than the library does.
    ASSIGN_OR_RETURN(const mesh::MappedFile file, mesh::MappedFile::open(path));
    const AssimpFormat* format = findAssimpFormat(path);
    if (format == nullptr)
        return absl::InvalidArgumentError(fmt::format("{}: is of no format known here", path));
    if (file.bytes().empty())
        return absl::InvalidArgumentError(
            fmt::format("{}: is empty; copy it again, or export it again", path));
    if (const auto ending = otherEndingOf(file.bytes(), *format))
        return absl::InvalidArgumentError(
            fmt::format("{}: is a {} file by what is in it; rename it so", path, *ending));
    if (format->isGltf())
        if (const absl::Status readable = checkGltfExtensions(file.bytes()); !readable.ok())
            return fabric::withContext(readable, path);
    control.report("reading", 0);
    auto result = readInOwnProcess([&] { return read(path, *format); }, limits, control);
    control.report("reading", 1);
    if (absl::IsInvalidArgument(result.status()) && format->extension == ".stl")
        if (const auto wrong = wrongLengthOfStl(file.bytes()))  // of which Assimp knows nothing
            return absl::InvalidArgumentError(fmt::format("{}: {}", path, *wrong));
    if (absl::IsInvalidArgument(result.status()) && format->isGltf())
        if (const auto wrong = shortBufferOfGltf(file.bytes(), path))  // which Assimp does not name
            return absl::InvalidArgumentError(fmt::format("{}: {}", path, *wrong));
    if (!result.ok())
        return fabric::withContext(result.status(), path);
    for (std::string& caveat : caveats(file.bytes(), *format))
        result->notes.push_back(std::move(caveat));
    return result;
}

absl::StatusOr<TriangleMesh> readWithAssimp(const std::string& path, const ImportControl& control) {
    std::error_code ignored;
    const std::uintmax_t bytes = std::filesystem::file_size(path, ignored);
    return readWithAssimp(path, ReadingLimits::forFile(ignored ? 0 : bytes), control);
}

}  // namespace eyrie::import
