// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <absl/status/status.h>

namespace eyrie::gl {

/// What to do when GL reports an error of ours.
enum class OnGlError {
    Log,    ///< the default
    Abort,  ///< in tests: stops with a stack at the call that caused it
};

/// Process-wide; set before contexts are created.
void setOnGlError(OnGlError action);

/// Whether contexts are to report all that they can, which costs a GPU's driver a tenth of a frame
/// and more: in tests. Others report what they do by themselves.
bool wantsDebugContext();

/// What went wrong on the current context since it was last asked: ResourceExhausted where its
/// memory was too little, Internal for an error of ours. Nothing then says what of it was drawn.
/// Best called when the device has finished: the driver may wait for itself.
absl::Status takeGlError();

/// Routes the current context's debug messages to the log. EglContext calls it.
void installDebugOutput();

}  // namespace eyrie::gl
