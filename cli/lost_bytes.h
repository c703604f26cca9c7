// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace eyrie::cli {

/// From now on a mapped file whose bytes are gone, as it was cut short or its disk fails, ends this
/// process with ExitStatus::Failed and a line that says so, and not by SIGBUS.
void sayWhereBytesAreLost();

}  // namespace eyrie::cli
