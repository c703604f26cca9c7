// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include "access/tokens.h"

namespace eyrie::api {

/// What the caller of one of CoordinatorService has to be: looking is for `view`, changing what
/// everybody sees for `control`, and all else for `admin`.
access::Role roleFor(std::string_view call);

/// The same of a way to make one over HTTP, `path` below /api/v1. Of one that there is not, reading
/// is for `view`.
access::Role roleForRest(std::string_view method, std::string_view path);

}  // namespace eyrie::api
