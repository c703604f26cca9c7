// SPDX-License-Identifier: Apache-2.0
#include "coordinator/frame/frame_kinds.h"

#include <algorithm>

namespace eyrie::coordinator {

std::uint64_t FrameKinds::of(const FrameRequest& request, std::uint64_t revision) {
    FrameRequest alike = request;
    alike.camera = {};
    alike.session = 0;
    alike.jpegQuality = 0;
    alike.stop = {};
    const auto known = std::find_if(kinds_.begin(), kinds_.end(), [&](const Kind& kind) {
        return kind.revision == revision && kind.request == alike;
    });
    if (known != kinds_.end())
        kinds_.splice(kinds_.begin(), kinds_, known);
    else
        kinds_.push_front({alike, revision, ++last_});
    if (kinds_.size() > kRemembered)
        kinds_.pop_back();
    return kinds_.front().number;
}

}  // namespace eyrie::coordinator
