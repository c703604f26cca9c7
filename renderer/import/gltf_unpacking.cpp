// SPDX-License-Identifier: Apache-2.0
// Khronos' specifications of glTF 2.0, KHR_mesh_quantization and EXT_meshopt_compression.
#include "renderer/import/gltf_unpacking.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <limits>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include <absl/status/status.h>
#include <absl/strings/escaping.h>
#include <absl/strings/string_view.h>
#include <fmt/format.h>
#include <meshoptimizer.h>

#include "access/printable.h"
#include "fabric/status.h"
#include "renderer/import/gltf_chunks.h"
#include "renderer/import/gltf_json.h"
#include "renderer/import/gltf_mending.h"
#include "renderer/import/texture_files.h"
#include "renderer/mesh/mapped_file.h"

namespace eyrie::import {
namespace {

using Bytes = std::vector<std::byte>;

constexpr const char* kQuantization = "KHR_mesh_quantization";
constexpr const char* kCompression = "EXT_meshopt_compression";
/// Bytes of one: a group of 16 equal bytes takes two bits.
constexpr std::uint64_t kMostUnpacked = 64;
constexpr int kFloat = 5126;
constexpr std::uint64_t kLongestStride = 256;

absl::Status wrong(std::string_view where, std::string_view what) {
    return absl::InvalidArgumentError(
        fmt::format("cannot be read as glTF: {} {}; export it again", where, what));
}

absl::StatusOr<std::uint64_t> countAt(const Json& object, const char* key, std::string_view where,
                                      std::optional<std::uint64_t> otherwise = {}) {
    const Json& value = at(object, key);
    if (value.is_null() && otherwise)
        return *otherwise;
    if (!value.is_number_unsigned())
        return wrong(where, fmt::format("has no whole number '{}'", key));
    return value.get<std::uint64_t>();
}

absl::StatusOr<std::span<const std::byte>> part(std::span<const std::byte> bytes,
                                                std::uint64_t offset, std::uint64_t length,
                                                std::string_view where) {
    if (offset > bytes.size() || length > bytes.size() - offset)
        return wrong(
            where, fmt::format("has bytes {} to {} of {}", offset, offset + length, bytes.size()));
    return bytes.subspan(offset, length);
}

/// Integers of a component type; null for others.
struct Integers {
    std::size_t bytes = 0;
    float (*value)(const std::byte* at) = nullptr;
    float most = 0;  ///< stands for 1 where they are normalised
};

template <typename Integer>
Integers integersOf() {
    return {sizeof(Integer),
            [](const std::byte* at) {
                Integer value;
                std::memcpy(&value, at, sizeof value);
                return static_cast<float>(value);
            },
            static_cast<float>(std::numeric_limits<Integer>::max())};
}

Integers integersOf(std::uint64_t componentType) {
    switch (componentType) {
        case 5120:
            return integersOf<std::int8_t>();
        case 5121:
            return integersOf<std::uint8_t>();
        case 5122:
            return integersOf<std::int16_t>();
        case 5123:
            return integersOf<std::uint16_t>();
        case 5125:
            return integersOf<std::uint32_t>();
        default:
            return {};
    }
}

/// 0 for matrices, which vertices have none of.
std::size_t componentsOf(const std::string& type) {
    constexpr std::array<std::string_view, 4> kTypes = {"SCALAR", "VEC2", "VEC3", "VEC4"};
    const auto found = std::ranges::find(kTypes, type);
    return found == kTypes.end() ? 0 : static_cast<std::size_t>(found - kTypes.begin()) + 1;
}

/// What Assimp takes for floats; it knows that colours need not be.
bool isGeometry(std::string_view attribute) {
    constexpr std::array kNames = {"POSITION", "NORMAL", "TANGENT", "TEXCOORD_"};
    return std::ranges::any_of(kNames,
                               [&](const char* name) { return attribute.starts_with(name); });
}

/// What EXT_meshopt_compression says of a buffer view.
struct Packed {
    std::span<const std::byte> bytes;
    std::uint64_t count = 0;
    std::uint64_t stride = 0;
    std::string mode;
    std::string filter;
};

const unsigned char* dataOf(const Packed& packed) {
    return reinterpret_cast<const unsigned char*>(packed.bytes.data());
}

/// Undoes the filter that made vertices pack better; false where there is none of its kind.
bool unfilter(const Packed& packed, Bytes& out) {
    const auto count = static_cast<std::size_t>(packed.count);
    const auto stride = static_cast<std::size_t>(packed.stride);
    if (packed.filter.empty() || packed.filter == "NONE")
        return true;
    if (packed.filter == "OCTAHEDRAL" && (stride == 4 || stride == 8))
        meshopt_decodeFilterOct(out.data(), count, stride);
    else if (packed.filter == "QUATERNION" && stride == 8)
        meshopt_decodeFilterQuat(out.data(), count, stride);
    else if (packed.filter == "EXPONENTIAL")
        meshopt_decodeFilterExp(out.data(), count, stride);
    else
        return false;
    return true;
}

bool unpackVertices(const Packed& packed, Bytes& out) {
    return packed.stride % 4 == 0 && packed.stride > 0 && packed.stride <= kLongestStride &&
           meshopt_decodeVertexBuffer(out.data(), packed.count, packed.stride, dataOf(packed),
                                      packed.bytes.size()) == 0 &&
           unfilter(packed, out);
}

bool unpackIndices(const Packed& packed, Bytes& out) {
    if (packed.stride != 2 && packed.stride != 4)
        return false;
    if (packed.mode == "TRIANGLES")
        return packed.count % 3 == 0 &&
               meshopt_decodeIndexBuffer(out.data(), packed.count, packed.stride, dataOf(packed),
                                         packed.bytes.size()) == 0;
    return packed.mode == "INDICES" &&
           meshopt_decodeIndexSequence(out.data(), packed.count, packed.stride, dataOf(packed),
                                       packed.bytes.size()) == 0;
}

absl::StatusOr<Bytes> unpacked(const Packed& packed, std::string_view where) {
    const std::uint64_t most = kMostUnpacked * packed.bytes.size();
    if (packed.stride == 0 || packed.count > most / packed.stride)
        return wrong(where, fmt::format("has {} times {} bytes packed in {}", packed.count,
                                        packed.stride, packed.bytes.size()));
    Bytes out(packed.count * packed.stride);
    const bool isWhole =
        packed.mode == "ATTRIBUTES" ? unpackVertices(packed, out) : unpackIndices(packed, out);
    if (!isWhole)
        return wrong(where, "is not packed as it says, or is damaged");
    return out;
}

/// Takes a name off a list of names, and the list away when none is left.
void forget(Json& root, const char* list, const char* name) {
    if (!at(root, list).is_array())
        return;
    Json& names = root[list];
    names.erase(std::remove(names.begin(), names.end(), Json(name)), names.end());
    if (names.empty())
        root.erase(list);
}

class Unpacking {
public:
    explicit Unpacking(const std::string& path) : path_(path) {}

    absl::StatusOr<std::optional<std::string>> run(const GltfChunks& chunks,
                                                   std::vector<std::string>& notes);

private:
    absl::Status readBuffer(const Json& buffer, std::size_t index);
    absl::StatusOr<Bytes> bufferAt(const std::string& uri, std::string_view where) const;
    absl::StatusOr<std::span<const std::byte>> bufferOf(const Json& view,
                                                        std::string_view where) const;
    absl::Status unpackView(Json& view, std::size_t index);
    absl::Status toFloats(Json& accessor, std::string_view where);
    void lookForGeometry();
    void markGeometry(const Json& attributes);
    bool isNeeded() const;
    absl::Status checkRoom(std::uint64_t bytes) const;
    void addView(const Json& view, std::span<const std::byte> bytes);
    std::span<const std::byte> bytesOfView(std::size_t index) const;

    const std::string& path_;
    Json root_;
    std::vector<Bytes> buffers_;
    std::vector<bool> isGeometry_;  ///< of accessors
    Json views_ = Json::array();    ///< unpacked
    Bytes binary_;                  ///< which they are in
    std::uint64_t most_ = 0;        ///< bytes of it
};

absl::StatusOr<Bytes> Unpacking::bufferAt(const std::string& uri, std::string_view where) const {
    constexpr std::string_view kBase64 = ";base64,";
    if (uri.starts_with("data:")) {
        std::string bytes;
        const std::size_t mark = uri.find(kBase64);
        if (mark == std::string::npos ||
            !absl::Base64Unescape(absl::string_view(uri).substr(mark + kBase64.size()), &bytes))
            return wrong(where, "has data that is not in base 64");
        const auto* begin = reinterpret_cast<const std::byte*>(bytes.data());
        return Bytes(begin, begin + bytes.size());
    }
    const std::string file = findTexture(uri, path_);
    if (file.empty())
        return wrong(where, fmt::format("is in '{}', which is not there", uri));
    ASSIGN_OR_RETURN(const mesh::MappedFile mapped, mesh::MappedFile::open(file));
    return Bytes(mapped.bytes().begin(), mapped.bytes().end());
}

/// One that is there for readers of plain glTF alone stays empty, and so does one of no address,
/// which is the file's own.
absl::Status Unpacking::readBuffer(const Json& buffer, std::size_t index) {
    Bytes& bytes = buffers_.emplace_back();
    const std::string uri = textAt(buffer, "uri");
    if (uri.empty() || at(at(at(buffer, "extensions"), kCompression), "fallback") == true)
        return absl::OkStatus();
    ASSIGN_OR_RETURN(bytes, bufferAt(uri, fmt::format("buffer {}", index)));
    return absl::OkStatus();
}

absl::StatusOr<std::span<const std::byte>> Unpacking::bufferOf(const Json& view,
                                                               std::string_view where) const {
    ASSIGN_OR_RETURN(const std::uint64_t buffer, countAt(view, "buffer", where));
    if (buffer >= buffers_.size())
        return wrong(where, fmt::format("is in buffer {} of {}", buffer, buffers_.size()));
    ASSIGN_OR_RETURN(const std::uint64_t offset, countAt(view, "byteOffset", where, 0));
    ASSIGN_OR_RETURN(const std::uint64_t length, countAt(view, "byteLength", where));
    return part(buffers_[buffer], offset, length, where);
}

/// Views and accessors may share bytes, any number of them, and each has them unpacked for itself.
absl::Status Unpacking::checkRoom(std::uint64_t bytes) const {
    if (binary_.size() + bytes > most_)
        return wrong("it", fmt::format("unpacks to more than {} times its size", kMostUnpacked));
    return absl::OkStatus();
}

void Unpacking::addView(const Json& view, std::span<const std::byte> bytes) {
    binary_.resize((binary_.size() + 3) / 4 * 4);
    Json added = view;
    added["buffer"] = 0;
    added["byteOffset"] = binary_.size();
    added["byteLength"] = bytes.size();
    views_.push_back(std::move(added));
    binary_.insert(binary_.end(), bytes.begin(), bytes.end());
}

std::span<const std::byte> Unpacking::bytesOfView(std::size_t index) const {
    return std::span(binary_).subspan(views_[index]["byteOffset"].get<std::size_t>(),
                                      views_[index]["byteLength"].get<std::size_t>());
}

absl::Status Unpacking::unpackView(Json& view, std::size_t index) {
    const std::string where = fmt::format("bufferView {}", index);
    const Json code = at(at(view, "extensions"), kCompression);
    if (code.is_null()) {
        ASSIGN_OR_RETURN(const auto bytes, bufferOf(view, where));
        RETURN_IF_ERROR(checkRoom(bytes.size()));
        addView(view, bytes);
        return absl::OkStatus();
    }
    Packed packed;
    ASSIGN_OR_RETURN(packed.bytes, bufferOf(code, where));
    ASSIGN_OR_RETURN(packed.count, countAt(code, "count", where));
    ASSIGN_OR_RETURN(packed.stride, countAt(code, "byteStride", where));
    packed.mode = textAt(code, "mode");
    packed.filter = textAt(code, "filter");
    ASSIGN_OR_RETURN(const Bytes bytes, unpacked(packed, where));
    RETURN_IF_ERROR(checkRoom(bytes.size()));
    view["extensions"].erase(kCompression);
    if (packed.mode == "ATTRIBUTES")
        view["byteStride"] = packed.stride;
    addView(view, bytes);
    return absl::OkStatus();
}

void Unpacking::markGeometry(const Json& attributes) {
    if (!attributes.is_object())
        return;
    for (const auto& [name, accessor] : attributes.items())
        if (isGeometry(name) && accessor.is_number_unsigned() &&
            accessor.get<std::uint64_t>() < isGeometry_.size())
            isGeometry_[accessor.get<std::size_t>()] = true;
}

/// Integers to floats, one after another in a view of their own.
absl::Status Unpacking::toFloats(Json& accessor, std::string_view where) {
    ASSIGN_OR_RETURN(const std::uint64_t type, countAt(accessor, "componentType", where));
    const Integers integers = integersOf(type);
    if (integers.value == nullptr || at(accessor, "bufferView").is_null())
        return absl::OkStatus();
    if (accessor.contains("sparse"))
        return wrong(where, "is quantised and sparse, which is not read");
    const std::size_t components = componentsOf(textAt(accessor, "type"));
    if (components == 0)
        return wrong(where, "is quantised, and no scalar or vector");
    ASSIGN_OR_RETURN(const std::uint64_t view, countAt(accessor, "bufferView", where));
    ASSIGN_OR_RETURN(const std::uint64_t offset, countAt(accessor, "byteOffset", where, 0));
    ASSIGN_OR_RETURN(const std::uint64_t count, countAt(accessor, "count", where));
    if (view >= views_.size())
        return wrong(where, fmt::format("is in bufferView {}, which is not there", view));
    const std::uint64_t own = components * integers.bytes;
    ASSIGN_OR_RETURN(const std::uint64_t stride, countAt(views_[view], "byteStride", where, own));
    const auto bytes = bytesOfView(view);
    if (stride < own || stride > kLongestStride || count > bytes.size() ||
        (count > 0 &&
         (count - 1) * stride + own + std::min(offset, bytes.size() + 1) > bytes.size()))
        return wrong(where, fmt::format("has {} elements, more than its bufferView", count));
    RETURN_IF_ERROR(checkRoom(count * components * sizeof(float)));
    const bool isNormalised = at(accessor, "normalized") == true;
    std::vector<float> floats;
    floats.reserve(count * components);
    for (std::uint64_t i = 0; i < count; ++i)
        for (std::size_t k = 0; k < components; ++k) {
            const float value =
                integers.value(bytes.data() + offset + i * stride + k * integers.bytes);
            floats.push_back(isNormalised ? std::max(value / integers.most, -1.0F) : value);
        }
    for (const char* key : {"normalized", "byteOffset", "min", "max"}) accessor.erase(key);
    accessor["componentType"] = kFloat;
    accessor["bufferView"] = views_.size();
    addView(Json::object(), std::as_bytes(std::span(floats)));
    return absl::OkStatus();
}

void Unpacking::lookForGeometry() {
    isGeometry_.resize(root_["accessors"].size());
    for (const Json& mesh : root_["meshes"])
        for (const Json& primitive : at(mesh, "primitives")) {
            markGeometry(at(primitive, "attributes"));
            for (const Json& target : at(primitive, "targets")) markGeometry(target);
        }
}

/// Whether anything is packed, or of integers that Assimp takes for floats.
bool Unpacking::isNeeded() const {
    const auto isPacked = [](const Json& view) {
        return !at(at(view, "extensions"), kCompression).is_null();
    };
    if (std::ranges::any_of(at(root_, "bufferViews"), isPacked))
        return true;
    for (std::size_t i = 0; i < isGeometry_.size(); ++i)
        if (const Json& accessor = at(root_, "accessors")[i];
            isGeometry_[i] && !at(accessor, "bufferView").is_null() &&
            at(accessor, "componentType") != kFloat)
            return true;
    return false;
}

absl::StatusOr<std::optional<std::string>> Unpacking::run(const GltfChunks& chunks,
                                                          std::vector<std::string>& notes) {
    root_ = parsedGltf(chunks.json);
    if (!root_.is_object())
        return std::nullopt;
    for (const char* list : {"buffers", "bufferViews", "accessors", "meshes"})
        if (!root_.contains(list) || !root_[list].is_array())
            root_[list] = Json::array();
    const bool isOdd = chunks.json.starts_with(kByteOrderMark) || !access::isUtf8(chunks.json);
    const bool isMended = mendGltf(root_, notes) || isOdd;
    lookForGeometry();
    if (!isMended && !isNeeded())
        return std::nullopt;
    for (const Json& buffer : root_["buffers"])
        RETURN_IF_ERROR(readBuffer(buffer, buffers_.size()));
    if (!buffers_.empty() && buffers_[0].empty())
        buffers_[0].assign(chunks.binary.begin(), chunks.binary.end());
    most_ = chunks.json.size();
    for (const Bytes& buffer : buffers_) most_ += buffer.size();
    most_ *= kMostUnpacked;
    for (Json& view : root_["bufferViews"]) RETURN_IF_ERROR(unpackView(view, views_.size()));
    for (std::size_t i = 0; i < isGeometry_.size(); ++i)
        if (Json& accessor = root_["accessors"][i];
            isGeometry_[i] || at(accessor, "normalized") == true)
            RETURN_IF_ERROR(toFloats(accessor, fmt::format("accessor {}", i)));
    root_["bufferViews"] = std::move(views_);
    root_["buffers"] = Json::array({Json{{"byteLength", binary_.size()}}});
    for (const char* list : {"extensionsUsed", "extensionsRequired"})
        for (const char* name : {kQuantization, kCompression}) forget(root_, list, name);
    return glbOf(root_.dump(-1, ' ', false, Json::error_handler_t::replace), binary_);
}

}  // namespace

absl::StatusOr<std::optional<std::string>> unpackGltf(std::span<const std::byte> bytes,
                                                      const std::string& path,
                                                      std::vector<std::string>& notes) {
    try {
        return Unpacking(path).run(gltfChunksOf(bytes), notes);
    } catch (const Json::exception& error) {
        return wrong("its JSON", fmt::format("is not glTF's ({})", error.what()));
    }
}

}  // namespace eyrie::import
