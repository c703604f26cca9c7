// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include <absl/status/statusor.h>

#include "fabric/statistics.h"

namespace eyrie::gl {

/// An OpenGL 4.5 core context without window or display server, current on the thread that made it
/// until another is made current there. Belongs to that thread.
class EglContext {
public:
    /// `device` is an index into EGL's device list; -1 tries each in turn, then surfaceless Mesa.
    /// FailedPrecondition, listing what was tried, when none gives OpenGL 4.5.
    static absl::StatusOr<std::unique_ptr<EglContext>> create(int device);

    /// No context is current then.
    ~EglContext();
    EglContext(const EglContext&) = delete;
    EglContext& operator=(const EglContext&) = delete;

    const fabric::DeviceInfo& device() const { return device_; }

    /// Does nothing where it is. Errors: Internal, what EGL says.
    absl::Status makeCurrent() const;

private:
    EglContext(void* display, void* context);

    void* display_;
    void* context_;
    fabric::DeviceInfo device_;
};

}  // namespace eyrie::gl
