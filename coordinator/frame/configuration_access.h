// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include <absl/status/status.h>

namespace eyrie::coordinator {

class ActiveConfiguration;

/// The way to a configuration at work for those who make no frames by it.
class ConfigurationAccess {
public:
    virtual ~ConfigurationAccess() = default;

    /// Calls `use` while no frame is being planned, and tells viewers of what it changed; those
    /// under way are made as they were planned. From any thread. Errors: those of `use`;
    /// FailedPrecondition before there was a renderer to make a configuration of.
    virtual absl::Status withConfiguration(
        const std::function<absl::Status(ActiveConfiguration&)>& use) = 0;
};

}  // namespace eyrie::coordinator
