// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <absl/status/status.h>

namespace eyrie::cli {

/// What the shell sees.
enum class ExitStatus {
    Done = 0,
    Failed = 1,      ///< the work failed, or was called off
    WrongInput = 2,  ///< the command line or a file is wrong
};

/// WrongInput for InvalidArgument, NotFound and a damaged file (DataLoss): the caller can put those
/// right. Failed for the rest.
ExitStatus exitStatusOf(const absl::Status& status);

}  // namespace eyrie::cli
