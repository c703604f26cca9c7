// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/jdn_reader.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <span>
#include <utility>
#include <vector>

#include <absl/status/status.h>
#include <fmt/format.h>

#include "fabric/status.h"
#include "renderer/import/jdn_lights.h"
#include "renderer/import/jdn_materials.h"
#include "renderer/import/jdn_text.h"

namespace eyrie::import {
namespace {

constexpr std::uint64_t kPollInterval = 65536;  // lines between looks at the stop token
/// The shortest line of a vertex or a face, `Vert=0 0 0` and its end.
constexpr std::size_t kLeastElementBytes = 11;

/// What a vertex, one more that texture coordinates make, and a face take while they are read: at
/// most twice their size, for arrays that are full are there beside those they are copied to.
constexpr std::uint64_t kVertexBytes =
    2 * (sizeof(fabric::Vec3) + sizeof(glm::vec3) + sizeof(fabric::Rgba) + sizeof(glm::vec2) +
         sizeof(std::uint16_t));
constexpr std::uint64_t kPlaceBytes = kVertexBytes + 2 * sizeof(glm::vec2);
constexpr std::uint64_t kFaceBytes = 2 * sizeof(std::array<std::uint32_t, 3>);
/// More than that of any byte of a scene: the shortest lines are of vertices.
constexpr std::uint64_t kMostPerByte = 1 + kPlaceBytes / kLeastElementBytes;

/// Known, and of no use here.
constexpr std::array<std::string_view, 6> kIgnoredKeys = {
    "Ambient", "Specular", "Shine", "Shine Strength", "Fall", "Face Normal"};

/// With single blanks between words.
std::string plainKey(std::string_view text) {
    std::string key;
    for (const char c : trimmed(text))
        if (!isBlank(c))
            key += c;
        else if (key.back() != ' ')
            key += ' ';
    return key;
}

std::string shown(std::string_view text) {
    std::string result(trimmed(text).substr(0, 40));
    std::replace_if(
        result.begin(), result.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
    return result;
}

std::uint8_t byteOf(double value) {
    return static_cast<std::uint8_t>(
        std::lround(255 * std::clamp(std::isfinite(value) ? value : 1.0, 0.0, 1.0)));
}

bool hasKey(std::string_view line, std::string_view key) {
    return line.starts_with(key) && trimmed(line.substr(key.size())).starts_with('=');
}

/// What a line of an object takes.
std::uint64_t bytesOf(std::string_view line) {
    line = trimmed(line);
    if (line.starts_with("Textured"))
        return line.find("Vert") != std::string_view::npos ? kPlaceBytes : kFaceBytes;
    return hasKey(line, "Vert") ? kVertexBytes : hasKey(line, "Face") ? kFaceBytes : 0;
}

/// About what reading a scene takes, which is in memory itself.
std::uint64_t readingBytes(std::string_view text) {
    std::uint64_t bytes = text.size();
    for (std::size_t begin = 0; begin < text.size();) {
        const std::size_t end = std::min(text.find('\n', begin), text.size());
        bytes += bytesOf(text.substr(begin, end - begin));
        begin = end + 1;
    }
    return bytes;
}

absl::Status checkMemory(std::string_view text, std::uint64_t memoryBytes) {
    if (memoryBytes == 0 || text.size() <= memoryBytes / kMostPerByte)
        return absl::OkStatus();
    const std::uint64_t needed = readingBytes(text);
    if (needed <= memoryBytes)
        return absl::OkStatus();
    return absl::ResourceExhaustedError(fmt::format(
        "reading it takes about {} MiB of memory, of which it may use {}; convert it to PLY, which "
        "is imported part by part, or allow more memory",
        (needed >> 20) + 1, memoryBytes >> 20));
}

class JdnParser {
public:
    JdnParser(std::string_view text, const ImportControl& control)
        : text_(text), control_(control) {}

    absl::StatusOr<TriangleMesh> parse();

private:
    enum class Section { None, Materials, Lights, Objects };

    absl::Status readLine(std::string_view line);
    absl::Status readValue(const std::string& key, std::string_view value);
    absl::Status openSection(Section section, std::string_view value, std::uint64_t& count);
    absl::Status readMaterialId(std::string_view value);
    absl::Status readDiffuse(std::string_view value);
    absl::Status readTransparency(std::string_view value);
    absl::Status readTexturedVertex(std::string_view value);
    absl::Status readTexturedFace(std::string_view value);
    absl::Status readCount(std::string_view value, std::uint64_t& count);
    absl::Status readObjectCount(std::string_view value, std::uint64_t& count);
    absl::Status readVertex(std::string_view value);
    absl::Status readNormal(std::string_view value);
    absl::Status readCorners(std::string_view value, std::uint64_t count, std::string_view what,
                             std::array<std::uint32_t, 3>& corners) const;
    absl::Status readFace(std::string_view value);
    absl::Status endObject();
    absl::Status checkCount(std::string_view what, std::uint64_t found,
                            std::uint64_t expected) const;
    absl::Status wrong(std::string_view found, std::string_view expected,
                       std::string_view remedy) const;
    void addNotes();

    std::string_view text_;
    const ImportControl& control_;
    std::uint64_t lineNumber_ = 0;
    std::size_t bytesRead_ = 0;
    Section section_ = Section::None;
    std::string key_;  // being read

    std::uint64_t materialsExpected_ = 0;
    JdnMaterials materials_;

    std::uint64_t lightsExpected_ = 0;
    JdnLights lights_;

    std::uint64_t objects_ = 0;  // begun
    std::uint64_t objectsExpected_ = 0;
    bool isInObject_ = false;
    JdnMaterial objectMaterial_;
    std::uint64_t vertices_ = 0;  // said to be in the object
    std::uint64_t faces_ = 0;
    std::size_t firstPosition_ = 0;  // of the object
    std::size_t firstTriangle_ = 0;
    bool hasNormals_ = false;
    std::uint64_t texturedVertices_ = 0;                  // said to be in the object
    std::vector<glm::vec2> places_;                       // the object's textured vertices
    std::vector<std::array<std::uint32_t, 3>> placesOf_;  // the corners of its faces

    std::uint64_t unknownKeys_ = 0;
    std::string firstUnknown_;
    std::uint64_t unknownMaterials_ = 0;
    std::uint64_t unseen_ = 0;  // objects without any opacity
    TriangleMesh mesh_;
};

absl::Status JdnParser::wrong(std::string_view found, std::string_view expected,
                              std::string_view remedy) const {
    return absl::InvalidArgumentError(fmt::format("line {}, {}: found {}, expected {}; {}",
                                                  lineNumber_, key_, found, expected, remedy));
}

absl::Status JdnParser::checkCount(std::string_view what, std::uint64_t found,
                                   std::uint64_t expected) const {
    if (found == expected)
        return absl::OkStatus();
    return absl::InvalidArgumentError(
        fmt::format("line {}, object {}: found {} lines {}, expected {}; the file is truncated or "
                    "damaged: copy or export it again",
                    lineNumber_, objects_ - 1, found, what, expected));
}

absl::Status JdnParser::readCount(std::string_view value, std::uint64_t& count) {
    if (!parseNumbers(value, std::span(&count, 1)))
        return wrong(fmt::format("'{}'", shown(value)), "a count", "repair the line");
    const std::uint64_t most = (text_.size() - bytesRead_) / kLeastElementBytes + 1;
    if (count > most)
        return wrong(fmt::format("{}", count),
                     fmt::format("at most {}, what the rest of the file may hold", most),
                     "the file is truncated or damaged: copy or export it again");
    return absl::OkStatus();
}

/// Of the object: corners that were read are below it, so it stays.
absl::Status JdnParser::readObjectCount(std::string_view value, std::uint64_t& count) {
    const std::uint64_t before = count;
    RETURN_IF_ERROR(readCount(value, count));
    if (before > 0 && count != before)
        return wrong(fmt::format("{}", count), fmt::format("{}, as the object said before", before),
                     "remove one of the lines or export the scene again");
    return absl::OkStatus();
}

absl::Status JdnParser::openSection(Section section, std::string_view value, std::uint64_t& count) {
    RETURN_IF_ERROR(endObject());
    section_ = section;
    return readCount(value, count);
}

/// Of the material being read, or of the object that begins.
absl::Status JdnParser::readMaterialId(std::string_view value) {
    std::int64_t id = 0;
    if (!parseNumbers(value, std::span(&id, 1)))
        return wrong(fmt::format("'{}'", shown(value)), "a whole number", "repair the line");
    if (section_ != Section::Objects) {
        materials_.setId(id);
        return absl::OkStatus();
    }
    RETURN_IF_ERROR(endObject());
    const JdnMaterial* material = materials_.find(id);
    objectMaterial_ = material == nullptr ? JdnMaterial() : *material;
    unknownMaterials_ += material == nullptr ? 1 : 0;
    unseen_ += objectMaterial_.colour.a == 0 ? 1 : 0;
    isInObject_ = true;
    ++objects_;
    vertices_ = 0;
    faces_ = 0;
    texturedVertices_ = 0;
    places_.clear();
    placesOf_.clear();
    firstPosition_ = mesh_.positions.size();
    firstTriangle_ = mesh_.triangles.size();
    return absl::OkStatus();
}

absl::Status JdnParser::readDiffuse(std::string_view value) {
    std::array<double, 3> rgb{};
    if (!parseNumbers(value, std::span<double>(rgb)))
        return wrong(fmt::format("'{}'", shown(value)), "three numbers", "repair the line");
    materials_.setColour({byteOf(rgb[0]), byteOf(rgb[1]), byteOf(rgb[2]), 255});
    return absl::OkStatus();
}

absl::Status JdnParser::readTransparency(std::string_view value) {
    double share = 0;
    if (!parseNumbers(value, std::span(&share, 1)))
        return wrong(fmt::format("'{}'", shown(value)), "a number", "repair the line");
    materials_.setOpacity(byteOf(1 - share));
    return absl::OkStatus();
}

/// v goes up.
absl::Status JdnParser::readTexturedVertex(std::string_view value) {
    std::array<float, 3> uvw{};
    if (!parseNumbers(value, std::span<float>(uvw)))
        return wrong(fmt::format("'{}'", shown(value)), "three numbers", "repair the line");
    places_.emplace_back(uvw[0], 1 - uvw[1]);
    return absl::OkStatus();
}

absl::Status JdnParser::readTexturedFace(std::string_view value) {
    return readCorners(value, texturedVertices_, "Num textured vertices", placesOf_.emplace_back());
}

absl::Status JdnParser::readVertex(std::string_view value) {
    std::array<double, 3> xyz{};
    if (!parseNumbers(value, std::span<double>(xyz)) || !std::isfinite(xyz[0]) ||
        !std::isfinite(xyz[1]) || !std::isfinite(xyz[2]))
        return wrong(fmt::format("'{}'", shown(value)), "three finite numbers",
                     "repair or remove the vertex");
    mesh_.positions.emplace_back(xyz[0], xyz[1], xyz[2]);
    return absl::OkStatus();
}

absl::Status JdnParser::readNormal(std::string_view value) {
    std::array<float, 3> xyz{};
    if (!parseNumbers(value, std::span<float>(xyz)))
        return wrong(fmt::format("'{}'", shown(value)), "three numbers", "repair the line");
    if (mesh_.normals.size() < firstPosition_)
        mesh_.normals.resize(firstPosition_, glm::vec3(0));
    mesh_.normals.emplace_back(xyz[0], xyz[1], xyz[2]);
    hasNormals_ = true;
    return absl::OkStatus();
}

/// Three numbers below `count`, which the line `counted` says.
absl::Status JdnParser::readCorners(std::string_view value, std::uint64_t count,
                                    std::string_view counted,
                                    std::array<std::uint32_t, 3>& corners) const {
    std::array<std::int64_t, 3> found{};
    if (!parseNumbers(value, std::span<std::int64_t>(found)))
        return wrong(fmt::format("'{}'", shown(value)), "three vertices", "repair the face");
    for (std::size_t i = 0; i < 3; ++i) {
        if (found[i] < 0 || static_cast<std::uint64_t>(found[i]) >= count)
            return wrong(fmt::format("{}", found[i]),
                         count == 0 ? fmt::format("no face before {}", counted)
                                    : fmt::format("a vertex from 0 to {}", count - 1),
                         "repair the face or export the scene again");
        corners[i] = static_cast<std::uint32_t>(found[i]);
    }
    return absl::OkStatus();
}

absl::Status JdnParser::readFace(std::string_view value) {
    std::array<std::uint32_t, 3> triangle{};
    RETURN_IF_ERROR(readCorners(value, vertices_, "Num Vertices", triangle));
    for (std::uint32_t& corner : triangle) corner += static_cast<std::uint32_t>(firstPosition_);
    mesh_.triangles.push_back(triangle);
    return absl::OkStatus();
}

absl::Status JdnParser::endObject() {
    if (!std::exchange(isInObject_, false))
        return absl::OkStatus();
    RETURN_IF_ERROR(checkCount("Vert", mesh_.positions.size() - firstPosition_, vertices_));
    RETURN_IF_ERROR(checkCount("Face", mesh_.triangles.size() - firstTriangle_, faces_));
    if (mesh_.normals.size() > firstPosition_)
        RETURN_IF_ERROR(
            checkCount("Vert Normal", mesh_.normals.size() - firstPosition_, vertices_));
    if (!placesOf_.empty()) {
        RETURN_IF_ERROR(checkCount("Textured Vert", places_.size(), texturedVertices_));
        RETURN_IF_ERROR(checkCount("Textured Face", placesOf_.size(), faces_));
    }
    mesh_.normals.resize(mesh_.positions.size(), glm::vec3(0));
    mesh_.colours.resize(mesh_.positions.size(), objectMaterial_.colour);
    addJdnMaterial(objectMaterial_, firstPosition_, firstTriangle_, places_, placesOf_, mesh_);
    return absl::OkStatus();
}

absl::Status JdnParser::readValue(const std::string& key, std::string_view value) {
    if (key == "Number of Materials")
        return openSection(Section::Materials, value, materialsExpected_);
    if (key == "Number of Lights")
        return openSection(Section::Lights, value, lightsExpected_);
    if (key == "Number of Objects")
        return openSection(Section::Objects, value, objectsExpected_);
    if (key == "Material ID" && section_ != Section::Lights)
        return readMaterialId(value);
    if (section_ == Section::Lights && lights_.take(key, value))
        return absl::OkStatus();
    if (section_ == Section::Materials && key == "Material Name") {
        materials_.begin();
        return absl::OkStatus();
    }
    if (section_ == Section::Materials && key == "Diffuse")
        return readDiffuse(value);
    if (section_ == Section::Materials && key == "Transparency")
        return readTransparency(value);
    if (section_ == Section::Materials && key == "Map Path") {
        materials_.setTexture(trimmed(value), mesh_);
        return absl::OkStatus();
    }
    if (isInObject_ && key == "Num textured vertices")
        return readObjectCount(value, texturedVertices_);
    if (isInObject_ && key == "Textured Vert")
        return readTexturedVertex(value);
    if (isInObject_ && key == "Textured Face")
        return readTexturedFace(value);
    if (isInObject_ && key == "Num Vertices")
        return readObjectCount(value, vertices_);
    if (isInObject_ && key == "Num Faces")
        return readObjectCount(value, faces_);
    if (isInObject_ && key == "Vert")
        return readVertex(value);
    if (isInObject_ && key == "Face")
        return readFace(value);
    if (isInObject_ && key == "Vert Normal")
        return readNormal(value);
    if (std::find(kIgnoredKeys.begin(), kIgnoredKeys.end(), key) == kIgnoredKeys.end() &&
        unknownKeys_++ == 0)
        firstUnknown_ = fmt::format("'{}' in line {}", shown(key), lineNumber_);
    return absl::OkStatus();
}

absl::Status JdnParser::readLine(std::string_view line) {
    if (trimmed(line).empty())
        return absl::OkStatus();
    const std::size_t equals = line.find('=');
    key_ = plainKey(line.substr(0, equals));
    return readValue(
        key_, equals == std::string_view::npos ? std::string_view() : line.substr(equals + 1));
}

void JdnParser::addNotes() {
    if (unknownKeys_ > 0)
        mesh_.notes.push_back(fmt::format("skipped {} lines with unknown keys, the first {}",
                                          unknownKeys_, firstUnknown_));
    if (unknownMaterials_ > 0)
        mesh_.notes.push_back(
            fmt::format("{} objects have a material that the file does not define: they are grey",
                        unknownMaterials_));
    if (unseen_ > 0)
        mesh_.notes.push_back(fmt::format(
            "{} of {} objects are not seen: their materials' Transparency is 1, which leaves them "
            "no opacity",
            unseen_, objects_));
}

absl::StatusOr<TriangleMesh> JdnParser::parse() {
    while (bytesRead_ < text_.size()) {
        if (lineNumber_++ % kPollInterval == 0) {
            control_.report("reading",
                            static_cast<double>(bytesRead_) / static_cast<double>(text_.size()));
            RETURN_IF_ERROR(control_.check());
        }
        const std::size_t end = std::min(text_.find('\n', bytesRead_), text_.size());
        const std::string_view line = text_.substr(bytesRead_, end - bytesRead_);
        bytesRead_ = std::min(end + 1, text_.size());
        RETURN_IF_ERROR(readLine(line));
    }
    RETURN_IF_ERROR(endObject());
    key_ = "end of the file";
    if (objects_ != objectsExpected_ || objects_ == 0)
        return wrong(fmt::format("{} objects", objects_),
                     fmt::format("{}", std::max<std::uint64_t>(objectsExpected_, 1)),
                     "the file is truncated, or no .jdn scene: copy or export it again");
    if (materials_.count() != materialsExpected_)
        return wrong(fmt::format("{} materials", materials_.count()),
                     fmt::format("{}", materialsExpected_), "export the scene again");
    if (mesh_.triangles.empty())
        return wrong("no face", "at least one", "export the scene again with its faces");
    if (!hasNormals_)
        mesh_.normals.clear();
    if (materials_.count() == 0)
        mesh_.colours.clear();
    addNotes();
    mesh_.lights = lights_.lights(lightsExpected_, mesh_.notes);
    control_.report("reading", 1);
    return std::move(mesh_);
}

}  // namespace

absl::StatusOr<TriangleMesh> parseJdn(std::string_view text, const std::string& name,
                                      const ImportControl& control, std::uint64_t memoryBytes) {
    RETURN_IF_ERROR(fabric::withContext(checkMemory(text, memoryBytes), name));
    absl::StatusOr<TriangleMesh> mesh = JdnParser(text, control).parse();
    return mesh.ok() ? std::move(mesh) : fabric::withContext(mesh.status(), name);
}

bool looksLikeJdn(std::string_view text) {
    const std::string_view line =
        trimmed(text.substr(0, std::min<std::size_t>(text.find('\n'), 256)));
    return plainKey(line.substr(0, line.find('='))) == "Number of Materials";
}

}  // namespace eyrie::import
