// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string_view>

#include <absl/status/statusor.h>

#include "fabric/channel_task.h"
#include "wire/picture_bytes.h"

namespace eyrie::v1 {
class ChannelHeader;
}

namespace eyrie::coordinator {

/// Puts the answer to one task together from its header and chunks. Allocates what the task allows
/// at most, however large a picture the renderer claims.
class PictureAssembly {
public:
    /// `task` outlives the assembly, which stays where it is.
    explicit PictureAssembly(const fabric::ChannelTask& task) : task_(task) {}
    PictureAssembly(const PictureAssembly&) = delete;
    PictureAssembly& operator=(const PictureAssembly&) = delete;

    /// All errors are Internal: the renderer broke the protocol.
    absl::Status takeHeader(const v1::ChannelHeader& header);
    absl::Status takeChunk(std::string_view bytes);

    /// After the last chunk.
    absl::StatusOr<fabric::ChannelResult> finish();

private:
    const fabric::ChannelTask& task_;
    fabric::ChannelResult result_;
    std::optional<wire::PictureReader> pixels_;  ///< once there is a header
};

}  // namespace eyrie::coordinator
