// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/mesh_reader.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <optional>
#include <string_view>
#include <system_error>
#include <utility>

#include <absl/status/status.h>
#include <fmt/format.h>

#include "access/printable.h"
#include "fabric/status.h"
#include "renderer/import/assimp_formats.h"
#include "renderer/import/assimp_reader.h"
#include "renderer/import/jdn_reader.h"
#include "renderer/import/named_images.h"
#include "renderer/import/obj_materials.h"
#include "renderer/import/obj_textures.h"
#include "renderer/import/ply_reader.h"
#include "renderer/import/source_lights.h"
#include "renderer/import/texture_files.h"
#include "renderer/mesh/eym_format.h"
#include "renderer/mesh/mapped_file.h"

namespace eyrie::import {
namespace {

namespace fs = std::filesystem;

bool endsWith(const std::string& path, std::string_view ending) {
    return path.size() >= ending.size() &&
           std::equal(ending.rbegin(), ending.rend(), path.rbegin(), [](char a, char b) {
               return a == (b >= 'A' && b <= 'Z' ? b - 'A' + 'a' : b);
           });
}

bool isMeshName(const std::string& path) {
    return endsWith(path, ".ply") || endsWith(path, ".jdn") || findAssimpFormat(path) != nullptr;
}

/// What unpacks a mesh whose name says that it is packed, as archives of scans have them.
std::optional<std::string_view> unpackerOf(const std::string& path) {
    constexpr std::array<std::pair<std::string_view, std::string_view>, 5> kUnpackers = {
        {{".gz", "gunzip"},
         {".bz2", "bunzip2"},
         {".xz", "unxz"},
         {".zst", "unzstd"},
         {".zip", "unzip"}}};
    for (const auto& [ending, unpacker] : kUnpackers)
        if (endsWith(path, ending) && isMeshName(path.substr(0, path.size() - ending.size())))
            return unpacker;
    return std::nullopt;
}

std::string_view textOf(const mesh::MappedFile& file) {
    const auto bytes = file.bytes();
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

bool looksLikePly(std::string_view text) {
    return text.starts_with("ply") && text.size() > 3 && (text[3] == '\n' || text[3] == '\r');
}

/// Names of files that `text` mentions: what follows `mark`, up to one of `ends`.
std::vector<std::string> mentionedFiles(std::string_view text, std::string_view mark,
                                        std::string_view ends) {
    std::vector<std::string> names;
    for (std::size_t at = text.find(mark); at != std::string_view::npos;) {
        const std::size_t begin = text.find_first_not_of(" \t:=\"", at + mark.size());
        if (begin == std::string_view::npos)
            break;
        const std::size_t end = std::min(text.find_first_of(ends, begin), text.size());
        if (end - begin < 1024)  // a name, not data
            names.emplace_back(text.substr(begin, end - begin));
        at = text.find(mark, end);
    }
    std::sort(names.begin(), names.end());
    names.erase(std::unique(names.begin(), names.end()), names.end());
    return names;
}

/// Where a kind of file names others.
struct Mention {
    std::string_view ending;
    std::string_view mark;
    std::string_view ends;
};
constexpr std::array kMentions = {
    Mention{".gltf", "\"uri\"", "\""},    Mention{".jdn", "Map Path", "\r\n"},
    Mention{".ac", "\ntexture", "\"\n"},  Mention{".ac3d", "\ntexture", "\"\n"},
    Mention{".acc", "\ntexture", "\"\n"},
};

/// The names of files in the one at `path`.
absl::StatusOr<std::vector<std::string>> namesIn(const std::string& path) {
    ASSIGN_OR_RETURN(const mesh::MappedFile file, mesh::MappedFile::open(path));
    const std::string_view text = textOf(file);
    if (looksLikePly(text) || endsWith(path, ".ply"))
        return texturesOfPly(text, path);
    if (endsWith(path, ".mtl"))
        return texturesOfMtl(text);
    if (endsWith(path, ".obj"))
        return materialFilesOf(text, path);
    const auto kind = std::ranges::find_if(
        kMentions, [&](const Mention& mention) { return endsWith(path, mention.ending); });
    if (kind == kMentions.end())
        return imagesNamedIn(text);
    return mentionedFiles(text, kind->mark, kind->ends);
}

/// Adds the files that the one at `path` names, as far as they exist, and what those name. It is
/// the source at `source` or one of its companions.
absl::Status addCompanions(const std::string& path, const std::string& source,
                           std::vector<std::string>& found) {
    ASSIGN_OR_RETURN(const std::vector<std::string> names, namesIn(path));
    for (const std::string& name : names) {
        const std::string companion = findTexture(name, source, path);
        if (companion.empty() || companion == path || std::ranges::count(found, companion) > 0)
            continue;
        found.push_back(companion);
        if (endsWith(path, ".obj"))
            RETURN_IF_ERROR(addCompanions(companion, source, found));
    }
    return absl::OkStatus();
}

/// By the reader of its format.
absl::StatusOr<TriangleMesh> parseMesh(std::string_view text, const std::string& path,
                                       const ImportControl& control, std::uint64_t memoryBytes) {
    if (looksLikePly(text) || endsWith(path, ".ply"))
        return parsePly(text, path, control, memoryBytes);
    if (looksLikeJdn(text) || endsWith(path, ".jdn"))
        return parseJdn(text, path, control, memoryBytes);
    return readWithAssimp(path, ReadingLimits::forFile(bytesToRead(path), memoryBytes), control);
}

absl::StatusOr<TriangleMesh> readAsItIs(const std::string& path, const ImportControl& control,
                                        const MeshReading& reading) {
    if (!isMeshSource(path))
        return absl::InvalidArgumentError(
            fmt::format("{}: found the extension '{}', expected one of {}; convert the file", path,
                        fs::path(path).extension().string(), meshSourceEndings()));
    ASSIGN_OR_RETURN(const mesh::MappedFile file, mesh::MappedFile::open(path));
    if (const auto unpacker = unpackerOf(path))
        return absl::InvalidArgumentError(
            fmt::format("{}: is packed; unpack it first ({})", path, *unpacker));
    const std::string_view text = textOf(file);
    ASSIGN_OR_RETURN(TriangleMesh mesh, parseMesh(text, path, control, reading.memoryBytes));
    if (reading.onlyNormalsOfEdges && !statesEdges(path))
        mesh.normals = {};
    RETURN_IF_ERROR(loadTextures(mesh, path, control, reading.memoryBytes));
    limitLights(mesh);
    return mesh;
}

}  // namespace

bool isPly(const std::string& path) {
    const auto file = mesh::MappedFile::open(path);
    return file.ok() && (looksLikePly(textOf(*file)) || endsWith(path, ".ply"));
}

bool isMeshSource(const std::string& path) { return isMeshName(path) || unpackerOf(path); }

bool statesEdges(const std::string& path) { return !isPly(path) && !endsWith(path, ".stl"); }

std::string meshSourceEndings() {
    std::string endings = ".ply, .jdn";
    for (const AssimpFormat& format : assimpFormats())
        endings += fmt::format(", {}", format.extension);
    return endings;
}

absl::StatusOr<TriangleMesh> readMesh(const std::string& path, const ImportControl& control,
                                      const MeshReading& reading) {
    absl::StatusOr<TriangleMesh> mesh = readAsItIs(path, control, reading);
    // Names in files are of any bytes, and go to terminals from here.
    if (!mesh.ok()) {
        const auto message = mesh.status().message();
        return absl::Status(mesh.status().code(),
                            access::printableUtf8({message.data(), message.size()}));
    }
    for (std::string& note : mesh->notes) note = access::printableUtf8(note);
    return mesh;
}

absl::StatusOr<std::vector<std::string>> companionsOf(const std::string& path) {
    std::vector<std::string> found;
    RETURN_IF_ERROR(addCompanions(path, path, found));
    return found;
}

std::uint64_t bytesToRead(const std::string& path) {
    std::uint64_t sum = 0;
    const auto add = [&sum](const std::string& file) {
        std::error_code ignored;
        const std::uintmax_t bytes = fs::file_size(file, ignored);
        sum += ignored ? 0 : bytes;
    };
    add(path);
    if (!endsWith(path, ".gltf"))
        return sum;  // what others name are images and materials, which are read on their own
    if (const auto companions = companionsOf(path); companions.ok())
        for (const std::string& companion : *companions)
            if (!isImageName(companion))
                add(companion);
    return sum;
}

absl::StatusOr<std::uint64_t> meshSourceHash(std::span<const std::string> paths) {
    std::uint64_t hash = 0;
    for (const std::string& path : paths) {
        ASSIGN_OR_RETURN(const std::uint64_t own, mesh::contentHash(path));
        hash = hash * 31 + own;
        ASSIGN_OR_RETURN(const std::vector<std::string> others, companionsOf(path));
        for (const std::string& other : others) {
            ASSIGN_OR_RETURN(const std::uint64_t part, mesh::contentHash(other));
            hash = hash * 31 + part;
        }
    }
    return hash;
}

}  // namespace eyrie::import
