// SPDX-License-Identifier: Apache-2.0
#include "renderer/occlusion/payoff.h"

namespace eyrie::occlusion {

bool Payoff::isDue() {
    if (pays_ || pause_ == 0)
        return true;
    --pause_;
    return false;
}

void Payoff::add(const Look& look) {
    const double perTriangle =
        look.drawn == 0 ? 0 : look.drawMilliseconds / static_cast<double>(look.drawn);
    const double gain = kHiddenShare * perTriangle * static_cast<double>(look.hidden);
    // One frame's times are noisy; but what lies before a pause says nothing.
    const double weight = pays_ ? 0.2 : 1;
    gain_ += weight * (gain - gain_);
    milliseconds_ += weight * (look.milliseconds - milliseconds_);
    pays_ = gain_ > (pays_ ? 1 : kToStart) * milliseconds_;
    pause_ = pays_ ? 0 : kPause - 1;
}

}  // namespace eyrie::occlusion
