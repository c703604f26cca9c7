// SPDX-License-Identifier: Apache-2.0
// Tiles drawn from a vertex buffer and 16-bit indices, beside the same tiles drawn without any
// vertex buffer: the index is the packed vertex, which the shader finds in gl_VertexID (Dick,
// Schneider and Westermann, "Efficient geometry compression for GPU-based decoding in realtime
// terrain rendering", 2009, carry vertices so).
//
//   build/release/bench/packed_index FILE.eyt [TILES=48] [FRAMES=40]
//
// Prints for each form the median frame time, the processor time, triangles a second and the bytes
// on the device. Fails when the two pictures differ.
#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <ctime>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "fabric/status.h"
#include "renderer/gl/egl_context.h"
#include "renderer/gl/framebuffer.h"
#include "renderer/gl/object.h"
#include "renderer/gl/program.h"
#include "renderer/terrain/eyt_format.h"

namespace {

using namespace eyrie;

constexpr int kWidth = 1280;
constexpr int kHeight = 720;
constexpr int kColumns = 8;                      ///< of tiles in the picture
constexpr std::uint32_t kLeastTriangles = 1024;  ///< of a tile: plains tell nothing

constexpr const char* kUnpack = R"(
invariant gl_Position;
uniform vec4 place;       // of the tile in clip space: x, y, scale of both
uniform float halfSteps;  // of the tile's side
out float height;
void put(uint word) {
    vec2 at = vec2(word & 1023u, (word >> 10) & 1023u) / halfSteps;
    height = float(word >> 20) / 4095.0;
    gl_Position = vec4(place.xy + place.zw * at, 0.25 + 0.5 * height, 1.0);
}
)";
constexpr const char* kBuffered = R"(
layout(location = 0) in uint packedVertex;
void main() { put(packedVertex); }
)";
constexpr const char* kIndexed = R"(
void main() { put(uint(gl_VertexID)); }
)";
constexpr const char* kFragment = R"(#version 450 core
in float height;
out vec4 colour;
void main() { colour = vec4(height, 1.0 - height, 0.5, 1.0); }
)";

/// One tile on the device in both forms.
struct Tile {
    gl::VertexArray bufferedArray;
    gl::VertexArray indexedArray;
    gl::Buffer vertices;
    gl::Buffer indices;        ///< 16 bits
    gl::Buffer packedIndices;  ///< 32 bits
    GLsizei count = 0;
    float halfSteps = 1;
    std::uint64_t bufferedBytes = 0;
    std::uint64_t indexedBytes = 0;
};

template <typename T>
std::uint64_t fill(const gl::Buffer& buffer, const std::vector<T>& values) {
    const std::size_t bytes = values.size() * sizeof(T);
    glNamedBufferStorage(buffer.id(), static_cast<GLsizeiptr>(bytes), values.data(), 0);
    return bytes;
}

Tile makeTile(const terrain::TileGeometry& geometry) {
    const terrain::IndexRange& finer = geometry.parts[terrain::kFinerPart];
    const std::vector<std::uint16_t> indices(geometry.indices.begin(),
                                             geometry.indices.begin() + finer.first);
    std::vector<std::uint32_t> packed;
    for (const std::uint16_t index : indices) packed.push_back(geometry.words[index]);
    Tile tile;
    tile.count = static_cast<GLsizei>(indices.size());
    tile.halfSteps = 2.0F * static_cast<float>(geometry.cells);
    tile.bufferedBytes = fill(tile.vertices, std::vector<std::uint32_t>(geometry.words.begin(),
                                                                        geometry.words.end())) +
                         fill(tile.indices, indices);
    tile.indexedBytes = fill(tile.packedIndices, packed);
    const GLuint array = tile.bufferedArray.id();
    glVertexArrayVertexBuffer(array, 0, tile.vertices.id(), 0, 4);
    glVertexArrayAttribIFormat(array, 0, 1, GL_UNSIGNED_INT, 0);
    glVertexArrayAttribBinding(array, 0, 0);
    glEnableVertexArrayAttrib(array, 0);
    glVertexArrayElementBuffer(array, tile.indices.id());
    glVertexArrayElementBuffer(tile.indexedArray.id(), tile.packedIndices.id());
    return tile;
}

/// The first `count` tiles of kLeastTriangles whose vertices take one word.
absl::StatusOr<std::vector<Tile>> loadTiles(const terrain::EytFile& file, std::size_t count) {
    std::vector<Tile> tiles;
    for (std::uint32_t page = 0; page < file.index().pages.size(); ++page) {
        if (file.index().pages[page].bytes == 0)
            continue;
        ASSIGN_OR_RETURN(const auto read, file.readPage(page));
        for (int place = 0; place < terrain::kPageTiles * terrain::kPageTiles; ++place) {
            const terrain::TileGeometry& geometry = read->tile(place);
            if (geometry.parts[terrain::kFinerPart].first >= 3 * kLeastTriangles &&
                geometry.wordsPerVertex == 1)
                tiles.push_back(makeTile(geometry));
            if (tiles.size() == count)
                return tiles;
        }
    }
    return absl::FailedPreconditionError(
        fmt::format("the file has {} tiles of {} triangles or more with packed vertices of one "
                    "word; take a larger one or ask for fewer",
                    tiles.size(), kLeastTriangles));
}

double processorMilliseconds() {
    return 1000.0 * static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

/// One way of drawing all tiles, and what it took.
struct Form {
    const char* name;
    gl::Program program;
    bool isIndexed;
    std::vector<double> milliseconds;
    double processor = 0;
    fabric::Image picture;
};

void drawTiles(const Form& form, const std::vector<Tile>& tiles) {
    form.program.use();
    const GLint place = form.program.uniform("place");
    const GLint halfSteps = form.program.uniform("halfSteps");
    const int rows = static_cast<int>(tiles.size() + kColumns - 1) / kColumns;
    for (std::size_t k = 0; k < tiles.size(); ++k) {
        const Tile& tile = tiles[k];
        const float width = 2.0F / kColumns;
        const float height = 2.0F / static_cast<float>(rows);
        glUniform4f(place, -1 + width * static_cast<float>(k % kColumns),
                    -1 + height * static_cast<float>(k / kColumns), width, height);
        glUniform1f(halfSteps, tile.halfSteps);
        glBindVertexArray(form.isIndexed ? tile.indexedArray.id() : tile.bufferedArray.id());
        glDrawElements(GL_TRIANGLES, tile.count,
                       form.isIndexed ? GL_UNSIGNED_INT : GL_UNSIGNED_SHORT, nullptr);
    }
}

void drawFrame(Form& form, const std::vector<Tile>& tiles, gl::Framebuffer& framebuffer) {
    const fabric::PixelViewport all{0, 0, kWidth, kHeight};
    const auto start = std::chrono::steady_clock::now();
    const double before = processorMilliseconds();
    framebuffer.begin(kWidth, kHeight, all, {});
    drawTiles(form, tiles);
    form.picture = framebuffer.read(all, true);
    const std::chrono::duration<double, std::milli> taken =
        std::chrono::steady_clock::now() - start;
    form.milliseconds.push_back(taken.count());
    form.processor += processorMilliseconds() - before;
}

absl::StatusOr<Form> makeForm(const char* name, const char* main, bool isIndexed) {
    const std::string vertex = std::string("#version 450 core\n") + kUnpack + main;
    ASSIGN_OR_RETURN(gl::Program program,
                     gl::Program::create({name, vertex}, {"fragment", kFragment}));
    return Form{name, std::move(program), isIndexed, {}, 0, {}};
}

void print(Form& form, const std::vector<Tile>& tiles, std::uint64_t bytes) {
    std::sort(form.milliseconds.begin(), form.milliseconds.end());
    const auto frames = static_cast<double>(form.milliseconds.size());
    double triangles = 0;
    for (const Tile& tile : tiles) triangles += tile.count / 3.0;
    const double median = form.milliseconds[form.milliseconds.size() / 2];
    fmt::print(
        "{:<36} {:>7.2f} ms  processor {:>7.2f} ms  {:>6.1f} M triangles/s  {:>6.1f} KiB a "
        "tile\n",
        form.name, median, form.processor / frames, triangles / median / 1000,
        static_cast<double>(bytes) / 1024 / static_cast<double>(tiles.size()));
}

absl::Status run(const std::string& path, std::size_t count, int frames) {
    ASSIGN_OR_RETURN(const auto context, gl::EglContext::create(-1));
    ASSIGN_OR_RETURN(const auto file, terrain::EytFile::open(path));
    ASSIGN_OR_RETURN(const std::vector<Tile> tiles, loadTiles(*file, count));
    gl::Framebuffer framebuffer;
    RETURN_IF_ERROR(framebuffer.resize(kWidth, kHeight));
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_GREATER);
    ASSIGN_OR_RETURN(Form buffered, makeForm("vertex buffer, 16-bit indices", kBuffered, false));
    ASSIGN_OR_RETURN(Form indexed, makeForm("vertices in 32-bit indices", kIndexed, true));
    for (int i = -3; i < frames; ++i) {
        drawFrame(buffered, tiles, framebuffer);
        drawFrame(indexed, tiles, framebuffer);
        if (i < 0)  // shaders are still being compiled
            for (Form* form : {&buffered, &indexed}) {
                form->milliseconds.clear();
                form->processor = 0;
            }
    }
    std::uint64_t bufferedBytes = 0;
    std::uint64_t indexedBytes = 0;
    for (const Tile& tile : tiles) {
        bufferedBytes += tile.bufferedBytes;
        indexedBytes += tile.indexedBytes;
    }
    fmt::print("{} tiles on {}, {} x {}\n", tiles.size(), context->device().renderer, kWidth,
               kHeight);
    print(buffered, tiles, bufferedBytes);
    print(indexed, tiles, indexedBytes);
    if (buffered.picture.colour != indexed.picture.colour ||
        buffered.picture.depth != indexed.picture.depth)
        return absl::InternalError("the two pictures differ");
    return absl::OkStatus();
}

}  // namespace

int main(int argc, char** argv) {
    if (argc < 2 || std::string(argv[1]) == "--help") {
        fmt::print(stderr, "usage: packed_index FILE.eyt [TILES=48] [FRAMES=40]\n");
        return 2;
    }
    const auto tiles = static_cast<std::size_t>(argc > 2 ? std::max(1, std::atoi(argv[2])) : 48);
    const int frames = argc > 3 ? std::max(1, std::atoi(argv[3])) : 40;
    if (const absl::Status status = run(argv[1], tiles, frames); !status.ok()) {
        fmt::print(stderr, "{}\n", status.ToString());
        return 1;
    }
    return 0;
}
