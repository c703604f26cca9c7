// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <memory>
#include <vector>

#include <absl/status/statusor.h>

#include "fabric/pick.h"
#include "fabric/scene.h"
#include "renderer/page/page_source.h"
#include "renderer/pick/surface.h"

namespace eyrie::pick {

inline constexpr std::uint64_t kRecentBytes = std::uint64_t{16} << 20;

/// Finds what a place of a picture shows, in double precision and in the finest data, whatever is
/// drawn or on the device. Needs no GL and not the renderer's thread: any thread may ask, several
/// at a time. Memory: kRecentBytes of pages, and the one being looked at.
class Picker {
public:
    using Clock = std::chrono::steady_clock;

    /// Of a scene's objects, in their order.
    explicit Picker(std::vector<std::unique_ptr<const Surface>> surfaces);

    /// Opens the scene's files. Errors: those of Renderer::openScene.
    static absl::StatusOr<std::shared_ptr<const Picker>> open(const fabric::Scene& scene,
                                                              const page::SourceOptions& sources);

    /// Errors: InvalidArgument (the request); DataLoss, Unavailable and others of reading a page
    /// that the line of sight passes, naming it: coarser data do not stand in for it, since no
    /// error could then be told that is worth having; DeadlineExceeded.
    absl::StatusOr<fabric::Picked> pick(
        const fabric::PickRequest& request,
        Clock::time_point deadline = Clock::time_point::max()) const;

private:
    std::vector<std::unique_ptr<const Surface>> surfaces_;
    mutable RecentPages pages_;
};

}  // namespace eyrie::pick
