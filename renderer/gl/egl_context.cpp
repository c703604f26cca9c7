// SPDX-License-Identifier: Apache-2.0
#include "renderer/gl/egl_context.h"

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <GL/glew.h>
#include <fmt/format.h>

#include "renderer/gl/debug_output.h"

namespace eyrie::gl {
namespace {

struct Candidate {
    EGLDisplay display = EGL_NO_DISPLAY;
    std::string platform;
};

bool hasExtension(const char* extensions, std::string_view name) {
    return extensions != nullptr &&
           std::string_view(extensions).find(name) != std::string_view::npos;
}

std::vector<EGLDeviceEXT> queryDevices() {
    const auto query =
        reinterpret_cast<PFNEGLQUERYDEVICESEXTPROC>(eglGetProcAddress("eglQueryDevicesEXT"));
    EGLint count = 0;
    if (query == nullptr || query(0, nullptr, &count) != EGL_TRUE || count <= 0)
        return {};
    std::vector<EGLDeviceEXT> devices(static_cast<std::size_t>(count));
    if (query(count, devices.data(), &count) != EGL_TRUE)
        return {};
    devices.resize(static_cast<std::size_t>(count));
    return devices;
}

/// The displays to try, in order: EGL devices by index, then Mesa without a surface.
std::vector<Candidate> candidates(int device) {
    std::vector<Candidate> result;
    const char* extensions = eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);
    const auto getDisplay = reinterpret_cast<PFNEGLGETPLATFORMDISPLAYEXTPROC>(
        eglGetProcAddress("eglGetPlatformDisplayEXT"));
    if (getDisplay == nullptr)
        return result;
    const std::vector<EGLDeviceEXT> devices = queryDevices();
    for (std::size_t i = 0; i < devices.size(); ++i)
        if (device < 0 || i == static_cast<std::size_t>(device))
            result.push_back({getDisplay(EGL_PLATFORM_DEVICE_EXT, devices[i], nullptr),
                              fmt::format("EGL device {}", i)});
    if (device < 0 && hasExtension(extensions, "EGL_MESA_platform_surfaceless"))
        result.push_back({getDisplay(EGL_PLATFORM_SURFACELESS_MESA,
                                     reinterpret_cast<void*>(EGL_DEFAULT_DISPLAY), nullptr),
                          "EGL surfaceless Mesa"});
    return result;
}

/// EGL_NO_CONTEXT, with the reason in `why`, when `display` gives no OpenGL 4.5 core context.
EGLContext makeContext(EGLDisplay display, std::string& why) {
    if (display == EGL_NO_DISPLAY || eglInitialize(display, nullptr, nullptr) != EGL_TRUE) {
        why = fmt::format("eglInitialize failed (0x{:x})", eglGetError());
        return EGL_NO_CONTEXT;
    }
    if (eglBindAPI(EGL_OPENGL_API) != EGL_TRUE) {
        why = "no desktop OpenGL";
        return EGL_NO_CONTEXT;
    }
    constexpr std::array kConfig = {EGL_SURFACE_TYPE, EGL_PBUFFER_BIT, EGL_RENDERABLE_TYPE,
                                    EGL_OPENGL_BIT, EGL_NONE};
    EGLConfig config = nullptr;
    EGLint count = 0;
    eglChooseConfig(display, kConfig.data(), &config, 1, &count);
    const std::array kContext = {EGL_CONTEXT_MAJOR_VERSION,
                                 4,
                                 EGL_CONTEXT_MINOR_VERSION,
                                 5,
                                 EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                 EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                 EGL_CONTEXT_OPENGL_DEBUG,
                                 wantsDebugContext() ? EGL_TRUE : EGL_FALSE,
                                 EGL_NONE};
    const EGLContext context = eglCreateContext(display, count > 0 ? config : EGL_NO_CONFIG_KHR,
                                                EGL_NO_CONTEXT, kContext.data());
    if (context == EGL_NO_CONTEXT)
        why = fmt::format("no OpenGL 4.5 core context (0x{:x})", eglGetError());
    else if (eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context) != EGL_TRUE) {
        why = fmt::format("eglMakeCurrent without a surface failed (0x{:x})", eglGetError());
        eglDestroyContext(display, context);
        return EGL_NO_CONTEXT;
    }
    return context;
}

absl::Status loadFunctions() {
    glewExperimental = GL_TRUE;
    const GLenum result = glewInit();
    // A GLEW built for GLX loads the functions first and then looks for an X display, which a
    // machine without one lacks by design. Any other answer is a real failure.
    if (result == GLEW_OK || result == GLEW_ERROR_NO_GLX_DISPLAY)
        return absl::OkStatus();
    return absl::FailedPreconditionError(
        fmt::format("GLEW could not load OpenGL's functions: {}",
                    reinterpret_cast<const char*>(glewGetErrorString(result))));
}

std::string glString(GLenum name) {
    const GLubyte* text = glGetString(name);
    return text == nullptr ? std::string() : reinterpret_cast<const char*>(text);
}

bool isSoftware(std::string_view renderer) {
    for (const std::string_view name : {"llvmpipe", "softpipe", "swrast", "SWR", "Software"})
        if (renderer.find(name) != std::string_view::npos)
            return true;
    return false;
}

}  // namespace

absl::StatusOr<std::unique_ptr<EglContext>> EglContext::create(int device) {
    std::string tried;
    for (const Candidate& candidate : candidates(device)) {
        std::string why;
        const EGLContext context = makeContext(candidate.display, why);
        if (context == EGL_NO_CONTEXT) {
            tried += fmt::format("; {}: {}", candidate.platform, why);
            continue;
        }
        std::unique_ptr<EglContext> result(new EglContext(candidate.display, context));
        if (absl::Status status = loadFunctions(); !status.ok())
            return status;
        const std::string renderer = glString(GL_RENDERER);
        result->device_ = {glString(GL_VENDOR), renderer, glString(GL_VERSION), candidate.platform,
                           isSoftware(renderer)};
        installDebugOutput();
        return result;
    }
    if (device >= 0 && tried.empty())
        tried = fmt::format("; EGL lists {} devices", queryDevices().size());
    return absl::FailedPreconditionError(fmt::format(
        "no EGL device with OpenGL 4.5 was found{}{}. Install a GPU driver, or Mesa for software "
        "rendering (Debian: libegl1 libegl-mesa0 libgl1-mesa-dri)",
        device >= 0 ? fmt::format(" at index {}", device) : "", tried));
}

EglContext::EglContext(void* display, void* context) : display_(display), context_(context) {}

absl::Status EglContext::makeCurrent() const {
    if (eglGetCurrentContext() == context_ ||
        eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_) == EGL_TRUE)
        return absl::OkStatus();
    return absl::InternalError(
        fmt::format("the renderer's OpenGL context cannot be made current (0x{:x}); start the "
                    "renderer again",
                    eglGetError()));
}

EglContext::~EglContext() {
    eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    eglDestroyContext(display_, context_);
}

}  // namespace eyrie::gl
