// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "cli/check/started.h"
#include "coordinator/config/findings.h"
#include "coordinator/config/resolved.h"

/// What `eyrie check` says of a configuration.
namespace eyrie::cli::check {

struct Checked {
    std::string file;
    config::Configuration configuration;
    config::ResolvedConfiguration resolved;  ///< refers to `configuration`
    config::Findings findings;
    std::optional<Started> started;  ///< where it was asked for
};

/// The tree as one object. Rectangles are [x, y, width, height], from the lower left corner.
std::string json(const Checked& checked);

/// The tree for people.
std::string text(const Checked& checked);

}  // namespace eyrie::cli::check
