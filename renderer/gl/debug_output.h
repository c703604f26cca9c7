// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace eyrie::gl {

/// What to do when GL reports an error of ours.
enum class OnGlError {
    Log,    ///< the default
    Abort,  ///< in tests: stops with a stack at the call that caused it
};

/// Process-wide; set before contexts are created.
void setOnGlError(OnGlError action);

/// Routes the current context's debug messages to the log. EglContext calls it.
void installDebugOutput();

}  // namespace eyrie::gl
