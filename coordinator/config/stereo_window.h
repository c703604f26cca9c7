// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "coordinator/config/configuration.h"

namespace eyrie::config {

/// Whether the channel's window would show each eye a picture of its own, as Equalizer decides what
/// the stereo mode AUTO is: it asks for a stereo visual (hint_stereo ON, or globally), and neither
/// the window nor the channel is drawn into framebuffer objects or a pbuffer instead.
bool isOfStereoWindow(const Configuration& configuration, const ChannelIndex& channel);

}  // namespace eyrie::config
