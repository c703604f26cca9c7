// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "coordinator/config/configuration.h"
#include "coordinator/config/findings.h"

namespace eyrie::v1 {
class Configuration;
}

/// A configuration as a message and as its JSON. Both ways go by the statements of .eqc files, so
/// that there is one place where limits are checked and references followed.
namespace eyrie::config {

/// Precondition: `configuration` was read, or is such as could be.
v1::Configuration toMessage(const Configuration& configuration);

/// What is wrong is put into `findings`, with its field; what is returned is to be used only where
/// these have no errors. What toMessage() made becomes an equal configuration.
Configuration fromMessage(const v1::Configuration& message, Findings& findings);

/// Protobuf JSON, indented, a list of numbers on one line.
std::string writeJson(const Configuration& configuration);

/// As fromMessage(), brought to what the newest version has: canvases where there are none, and an
/// observer. What is no JSON of a configuration, misspelt fields included, is one error.
Configuration readJson(std::string_view text, Findings& findings);

}  // namespace eyrie::config
