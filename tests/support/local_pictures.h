// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include <absl/status/statusor.h>

#include "coordinator/compound/plan.h"
#include "coordinator/frame/frame_source.h"
#include "renderer/renderer.h"

namespace eyrie::test {

/// Pictures by one renderer in this process, for those of many to be held against. Belongs to the
/// thread that opened it.
class LocalPictures {
public:
    static absl::StatusOr<std::unique_ptr<LocalPictures>> open(const fabric::Scene& scene);

    const fabric::Box& bounds() const { return bounds_; }

    /// What `task` shows, background included, of `view`'s camera; its view is of `view`'s size
    /// where the task has none.
    absl::StatusOr<fabric::Image> draw(const coordinator::FrameRequest& view,
                                       fabric::ChannelTask task);

    /// The same without depth, sampled at the points of `raster`.
    absl::StatusOr<fabric::Image> draw(const coordinator::FrameRequest& view,
                                       const fabric::Raster& raster);

    /// The pictures of a plan, each task drawn here.
    absl::StatusOr<std::vector<fabric::Image>> pictures(const coordinator::FrameRequest& view,
                                                        const compound::Plan& plan);

private:
    LocalPictures(std::unique_ptr<Renderer> renderer, fabric::Box bounds, fabric::Rgba background)
        : renderer_(std::move(renderer)), bounds_(bounds), background_(background) {}

    const std::unique_ptr<Renderer> renderer_;
    const fabric::Box bounds_;
    const fabric::Rgba background_;
    std::uint64_t frames_ = 0;
};

}  // namespace eyrie::test
