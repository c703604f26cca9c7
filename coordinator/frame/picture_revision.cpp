// SPDX-License-Identifier: Apache-2.0
#include "coordinator/frame/picture_revision.h"

#include <random>

namespace eyrie::coordinator {

PictureRevision::PictureRevision() : revision_(std::uint64_t{std::random_device()()} << 32) {}

std::uint64_t PictureRevision::of(std::uint64_t sceneRevision, const config::OnDisplay& display) {
    if (sceneRevision == sceneRevision_ && display == display_)
        return revision_;
    sceneRevision_ = sceneRevision;
    display_ = display;
    return ++revision_;
}

}  // namespace eyrie::coordinator
