// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include <absl/status/status.h>

namespace google::protobuf {
class Descriptor;
}

namespace eyrie::api {

/// The HTTP status of an error: 400, 404, 409, 429, 503 ….
int httpStatusOf(absl::StatusCode code);

/// An error as application/problem+json (RFC 9457):
///
///   {"type":"/api#INVALID_ARGUMENT","title":"The request is wrong","status":400,
///    "detail":"width is 0 pixels; it must be from 1 to 8192","code":"INVALID_ARGUMENT",
///    "field":"width","remedy":"it must be from 1 to 8192"}
///
/// `field` is there where the message begins with one of `request`'s fields, in JSON's names, and
/// `remedy` where it has a part after a semicolon. `request` may be null.
std::string problemJson(const absl::Status& status, int httpStatus,
                        const google::protobuf::Descriptor* request);

}  // namespace eyrie::api
