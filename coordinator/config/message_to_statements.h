// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "coordinator/config/eqc_grammar.h"
#include "coordinator/config/findings.h"

namespace google::protobuf {
class Message;
}
namespace eyrie::v1 {
class Configuration;
}

namespace eyrie::config {

/// Each with its field as its place. What is too deep or too much is left out, and an error.
EqcText toStatements(const v1::Configuration& message, Findings& findings);

/// Of one of its parts, such as a wall, what stands in its block.
std::vector<Statement> toStatements(const google::protobuf::Message& part, Findings& findings);

/// Sets the fields of a part that has all these.
void fill(const std::vector<Statement>& statements, google::protobuf::Message& part);

/// Precondition: the statements of a configuration (statementsOf).
v1::Configuration toMessage(const EqcText& statements);

}  // namespace eyrie::config
