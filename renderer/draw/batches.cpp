// SPDX-License-Identifier: Apache-2.0
#include "renderer/draw/batches.h"

namespace eyrie::draw {

void Batches::begin(bool isWatched) {
    isWatched_ = isWatched;
    triangles_ = handedOver_ = 0;
    batches_.clear();
}

void Batches::add(std::uint64_t triangles) {
    triangles_ += triangles;
    if (triangles_ - handedOver_ < kTriangles)
        return;
    handedOver_ = triangles_;
    if (isWatched_)
        batches_.push_back({triangles_, gl::Fence()});
    glFlush();
}

void Batches::awaitMost() {
    glFlush();
    for (auto batch = batches_.rbegin(); batch != batches_.rend(); ++batch)
        if (triangles_ - batch->end >= triangles_ / kLeftOf) {
            batch->fence.await();
            break;
        }
    batches_.clear();
}

}  // namespace eyrie::draw
