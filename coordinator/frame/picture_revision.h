// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "coordinator/config/on_display.h"

namespace eyrie::coordinator {

/// A number for what pictures show beside what is asked for: it counts up when the scene, its data
/// or what is on display are others than they were for the picture before. Where it begins is
/// another in each coordinator: who asks may not notice that there is a new one. Callers take
/// turns.
class PictureRevision {
public:
    PictureRevision();

    std::uint64_t of(std::uint64_t sceneRevision, const config::OnDisplay& display);

private:
    std::uint64_t revision_;
    std::uint64_t sceneRevision_ = 0;
    config::OnDisplay display_;
};

}  // namespace eyrie::coordinator
