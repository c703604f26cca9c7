// SPDX-License-Identifier: Apache-2.0
#include "cli/hardware_devices.h"

#include <cstddef>
#include <string_view>

#include <EGL/egl.h>
#include <EGL/eglext.h>

namespace eyrie::cli {

std::vector<int> hardwareDevices() {
    const auto queryDevices =
        reinterpret_cast<PFNEGLQUERYDEVICESEXTPROC>(eglGetProcAddress("eglQueryDevicesEXT"));
    const auto queryString = reinterpret_cast<PFNEGLQUERYDEVICESTRINGEXTPROC>(
        eglGetProcAddress("eglQueryDeviceStringEXT"));
    EGLint count = 0;
    if (queryDevices == nullptr || queryString == nullptr ||
        queryDevices(0, nullptr, &count) != EGL_TRUE || count <= 0)
        return {};
    std::vector<EGLDeviceEXT> devices(static_cast<std::size_t>(count));
    if (queryDevices(count, devices.data(), &count) != EGL_TRUE)
        return {};
    std::vector<int> hardware;
    for (int i = 0; i < count; ++i) {
        const char* extensions = queryString(devices[static_cast<std::size_t>(i)], EGL_EXTENSIONS);
        if (extensions != nullptr &&
            std::string_view(extensions).find("EGL_MESA_device_software") == std::string_view::npos)
            hardware.push_back(i);
    }
    return hardware;
}

}  // namespace eyrie::cli
