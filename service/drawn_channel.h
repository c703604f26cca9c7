// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "service/channel_drawer.h"

namespace eyrie::service {

/// What ChannelDrawer::render makes; ResourceExhausted, too, where there is no memory for it.
absl::StatusOr<fabric::ChannelResult> drawnChannel(ChannelDrawer& drawer,
                                                   const fabric::FrameData& frameData,
                                                   const fabric::ChannelTask& task,
                                                   const fabric::Delivery& delivery);

}  // namespace eyrie::service
