// SPDX-License-Identifier: Apache-2.0
#include "wire/object_look.h"

#include <algorithm>
#include <string>

#include <fmt/format.h>

#include "eyrie/v1/look.pb.h"
#include "fabric/status.h"
#include "wire/numbers.h"
#include "wire/shading.h"

namespace eyrie::wire {
namespace {

absl::StatusOr<fabric::ObjectLook> fromMessage(const v1::ObjectLook& message,
                                               const std::string& field) {
    fabric::ObjectLook look{message.object()};
    if (look.object < 0)
        return absl::InvalidArgumentError(
            fmt::format("{}.object is {}; positions count from 0", field, look.object));
    if (message.colour_size() != 0) {
        ASSIGN_OR_RETURN(look.colour, colourFrom(message.colour(), field + ".colour"));
    }
    if (message.has_shading()) {
        ASSIGN_OR_RETURN(look.shading, shadingFrom(message.shading(), field + ".shading"));
    }
    return look;
}

}  // namespace

void setObjectLooks(const fabric::ObjectLooks& looks,
                    google::protobuf::RepeatedPtrField<v1::ObjectLook>& messages) {
    for (const fabric::ObjectLook& look : looks.looks) {
        v1::ObjectLook& message = *messages.Add();
        message.set_object(look.object);
        if (look.colour)
            setNumbers(*look.colour, *message.mutable_colour());
        if (look.shading)
            message.set_shading(toMessage(*look.shading));
    }
}

absl::StatusOr<fabric::ObjectLooks> objectLooks(
    const google::protobuf::RepeatedPtrField<v1::ObjectLook>& messages) {
    if (messages.size() > fabric::kMaxObjectLooks)
        return absl::InvalidArgumentError(fmt::format("look.objects has {}; at most {} are allowed",
                                                      messages.size(), fabric::kMaxObjectLooks));
    fabric::ObjectLooks looks;
    for (int i = 0; i < messages.size(); ++i) {
        ASSIGN_OR_RETURN(fabric::ObjectLook look,
                         fromMessage(messages[i], fmt::format("look.objects[{}]", i)));
        looks.looks.push_back(std::move(look));
    }
    std::ranges::sort(looks.looks, {}, &fabric::ObjectLook::object);
    const auto twice = std::ranges::adjacent_find(looks.looks, {}, &fabric::ObjectLook::object);
    if (twice != looks.looks.end())
        return absl::InvalidArgumentError(
            fmt::format("look.objects has object {} twice", twice->object));
    return looks;
}

}  // namespace eyrie::wire
