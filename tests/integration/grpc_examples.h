// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>

#include <absl/status/status.h>

namespace eyrie::test {

/// Makes every call that CoordinatorService has over gRPC at `address`, by the example that the
/// API's document has for it; of the call for which that has none, by what is there. What came of
/// each, by its name; of one that goes on, whether its first message came. There is to be a viewer
/// in the session "example" and a raster example.tif in the data folder; operations are waited for.
std::map<std::string, absl::Status> makeExamples(const std::string& address);

}  // namespace eyrie::test
