// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace eyrie::wire {

/// Has this process keep what is freed of large blocks, up to 64 MiB a heap, for the next of them,
/// instead of giving it back to the system: pictures come and go with every frame, and their pages
/// would be made, cleared and mapped anew each time. Measured: docs/benchmarks.md.
void keepPictureHeap();

}  // namespace eyrie::wire
