// SPDX-License-Identifier: Apache-2.0
#include "cli/exit_status.h"

namespace eyrie::cli {

ExitStatus exitStatusOf(const absl::Status& status) {
    switch (status.code()) {
        case absl::StatusCode::kOk:
            return ExitStatus::Done;
        case absl::StatusCode::kInvalidArgument:
        case absl::StatusCode::kNotFound:
        case absl::StatusCode::kDataLoss:
            return ExitStatus::WrongInput;
        default:
            return ExitStatus::Failed;
    }
}

}  // namespace eyrie::cli
