// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "renderer/page/remote_name.h"
#include "renderer/renderer.h"
#include "service/channel_drawer.h"
#include "service/data_places.h"

namespace eyrie::service {

/// Makes an eyrie::Renderer, on the thread that calls it. It reads scenes' data where `places`
/// says. A scene that then names a URL beyond `allowed` is refused: whoever reaches a renderer
/// could else have it read from servers that only it reaches.
DrawerFactory rendererDrawer(const RendererOptions& options, const page::AllowedUrls& allowed,
                             const DataPlaces& places = {});

}  // namespace eyrie::service
