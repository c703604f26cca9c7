// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string_view>

#include <absl/status/statusor.h>

#include "fabric/channel_task.h"

namespace eyrie::v1 {
class ChannelHeader;
}

namespace eyrie::coordinator {

/// Puts the answer to one task together from its header and chunks. Allocates what the task allows
/// at most, however large a picture the renderer claims.
class PictureAssembly {
public:
    /// `task` outlives the assembly.
    explicit PictureAssembly(const fabric::ChannelTask& task) : task_(task) {}

    /// All errors are Internal: the renderer broke the protocol.
    absl::Status takeHeader(const v1::ChannelHeader& header);
    absl::Status takeChunk(std::string_view bytes);

    /// After the last chunk.
    absl::StatusOr<fabric::ChannelResult> finish();

private:
    absl::Status checkSizes(const v1::ChannelHeader& header) const;

    const fabric::ChannelTask& task_;
    fabric::ChannelResult result_;
    bool hasHeader_ = false;
    std::size_t received_ = 0;
};

}  // namespace eyrie::coordinator
