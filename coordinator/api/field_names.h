// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include <absl/status/status.h>

namespace google::protobuf {
class Descriptor;
}

namespace eyrie::api {

/// Whether `path`, such as "camera.eye[0]" or "tauPixels", begins with one of the message's fields.
bool beginsWithField(std::string_view path, const google::protobuf::Descriptor& message);

/// `status` in the terms of a request that has `message` at `below` ("change.", or nothing): where
/// it begins with one of the message's fields, or with one of frame data that stands for it
/// ("frame_data.tau_pixels"), it names the request's. Others, and OK, stay as they are.
absl::Status inRequest(const absl::Status& status, std::string_view below,
                       const google::protobuf::Descriptor& message);

}  // namespace eyrie::api
