// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace eyrie::wire {

/// Sends what gRPC would print on standard error to our log, at level debug: whatever matters of it
/// comes back as a status, and is told once, in words for people.
void adoptGrpcLog();

}  // namespace eyrie::wire
