// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "eyrie/v1/session.pb.h"

namespace eyrie::stream {
class Session;
}

namespace eyrie::api {

/// What is known of it now.
v1::Session sessionMessage(const stream::Session& session);

}  // namespace eyrie::api
