// SPDX-License-Identifier: Apache-2.0
#include "wire/picture_memory.h"

#include <algorithm>
#include <cassert>
#include <cerrno>
#include <cstring>
#include <string_view>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/random.h>
#include <sys/stat.h>
#include <unistd.h>

#include "fabric/status.h"

namespace eyrie::wire {
namespace {

constexpr std::size_t kKeyBytes = 32;
constexpr std::uint64_t kPixelsBegin = 4096;
constexpr int kSeals = F_SEAL_SHRINK | F_SEAL_GROW;

class Descriptor {
public:
    explicit Descriptor(int number) : number_(number) {}
    ~Descriptor() {
        if (number_ >= 0)
            close(number_);
    }
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;

    bool isOpen() const { return number_ >= 0; }
    int number() const { return number_; }
    int release() { return std::exchange(number_, -1); }

private:
    int number_;
};

std::uint64_t fileBytes(std::uint64_t bytes) { return kPixelsBegin + bytes; }

std::byte* mapped(int descriptor, std::uint64_t bytes) {
    void* const memory =
        mmap(nullptr, fileBytes(bytes), PROT_READ | PROT_WRITE, MAP_SHARED, descriptor, 0);
    return memory == MAP_FAILED ? nullptr : static_cast<std::byte*>(memory);
}

absl::Status lacking(std::string_view what) {
    return absl::ResourceExhaustedError(
        fmt::format("no memory for pictures: {}: {}", what, std::strerror(errno)));
}

template <typename... Values>
absl::Status notShared(fmt::format_string<Values...> what, Values&&... values) {
    return absl::FailedPreconditionError(
        fmt::format("the memory offered cannot be shared: {}",
                    fmt::format(what, std::forward<Values>(values)...)));
}

absl::StatusOr<std::string> randomKey() {
    std::string key(kKeyBytes, '\0');
    if (getrandom(key.data(), key.size(), 0) != static_cast<ssize_t>(key.size()))
        return lacking("getrandom");
    return key;
}

/// Looked at before it is opened: opening what is no file may wait, or have effects.
absl::Status checkIsFile(int path, std::uint64_t bytes) {
    struct stat there {};
    if (fstat(path, &there) != 0 || !S_ISREG(there.st_mode))
        return notShared("it is no file");
    if (there.st_uid != geteuid())
        return notShared("it is another user's");
    if (std::cmp_not_equal(there.st_size, fileBytes(bytes)))
        return notShared("it has {} bytes, where {} pixel bytes were offered", there.st_size,
                         bytes);
    return absl::OkStatus();
}

absl::Status checkOffer(const MemoryOffer& offer) {
    if (offer.process <= 0 || offer.descriptor < 0)
        return notShared("descriptor {} of process {}", offer.descriptor, offer.process);
    if (offer.bytes < 1 || offer.bytes > PictureMemory::kMaxBytes)
        return notShared("{} bytes", offer.bytes);
    if (offer.key.size() != kKeyBytes)
        return notShared("a key of {} bytes", offer.key.size());
    return absl::OkStatus();
}

std::size_t pixelsOf(const fabric::PixelViewport& area) {
    return static_cast<std::size_t>(area.area());
}

}  // namespace

PictureMemory::PictureMemory(MemoryOffer offer, int descriptor, std::byte* begin)
    : offer_(std::move(offer)), descriptor_(descriptor), begin_(begin) {}

PictureMemory::~PictureMemory() {
    munmap(begin_, fileBytes(offer_.bytes));
    if (descriptor_ >= 0)
        close(descriptor_);
}

absl::StatusOr<std::unique_ptr<PictureMemory>> PictureMemory::create(std::uint64_t bytes) {
    assert(bytes >= 1 && bytes <= kMaxBytes);
    Descriptor file(memfd_create("eyrie picture", MFD_CLOEXEC | MFD_ALLOW_SEALING));
    if (!file.isOpen())
        return lacking("memfd_create");
    // All of it now: a page that cannot be had later is a signal instead of an error.
    if (const int error = posix_fallocate(file.number(), 0, static_cast<off_t>(fileBytes(bytes)));
        error != 0) {
        errno = error;
        return lacking("posix_fallocate");
    }
    if (fcntl(file.number(), F_ADD_SEALS, kSeals | F_SEAL_SEAL) != 0)
        return lacking("sealing");
    ASSIGN_OR_RETURN(std::string key, randomKey());
    std::byte* const begin = mapped(file.number(), bytes);
    if (begin == nullptr)
        return lacking("mmap");
    std::memcpy(begin, key.data(), key.size());
    mprotect(begin, fileBytes(bytes), PROT_READ);  // from here on it is the other's to write
    const int descriptor = file.release();
    return std::unique_ptr<PictureMemory>(
        new PictureMemory({getpid(), descriptor, bytes, std::move(key)}, descriptor, begin));
}

absl::StatusOr<std::unique_ptr<PictureMemory>> PictureMemory::open(const MemoryOffer& offer) {
    RETURN_IF_ERROR(checkOffer(offer));
    const Descriptor path(
        ::open(fmt::format("/proc/{}/fd/{}", offer.process, offer.descriptor).c_str(),
               O_PATH | O_CLOEXEC));
    if (!path.isOpen())
        return notShared("descriptor {} of process {}: {}", offer.descriptor, offer.process,
                         std::strerror(errno));
    RETURN_IF_ERROR(checkIsFile(path.number(), offer.bytes));
    const Descriptor file(::open(fmt::format("/proc/self/fd/{}", path.number()).c_str(),
                                 O_RDWR | O_CLOEXEC | O_NONBLOCK));
    if (!file.isOpen())
        return notShared("it cannot be opened: {}", std::strerror(errno));
    const int seals = fcntl(file.number(), F_GET_SEALS);
    if (seals < 0 || (seals & kSeals) != kSeals)
        return notShared("its size may change");
    // Again, now that it cannot.
    RETURN_IF_ERROR(checkIsFile(file.number(), offer.bytes));
    std::byte* const begin = mapped(file.number(), offer.bytes);
    if (begin == nullptr)
        return notShared("mmap: {}", std::strerror(errno));
    std::unique_ptr<PictureMemory> memory(new PictureMemory(offer, -1, begin));
    if (std::memcmp(begin, offer.key.data(), offer.key.size()) != 0)
        return notShared("it has another key");
    return memory;
}

std::byte* PictureMemory::pixels() const { return begin_ + kPixelsBegin; }

std::optional<fabric::PixelRoom> PictureMemory::room(const fabric::PixelViewport& area,
                                                     bool withDepth) const {
    const std::size_t colour = pixelsOf(area) * sizeof(fabric::Rgba);
    const std::size_t depth = withDepth ? pixelsOf(area) * sizeof(float) : 0;
    if (colour + depth > offer_.bytes)
        return std::nullopt;
    return fabric::PixelRoom{reinterpret_cast<fabric::Rgba*>(pixels()),
                             withDepth ? reinterpret_cast<float*>(pixels() + colour) : nullptr};
}

bool PictureMemory::put(const fabric::Image& picture) {
    const auto to = room(picture.area, picture.hasDepth());
    if (!to)
        return false;
    std::ranges::copy(picture.colour, to->colour);
    std::ranges::copy(picture.depth, to->depth);
    return true;
}

absl::StatusOr<fabric::ImageView> PictureMemory::picture(const fabric::PixelViewport& area,
                                                         bool hasDepth) const {
    const auto at = room(area, hasDepth);
    if (!at)
        return absl::InvalidArgumentError(
            fmt::format("{}x{} pixels{}, which are more than the {} bytes that the memory has",
                        area.width, area.height, hasDepth ? " with depth" : "", offer_.bytes));
    const std::size_t count = pixelsOf(area);
    return fabric::ImageView(area, {at->colour, count}, {at->depth, hasDepth ? count : 0});
}

}  // namespace eyrie::wire
