// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string_view>

#include <absl/status/statusor.h>

#include "fabric/channel_task.h"
#include "wire/picture_bytes.h"
#include "wire/picture_memory.h"

namespace eyrie::v1 {
class ChannelHeader;
}

namespace eyrie::coordinator {

/// Puts the answer to one task together from its header and chunks. Allocates what the task allows
/// at most, however large a picture the renderer claims.
class PictureAssembly {
public:
    /// `task` and `memory`, which was offered with it, outlive the assembly, which stays where it
    /// is. Null: none was offered.
    explicit PictureAssembly(const fabric::ChannelTask& task,
                             const wire::PictureMemory* memory = nullptr)
        : task_(task), memory_(memory) {}
    PictureAssembly(const PictureAssembly&) = delete;
    PictureAssembly& operator=(const PictureAssembly&) = delete;

    /// All errors are Internal: the renderer broke the protocol.
    absl::Status takeHeader(const v1::ChannelHeader& header);
    absl::Status takeChunk(std::string_view bytes);

    /// After the last chunk.
    absl::StatusOr<fabric::ChannelResult> finish();

    /// The picture in the memory, if the header says that it is there: the result's image then has
    /// an area and no pixels.
    const std::optional<fabric::ImageView>& inMemory() const { return inMemory_; }

private:
    absl::Status takeFromMemory(const fabric::PixelViewport& area, bool hasDepth);
    absl::Status takeJpeg(const fabric::PixelViewport& area);
    absl::Status takeJpegBytes(std::string_view bytes);
    absl::Status checkJpeg() const;

    const fabric::ChannelTask& task_;
    const wire::PictureMemory* const memory_;
    fabric::ChannelResult result_;
    std::optional<fabric::ImageView> inMemory_;
    bool isJpeg_ = false;
    std::optional<wire::PictureReader> pixels_;  ///< once there is a header, of one in chunks
};

}  // namespace eyrie::coordinator
