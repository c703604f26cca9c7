// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include <absl/status/statusor.h>

#include "fabric/pick.h"
#include "fabric/sight.h"
#include "fabric/vec.h"

namespace eyrie::fabric {

/// A rectangle of a picture that is seen by one sight, whose frustum ends at the rectangle's sides.
/// Corner and size are shares of the picture, from its lower left corner, so they hold at whatever
/// size it is shown.
struct SeenArea {
    Vec2 corner{0, 0};
    Vec2 size{1, 1};
    Sight sight;

    bool contains(const Vec2& share) const {
        return share.x >= corner.x && share.y >= corner.y && share.x <= corner.x + size.x &&
               share.y <= corner.y + size.y;
    }
    bool operator==(const SeenArea&) const = default;
};

/// Of a whole picture, later ones above earlier; what is in none of them shows nothing. Nothing at
/// all: the picture is the camera's own, as large as its view.
using SeenAreas = std::optional<std::vector<SeenArea>>;

/// InvalidArgument, naming the field, unless the rectangle lies in the picture, is not empty, and
/// has a valid sight.
absl::Status validate(const SeenArea& area);

/// The part of a frustum that a rectangle of the view spans; corner and size are shares of it.
Frustum part(const Frustum& whole, const Vec2& corner, const Vec2& size);

/// `inPicture`, whose place is one of a picture made of `areas`, as a place of the area that it
/// falls in; as it is where the picture is the camera's own. Nothing where nothing is shown there.
/// Errors: InvalidArgument, as of validate(inPicture).
absl::StatusOr<std::optional<PickRequest>> pickIn(const SeenAreas& areas,
                                                  const PickRequest& inPicture);

}  // namespace eyrie::fabric
