// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

#include <absl/status/statusor.h>

#include "fabric/channel_program.h"
#include "wire/picture_bytes.h"

namespace eyrie::v1 {
class ProgramPictureHeader;
class ProgramStatistics;
}  // namespace eyrie::v1

namespace eyrie::coordinator {

/// Puts the answer to a channel program together: the pictures of its outputs without an address,
/// in their order, then the statistics. Allocates what those outputs allow at most.
class ProgramAssembly {
public:
    explicit ProgramAssembly(const fabric::ChannelProgram& program);
    ProgramAssembly(const ProgramAssembly&) = delete;
    ProgramAssembly& operator=(const ProgramAssembly&) = delete;

    /// All errors are Internal: the renderer broke the protocol.
    absl::Status takeHeader(const v1::ProgramPictureHeader& header);
    absl::Status takeChunk(std::string_view bytes);
    absl::Status takeStatistics(const v1::ProgramStatistics& statistics);

    /// After the last message.
    absl::StatusOr<fabric::ProgramResult> finish();

private:
    absl::Status endPicture();

    std::vector<fabric::ProgramOutput> expected_;
    std::size_t draws_ = 0;  ///< of the program
    fabric::ProgramResult result_;
    std::optional<wire::PictureReader> pixels_;  ///< of the last of the pictures
    bool hasStatistics_ = false;
};

}  // namespace eyrie::coordinator
