// SPDX-License-Identifier: Apache-2.0
#include "renderer/import/reading_process.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <new>
#include <span>
#include <stdexcept>
#include <utility>
#include <vector>

#include <absl/status/status.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <malloc.h>
#include <poll.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include "fabric/status.h"

namespace eyrie::import {
namespace {

constexpr std::chrono::milliseconds kPause{32};  // between looks at the stop token
constexpr int kLongestWait = 20;  // in times the processor time: others may want the processor too

/// A file descriptor that closes itself.
class Descriptor {
public:
    explicit Descriptor(int fd) : fd_(fd) {}
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;
    ~Descriptor() {
        if (fd_ >= 0)
            close(fd_);
    }
    int get() const { return fd_; }

private:
    int fd_;
};

// --- What goes from one process to the other: this, then the arrays in the order of the counts.
// ---

struct ResultHeader {
    std::int64_t code = 0;  ///< of the status
    std::uint64_t messageBytes = 0;
    std::uint64_t noteBytes = 0;  ///< lines
    std::uint64_t positions = 0;
    std::uint64_t triangles = 0;
    std::uint64_t normals = 0;
    std::uint64_t colours = 0;
    std::uint64_t textureCoordinates = 0;
    std::uint64_t materialOf = 0;
    std::uint64_t materials = 0;
    std::uint64_t distantLights = 0;
    std::uint64_t pointLights = 0;
    std::uint64_t pictureBytes = 0;  ///< textures and images, one after the other
    std::uint64_t textures = 0;
    std::uint64_t images = 0;
    std::uint64_t droppedFaces = 0;
    double roundingMetres = 0;
};

/// Before the name and the bytes of a texture, or the blocks of an image.
struct PictureHeader {
    std::uint64_t nameBytes = 0;
    std::uint64_t bytes = 0;
    std::uint32_t flags = 0;  ///< of a texture
    mesh::ImageShape shape;   ///< of an image
};

bool writeAll(int fd, const void* data, std::size_t bytes) {
    const auto* at = static_cast<const char*>(data);
    while (bytes > 0) {
        const ssize_t done = write(fd, at, bytes);
        if (done < 0 && errno != EINTR)
            return false;
        at += done > 0 ? done : 0;
        bytes -= done > 0 ? static_cast<std::size_t>(done) : 0;
    }
    return true;
}

bool readAll(int fd, void* data, std::size_t bytes) {
    auto* at = static_cast<char*>(data);
    while (bytes > 0) {
        const ssize_t done = read(fd, at, bytes);
        if (done == 0 || (done < 0 && errno != EINTR))
            return false;
        at += done > 0 ? done : 0;
        bytes -= done > 0 ? static_cast<std::size_t>(done) : 0;
    }
    return true;
}

template <typename Array>
bool writeArray(int fd, const Array& array) {
    return writeAll(fd, array.data(), array.size() * sizeof(array[0]));
}

template <typename Array>
bool readArray(int fd, Array& array, std::uint64_t count) {
    array.resize(count);
    return readAll(fd, array.data(), count * sizeof(array[0]));
}

PictureHeader headerOf(const TextureSource& texture) {
    return {texture.name.size(), texture.bytes.size(), texture.flags, {}};
}

PictureHeader headerOf(const mesh::Image& image) {
    return {0, image.blocks.size(), 0, image.shape};
}

/// What writePictures() writes.
std::uint64_t pictureBytesOf(const TriangleMesh& mesh) {
    std::uint64_t bytes = 0;
    const auto add = [&bytes](const PictureHeader& header) {
        bytes += sizeof header + header.nameBytes + header.bytes;
    };
    for (const TextureSource& texture : mesh.textures) add(headerOf(texture));
    for (const mesh::Image& image : mesh.images) add(headerOf(image));
    return bytes;
}

/// One by one: all of them at once, beside those of the mesh, may be too much.
bool writePictures(int fd, const TriangleMesh& mesh) {
    const auto writeHeader = [fd](const PictureHeader& header) {
        return writeAll(fd, &header, sizeof header);
    };
    return std::ranges::all_of(mesh.textures,
                               [&](const TextureSource& texture) {
                                   return writeHeader(headerOf(texture)) &&
                                          writeArray(fd, texture.name) &&
                                          writeArray(fd, texture.bytes);
                               }) &&
           std::ranges::all_of(mesh.images, [&](const mesh::Image& image) {
               return writeHeader(headerOf(image)) && writeArray(fd, image.blocks);
           });
}

/// False where they are not whole.
bool readPictures(int fd, const ResultHeader& header, TriangleMesh& mesh) {
    std::uint64_t left = header.pictureBytes;
    for (std::uint64_t i = 0; i < header.textures + header.images; ++i) {
        PictureHeader picture;
        if (left < sizeof picture || !readAll(fd, &picture, sizeof picture))
            return false;
        left -= sizeof picture;
        if (picture.nameBytes > left || picture.bytes > left - picture.nameBytes)
            return false;
        left -= picture.nameBytes + picture.bytes;
        TextureSource read{{}, {}, picture.flags};
        if (!readArray(fd, read.name, picture.nameBytes) ||
            !readArray(fd, read.bytes, picture.bytes))
            return false;
        if (i < header.textures)
            mesh.textures.push_back(std::move(read));
        else if (picture.bytes == picture.shape.bytesFrom(0))
            mesh.images.push_back({picture.shape, std::move(read.bytes)});
        else
            return false;
    }
    return left == 0;
}

bool writeResult(int fd, const absl::StatusOr<TriangleMesh>& result) {
    ResultHeader header;
    if (!result.ok()) {
        const absl::string_view message = result.status().message();
        header.code = static_cast<int>(result.status().code());
        header.messageBytes = message.size();
        return writeAll(fd, &header, sizeof(header)) && writeArray(fd, message);
    }
    std::string notes;
    for (const std::string& note : result->notes) notes += note + '\n';
    header.noteBytes = notes.size();
    header.positions = result->positions.size();
    header.triangles = result->triangles.size();
    header.normals = result->normals.size();
    header.colours = result->colours.size();
    header.textureCoordinates = result->textureCoordinates.size();
    header.materialOf = result->materialOf.size();
    header.materials = result->materials.size();
    header.distantLights = result->lights.distant.size();
    header.pointLights = result->lights.points.size();
    header.pictureBytes = pictureBytesOf(*result);
    header.textures = result->textures.size();
    header.images = result->images.size();
    header.droppedFaces = result->droppedFaces;
    header.roundingMetres = result->roundingMetres;
    return writeAll(fd, &header, sizeof(header)) && writeArray(fd, notes) &&
           writeArray(fd, result->positions) && writeArray(fd, result->triangles) &&
           writeArray(fd, result->normals) && writeArray(fd, result->colours) &&
           writeArray(fd, result->textureCoordinates) && writeArray(fd, result->materialOf) &&
           writeArray(fd, result->materials) && writeArray(fd, result->lights.distant) &&
           writeArray(fd, result->lights.points) && writePictures(fd, *result);
}

/// False when the file is not as long as its header says.
bool hasItsLength(int fd, const ResultHeader& header) {
    struct stat status {};
    __extension__ using Wide = unsigned __int128;
    const Wide bytes = Wide{sizeof(header)} + header.messageBytes + header.noteBytes +
                       Wide{header.positions} * sizeof(fabric::Vec3) +
                       Wide{header.triangles} * sizeof(std::array<std::uint32_t, 3>) +
                       Wide{header.normals} * sizeof(glm::vec3) +
                       Wide{header.colours} * sizeof(fabric::Rgba) +
                       Wide{header.textureCoordinates} * sizeof(glm::vec2) +
                       Wide{header.materialOf} * sizeof(std::uint16_t) +
                       Wide{header.materials} * sizeof(mesh::Material) +
                       Wide{header.distantLights} * sizeof(fabric::DirectionalLight) +
                       Wide{header.pointLights} * sizeof(fabric::PointLight) + header.pictureBytes;
    return fstat(fd, &status) == 0 && bytes == static_cast<Wide>(status.st_size);
}

/// Nothing where the copy ended without a whole result.
absl::StatusOr<TriangleMesh> readResult(int fd, bool& isWhole) {
    ResultHeader header;
    TriangleMesh mesh;
    std::string message, notes;
    isWhole =
        lseek(fd, 0, SEEK_SET) == 0 && readAll(fd, &header, sizeof(header)) &&
        hasItsLength(fd, header) && readArray(fd, message, header.messageBytes) &&
        readArray(fd, notes, header.noteBytes) && readArray(fd, mesh.positions, header.positions) &&
        readArray(fd, mesh.triangles, header.triangles) &&
        readArray(fd, mesh.normals, header.normals) &&
        readArray(fd, mesh.colours, header.colours) &&
        readArray(fd, mesh.textureCoordinates, header.textureCoordinates) &&
        readArray(fd, mesh.materialOf, header.materialOf) &&
        readArray(fd, mesh.materials, header.materials) &&
        readArray(fd, mesh.lights.distant, header.distantLights) &&
        readArray(fd, mesh.lights.points, header.pointLights) && readPictures(fd, header, mesh);
    if (header.code != 0)
        return absl::Status(static_cast<absl::StatusCode>(header.code), message);
    mesh.droppedFaces = header.droppedFaces;
    mesh.roundingMetres = header.roundingMetres;
    for (std::size_t begin = 0; begin < notes.size();) {
        const std::size_t end = notes.find('\n', begin);
        mesh.notes.push_back(notes.substr(begin, end - begin));
        begin = end + 1;
    }
    return mesh;
}

// --- The copy ------------------------------------------------------------------------------------

/// Bytes of address space that this process has.
std::uint64_t addressSpaceBytes() {
    std::uint64_t pages = 0;
    std::ifstream("/proc/self/statm") >> pages;
    return pages * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
}

void limit(__rlimit_resource resource, std::uint64_t most) {
    const rlimit both{most, most};
    setrlimit(resource, &both);
}

/// Gives this thread's heap room at once, by large pages where the kernel has them: libraries
/// allocate by the million, and a thread's heap grows by a page at a time, each with two calls of
/// the kernel.
void makeHeap() {
    constexpr std::size_t kBytes = 48 << 20;  // a heap of glibc's threads has at most 64 MiB
    constexpr std::uintptr_t kLargePage = 2 << 20;
    mallopt(M_MMAP_THRESHOLD, 2 * kBytes);
    mallopt(M_TRIM_THRESHOLD, 2 * kBytes);  // or it is given back with this room
    void* const room = std::malloc(kBytes);
    if (room == nullptr)
        return;
    const auto behind = reinterpret_cast<std::uintptr_t>(room) % kLargePage;
    std::byte* const first = static_cast<std::byte*>(room) + (kLargePage - behind);
    madvise(first, kBytes - kLargePage, MADV_HUGEPAGE);
    std::free(room);
}

/// Takes on the limits, and lets go of what is this process's.
void becomeReader(const ReadingLimits& limits) {
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    for (const int signal : {SIGINT, SIGTERM, SIGSEGV, SIGABRT, SIGBUS, SIGFPE, SIGXCPU, SIGPIPE})
        std::signal(signal, SIG_DFL);
    sigset_t none;
    sigemptyset(&none);
    sigprocmask(SIG_SETMASK, &none, nullptr);
    const Descriptor nowhere(open("/dev/null", O_RDWR | O_CLOEXEC));
    for (const int fd : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) dup2(nowhere.get(), fd);
    limit(RLIMIT_CORE, 0);
    limit(RLIMIT_CPU, static_cast<std::uint64_t>(limits.processorTime.count()));
    limit(RLIMIT_AS, addressSpaceBytes() + limits.memoryBytes);
    makeHeap();
}

absl::Status memoryRanOut(const ReadingLimits& limits) {
    if (limits.isMemoryGiven)
        return absl::ResourceExhaustedError(
            fmt::format("reading takes more than the {} MB of memory that it may use; convert it "
                        "to PLY, which is imported part by part, or allow more memory",
                        limits.memoryBytes >> 20));
    return absl::ResourceExhaustedError(
        fmt::format("reading takes more than {} MB of memory, far more than a sound file of its "
                    "size; export it again, or in parts",
                    limits.memoryBytes >> 20));
}

[[noreturn]] void runReader(const std::function<absl::StatusOr<TriangleMesh>()>& read,
                            const ReadingLimits& limits, int result) {
    becomeReader(limits);
    bool isWritten = false;
    try {
        isWritten = writeResult(result, read());
    } catch (const std::bad_alloc&) {
        isWritten = writeResult(result, memoryRanOut(limits));
    } catch (const std::length_error&) {
        isWritten = writeResult(result, memoryRanOut(limits));
    } catch (...) {
    }
    _exit(isWritten ? 0 : 1);
}

// --- The process that waits ----------------------------------------------------------------------

/// Waits for the end of the copy; ends it when a stop is requested, or when it seems to wait for
/// something that never comes, which takes no processor time. Its wait status.
int await(pid_t pid, const ReadingLimits& limits, const ImportControl& control) {
    const auto deadline = std::chrono::steady_clock::now() + kLongestWait * limits.processorTime;
    // By its number: glibc 2.36 declares the call for C alone. Without a descriptor poll() is a
    // pause.
    const Descriptor process(static_cast<int>(syscall(SYS_pidfd_open, pid, 0)));
    int status = 0;
    while (waitpid(pid, &status, WNOHANG) != pid) {
        if (!control.check().ok() || std::chrono::steady_clock::now() > deadline)
            kill(pid, SIGKILL);
        pollfd end{process.get(), POLLIN, 0};
        poll(&end, 1, static_cast<int>(kPause.count()));
    }
    return status;
}

absl::Status whyItEnded(int status, const ReadingLimits& limits) {
    if (WIFSIGNALED(status) && (WTERMSIG(status) == SIGXCPU || WTERMSIG(status) == SIGKILL))
        return absl::ResourceExhaustedError(
            fmt::format("reading takes more than {} s, far more than a sound file of its size; "
                        "export it again, or in parts",
                        limits.processorTime.count()));
    return absl::InvalidArgumentError(
        fmt::format("the library that reads this format failed on it ({}): it is damaged, or has "
                    "something in it that is not known; export it again, or in another format",
                    WIFSIGNALED(status) ? fmt::format("signal {}", WTERMSIG(status))
                                        : fmt::format("exit {}", WEXITSTATUS(status))));
}

}  // namespace

ReadingLimits ReadingLimits::forFile(std::uint64_t bytes, std::uint64_t mostMemory) {
    constexpr std::uint64_t kMostBytes = 1ULL << 40;
    ReadingLimits limits;
    limits.memoryBytes += 64 * std::min(bytes, kMostBytes);
    limits.processorTime += std::chrono::seconds(std::min(bytes, kMostBytes) / 100'000);
    limits.isMemoryGiven = mostMemory != 0 && mostMemory < limits.memoryBytes;
    if (limits.isMemoryGiven)
        limits.memoryBytes = mostMemory;
    return limits;
}

ReadingLimits ReadingLimits::forTextures(std::size_t count) {
    constexpr std::uint64_t kDecoding = 2ULL << 30;
    constexpr std::chrono::seconds kTimeEach{20};
    constexpr mesh::ImageShape kLargest{mesh::kMaxImageSide, mesh::kMaxImageSide, mesh::kHasAlpha};
    ReadingLimits limits;
    limits.memoryBytes = kDecoding + count * kLargest.bytesFrom(0);
    limits.processorTime += count * kTimeEach;
    return limits;
}

absl::StatusOr<TriangleMesh> readInOwnProcess(
    const std::function<absl::StatusOr<TriangleMesh>()>& read, const ReadingLimits& limits,
    const ImportControl& control) {
    RETURN_IF_ERROR(control.check());
    const Descriptor result(memfd_create("eyrie-mesh", MFD_CLOEXEC));
    if (result.get() < 0)
        return absl::ResourceExhaustedError("no file in memory can be made; close some files");
    const pid_t pid = fork();
    if (pid == 0)
        runReader(read, limits, result.get());
    if (pid < 0)
        return absl::ResourceExhaustedError("no process can be started; end some others");
    const int status = await(pid, limits, control);
    RETURN_IF_ERROR(control.check());
    bool isWhole = false;
    absl::StatusOr<TriangleMesh> mesh = readResult(result.get(), isWhole);
    if (!isWhole || !WIFEXITED(status) || WEXITSTATUS(status) != 0)
        return whyItEnded(status, limits);
    return mesh;
}

}  // namespace eyrie::import
