// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "coordinator/frame/kept_configuration.h"

namespace eyrie::v1 {
class KeptConfiguration;
}

namespace eyrie::api {

/// Without what is as configured.
v1::KeptConfiguration toMessage(const coordinator::KeptConfiguration& kept,
                                const std::string& file);

/// What cannot be read of it is left out; the log says so.
coordinator::KeptConfiguration fromMessage(const v1::KeptConfiguration& message);

}  // namespace eyrie::api
