// SPDX-License-Identifier: Apache-2.0
#include "wire/look.h"

#include <fmt/format.h>

#include "eyrie/v1/look.pb.h"
#include "fabric/status.h"
#include "wire/camera.h"
#include "wire/hidden_objects.h"
#include "wire/numbers.h"
#include "wire/object_look.h"

namespace eyrie::wire {
namespace {

v1::PrimitiveShape toMessage(fabric::PrimitiveShape shape) {
    switch (shape) {
        case fabric::PrimitiveShape::Blend:
            return v1::PRIMITIVE_SHAPE_BLEND;
        case fabric::PrimitiveShape::Box:
            return v1::PRIMITIVE_SHAPE_BOX;
        case fabric::PrimitiveShape::Tent:
            return v1::PRIMITIVE_SHAPE_TENT;
        case fabric::PrimitiveShape::Smooth:
            return v1::PRIMITIVE_SHAPE_SMOOTH;
    }
    return v1::PRIMITIVE_SHAPE_UNSPECIFIED;
}

absl::StatusOr<fabric::PrimitiveShape> fromMessage(v1::PrimitiveShape shape,
                                                   const std::string& field) {
    switch (shape) {
        case v1::PRIMITIVE_SHAPE_UNSPECIFIED:
        case v1::PRIMITIVE_SHAPE_BLEND:
            return fabric::PrimitiveShape::Blend;
        case v1::PRIMITIVE_SHAPE_BOX:
            return fabric::PrimitiveShape::Box;
        case v1::PRIMITIVE_SHAPE_TENT:
            return fabric::PrimitiveShape::Tent;
        case v1::PRIMITIVE_SHAPE_SMOOTH:
            return fabric::PrimitiveShape::Smooth;
        default:
            return absl::InvalidArgumentError(
                fmt::format("{}.shape is {}, which this version does not know", field,
                            static_cast<int>(shape)));
    }
}

v1::TransferFunction toMessage(const fabric::TransferFunction& function) {
    v1::TransferFunction message;
    message.set_unit(function.unit == fabric::HeightUnit::Metres ? v1::HEIGHT_UNIT_METRES
                                                                 : v1::HEIGHT_UNIT_RELATIVE);
    for (const fabric::TransferPrimitive& primitive : function.primitives) {
        v1::TransferPrimitive& added = *message.add_primitives();
        added.set_shape(toMessage(primitive.shape));
        added.set_centre(primitive.centre);
        added.set_width(primitive.width);
        setNumbers(primitive.colour, *added.mutable_colour());
        added.set_opacity(primitive.opacity);
    }
    return message;
}

absl::StatusOr<fabric::TransferFunction> fromMessage(const v1::TransferFunction& message) {
    fabric::TransferFunction function;
    switch (message.unit()) {
        case v1::HEIGHT_UNIT_UNSPECIFIED:
        case v1::HEIGHT_UNIT_RELATIVE:
            break;
        case v1::HEIGHT_UNIT_METRES:
            function.unit = fabric::HeightUnit::Metres;
            break;
        default:
            return absl::InvalidArgumentError(
                fmt::format("look.transfer.unit is {}, which this version does not know",
                            static_cast<int>(message.unit())));
    }
    for (int i = 0; i < message.primitives_size(); ++i) {
        const v1::TransferPrimitive& found = message.primitives(i);
        const std::string field = fmt::format("look.transfer.primitives[{}]", i);
        fabric::TransferPrimitive primitive;
        ASSIGN_OR_RETURN(primitive.shape, fromMessage(found.shape(), field));
        primitive.centre = found.centre();
        primitive.width = found.width();
        ASSIGN_OR_RETURN(primitive.colour, threeNumbers(found.colour(), field + ".colour"));
        primitive.opacity = found.has_opacity() ? found.opacity() : 1;
        function.primitives.push_back(primitive);
    }
    return function;
}

}  // namespace

v1::Look toMessage(const fabric::Look& look) {
    v1::Look message;
    message.set_exaggeration(look.exaggeration);
    if (look.transfer)
        *message.mutable_transfer() = toMessage(*look.transfer);
    message.set_slope_shading(look.slopeShading);
    if (look.contours) {
        message.mutable_contours()->set_interval_metres(look.contours->intervalMetres);
        message.mutable_contours()->set_width_pixels(look.contours->widthPixels);
    }
    message.set_saturation(look.saturation);
    message.set_tile_bounds(look.tileBounds);
    message.set_page_bounds(look.pageBounds);
    message.set_level_tint(look.levelTint);
    message.set_range_tint(look.rangeTint);
    if (look.cutCamera)
        *message.mutable_cut_camera() = toMessage(*look.cutCamera);
    if (look.sun) {
        message.mutable_sun()->set_azimuth_degrees(look.sun->azimuthDegrees);
        message.mutable_sun()->set_elevation_degrees(look.sun->elevationDegrees);
    }
    setHidden(look.hidden, *message.mutable_hidden_objects());
    setObjectLooks(look.objects, *message.mutable_objects());
    return message;
}

absl::StatusOr<fabric::Look> fromMessage(const v1::Look& message) {
    fabric::Look look;
    if (message.has_exaggeration())
        look.exaggeration = message.exaggeration();
    if (message.has_transfer()) {
        ASSIGN_OR_RETURN(look.transfer, fromMessage(message.transfer()));
    }
    if (message.has_slope_shading())
        look.slopeShading = message.slope_shading();
    if (message.has_contours()) {
        look.contours.emplace();
        look.contours->intervalMetres = message.contours().interval_metres();
        if (message.contours().has_width_pixels())
            look.contours->widthPixels = message.contours().width_pixels();
    }
    if (message.has_saturation())
        look.saturation = message.saturation();
    look.tileBounds = message.tile_bounds();
    look.pageBounds = message.page_bounds();
    look.levelTint = message.level_tint();
    look.rangeTint = message.range_tint();
    if (message.has_cut_camera()) {
        absl::StatusOr<fabric::Camera> camera = fromMessage(message.cut_camera());
        if (!camera.ok())
            return fabric::withContext(camera.status(), "look.cutCamera");
        look.cutCamera = *camera;
    }
    if (message.has_sun())
        look.sun = fabric::Sun{message.sun().azimuth_degrees(), message.sun().elevation_degrees()};
    ASSIGN_OR_RETURN(look.hidden, hiddenObjects(message.hidden_objects(), "look.hiddenObjects"));
    ASSIGN_OR_RETURN(look.objects, objectLooks(message.objects()));
    RETURN_IF_ERROR(fabric::validate(look));
    return look;
}

}  // namespace eyrie::wire
