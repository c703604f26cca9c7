// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace eyrie::api {

/// CoordinatorService over HTTP as an OpenAPI 3.1 document, made of the schema: its calls and
/// messages, with their comments and examples.
const std::string& openApiJson();

/// Calls, fields and values that the document has without a word about them.
const std::vector<std::string>& undocumented();

}  // namespace eyrie::api
