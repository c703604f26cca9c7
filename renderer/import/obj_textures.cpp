// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/obj_textures.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cstddef>
#include <span>
#include <system_error>

#include <absl/status/statusor.h>
#include <assimp/material.h>
#include <assimp/scene.h>

#include "renderer/import/texture_files.h"
#include "renderer/mesh/mapped_file.h"

namespace eyrie::import {
namespace {

constexpr std::string_view kBlank = " \t\r";

std::string_view trimmed(std::string_view text) {
    text.remove_prefix(std::min(text.find_first_not_of(kBlank), text.size()));
    return text.substr(0, text.find_last_not_of(kBlank) + 1);
}

/// Takes a word from the front of `text`, which has no blanks at its ends.
std::string_view takeWord(std::string_view& text) {
    const std::string_view word = text.substr(0, text.find_first_of(kBlank));
    text = trimmed(text.substr(word.size()));
    return word;
}

/// Takes a line from the front of `text`.
std::string_view takeLine(std::string_view& text) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    return trimmed(line);
}

/// Takes up to three numbers from the front of `text`, but not its last word, which is a name.
/// The first two go to `numbers`, as far as they are there.
void takeNumbers(std::string_view& text, glm::vec2& numbers) {
    for (int i = 0; i < 3; ++i) {
        std::string_view rest = text;
        const std::string_view word = takeWord(rest);
        float number = 0;
        const auto parsed = std::from_chars(word.data(), word.data() + word.size(), number);
        if (rest.empty() || parsed.ec != std::errc() || parsed.ptr != word.data() + word.size())
            return;
        if (i < 2)
            numbers[i] = number;
        text = rest;
    }
}

/// In whatever case, as Assimp takes it.
bool isMapKd(std::string_view keyword) {
    return std::ranges::equal(keyword, std::string_view("map_kd"), {},
                              [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
}

struct Option {
    std::string_view name;
    int words;
};
/// Those that are passed over, with the words that follow them.
constexpr std::array kOptions = {
    Option{"-blendu", 1}, Option{"-blendv", 1}, Option{"-bm", 1},      Option{"-boost", 1},
    Option{"-cc", 1},     Option{"-clamp", 1},  Option{"-imfchan", 1}, Option{"-mm", 2},
    Option{"-texres", 1}, Option{"-type", 1},
};

/// Gives `material` what its file says where Assimp has not got it. Assimp's shift comes before
/// its scale.
void apply(const ObjTexture& texture, aiMaterial& material) {
    const aiString name(texture.name);
    material.AddProperty(&name, AI_MATKEY_TEXTURE_DIFFUSE(0));
    if (texture.scale == glm::vec2(1) && texture.offset == glm::vec2(0))
        return;
    aiUVTransform transform;
    transform.mScaling = {texture.scale.x, texture.scale.y};
    transform.mTranslation = {texture.scale.x != 0 ? texture.offset.x / texture.scale.x : 0,
                              texture.scale.y != 0 ? texture.offset.y / texture.scale.y : 0};
    material.AddProperty(&transform, 1, AI_MATKEY_UVTRANSFORM_DIFFUSE(0));
}

}  // namespace

ObjTexture parseMapKd(std::string_view arguments) {
    ObjTexture texture;
    std::string_view rest = trimmed(arguments);
    while (rest.starts_with('-')) {
        std::string_view after = rest;
        const std::string_view name = takeWord(after);
        glm::vec2 ignored{0};
        const auto* const option = std::ranges::find(kOptions, name, &Option::name);
        if (name == "-s" || name == "-o" || name == "-t")
            takeNumbers(after, name == "-s"   ? texture.scale
                               : name == "-o" ? texture.offset
                                              : ignored);
        else if (option == kOptions.end())
            break;  // a name that begins so
        else
            for (int i = 0; i < option->words; ++i) takeWord(after);
        rest = after;
    }
    texture.name = rest;
    return texture;
}

std::vector<std::string> texturesOfMtl(std::string_view mtl) {
    std::vector<std::string> names;
    while (!mtl.empty()) {
        std::string_view line = takeLine(mtl);
        if (isMapKd(takeWord(line)))
            names.push_back(parseMapKd(line).name);
    }
    std::ranges::sort(names);
    return names;
}

std::map<std::string, ObjTexture> objTexturesOf(std::string_view mtl) {
    std::map<std::string, ObjTexture> textures;
    std::string material;
    while (!mtl.empty()) {
        std::string_view line = takeLine(mtl);
        const std::string_view keyword = takeWord(line);
        if (keyword == "newmtl")
            material = line;
        else if (isMapKd(keyword) && line.starts_with('-'))
            textures.insert_or_assign(material, parseMapKd(line));
        else if (isMapKd(keyword))
            textures.erase(material);
    }
    return textures;
}

void applyObjTextures(const std::string& path, std::string_view obj, const aiScene& scene) {
    constexpr std::string_view kLibrary = "mtllib";
    std::map<std::string, ObjTexture> textures;
    for (std::size_t at = obj.find(kLibrary); at != std::string_view::npos;
         at = obj.find(kLibrary, at + 1)) {
        std::string_view rest = obj.substr(at + kLibrary.size());
        const std::string found = findTexture(std::string(takeLine(rest)), path);
        const absl::StatusOr<mesh::MappedFile> file = mesh::MappedFile::open(found);
        if (found.empty() || !file.ok())
            continue;
        const auto bytes = file->bytes();
        textures.merge(objTexturesOf({reinterpret_cast<const char*>(bytes.data()), bytes.size()}));
    }
    for (aiMaterial* material : std::span(scene.mMaterials, scene.mNumMaterials)) {
        aiString name;
        const auto texture = material->Get(AI_MATKEY_NAME, name) == AI_SUCCESS
                                 ? textures.find(name.C_Str())
                                 : textures.end();
        if (texture != textures.end() && !texture->second.name.empty())
            apply(texture->second, *material);
    }
}

}  // namespace eyrie::import
