// SPDX-License-Identifier: Apache-2.0
#include "coordinator/farm/program_assembly.h"

#include <utility>

#include "coordinator/farm/broken_protocol.h"
#include "eyrie/v1/render_service.pb.h"
#include "wire/picture_header.h"
#include "wire/statistics.h"

namespace eyrie::coordinator {

ProgramAssembly::ProgramAssembly(const fabric::ChannelProgram& program) {
    for (const fabric::ProgramStage& stage : program.stages) {
        draws_ += stage.draw ? 1 : 0;
        for (const fabric::ProgramOutput& output : stage.outputs)
            if (output.to.empty())
                expected_.push_back(output);
    }
    // Readers point at the pictures.
    result_.pictures.reserve(expected_.size());
}

absl::Status ProgramAssembly::takeHeader(const v1::ProgramPictureHeader& header) {
    RETURN_IF_ERROR(endPicture());
    const std::size_t next = result_.pictures.size();
    if (next == expected_.size() || hasStatistics_)
        return brokenProtocol("more than the {} pictures asked for", expected_.size());
    const fabric::ProgramOutput& output = expected_[next];
    if (header.frame() != output.frame)
        return brokenProtocol("frame {}, where {} is next", header.frame(), output.frame);
    const auto picture = wire::announcedPicture(header, output.area, output.withDepth);
    RETURN_IF_ERROR(brokenProtocol(picture.status()));
    result_.pictures.push_back({output.frame, picture->blank()});
    pixels_.emplace(result_.pictures.back().image, picture->encoding);
    return absl::OkStatus();
}

absl::Status ProgramAssembly::takeChunk(std::string_view bytes) {
    if (!pixels_)
        return brokenProtocol("pixels without a header");
    return brokenProtocol(pixels_->take(bytes));
}

absl::Status ProgramAssembly::takeStatistics(const v1::ProgramStatistics& statistics) {
    RETURN_IF_ERROR(endPicture());
    if (std::exchange(hasStatistics_, true))
        return brokenProtocol("statistics came twice");
    if (std::cmp_not_equal(statistics.draws_size(), draws_))
        return brokenProtocol("statistics of {} draws, where the program has {}",
                              statistics.draws_size(), draws_);
    for (const v1::FrameStatistics& draw : statistics.draws()) {
        auto read = wire::fromMessage(draw);
        RETURN_IF_ERROR(brokenProtocol(read.status()));
        result_.draws.push_back(*std::move(read));
    }
    return absl::OkStatus();
}

absl::StatusOr<fabric::ProgramResult> ProgramAssembly::finish() {
    if (!hasStatistics_ || result_.pictures.size() != expected_.size())
        return brokenProtocol("{} pictures, where {} were asked for, {} statistics",
                              result_.pictures.size(), expected_.size(),
                              hasStatistics_ ? "and" : "no");
    return std::move(result_);
}

absl::Status ProgramAssembly::endPicture() {
    if (!pixels_)
        return absl::OkStatus();
    const absl::Status status = pixels_->finish();
    pixels_.reset();
    return brokenProtocol(status);
}

}  // namespace eyrie::coordinator
