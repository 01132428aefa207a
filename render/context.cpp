#include "render/context.h"

#include <epoxy/egl.h>
#include <epoxy/gl.h>

#include <algorithm>
#include <array>
#include <string_view>
#include <vector>

namespace belvedere {
namespace {

class EglContext final : public Context {
 public:
  EglContext(EGLDisplay display, EGLContext context) : display_(display), context_(context) {}
  ~EglContext() override {
    // The display is shared by everybody in the process who asked for it; it is not terminated.
    eglDestroyContext(display_, context_);
  }
  EglContext(const EglContext&) = delete;
  EglContext& operator=(const EglContext&) = delete;

  Status MakeCurrent() override {
    eglBindAPI(EGL_OPENGL_API);
    if (eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_) != EGL_TRUE) {
      return Status::Error("off-screen EGL: cannot make the context current (error 0x{:x}); update the graphics driver",
                           eglGetError());
    }
    return {};
  }
  void Release() override { eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT); }

 private:
  const EGLDisplay display_;
  const EGLContext context_;
};

bool Has(const char* extensions, std::string_view name) {
  if (extensions == nullptr) return false;
  std::string_view rest(extensions);
  while (!rest.empty()) {
    const size_t end = std::min(rest.find(' '), rest.size());
    if (rest.substr(0, end) == name) return true;
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  return false;
}

// Displays to try, best first: hardware devices, then the software renderer without a surface, then the default one.
std::vector<EGLDisplay> CandidateDisplays() {
  std::vector<EGLDisplay> displays;
  const char* client = eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);
  if (Has(client, "EGL_EXT_platform_device") && Has(client, "EGL_EXT_device_enumeration")) {
    std::array<EGLDeviceEXT, 16> devices{};
    EGLint count = 0;
    if (eglQueryDevicesEXT(static_cast<EGLint>(devices.size()), devices.data(), &count) != EGL_TRUE) count = 0;
    for (EGLint i = 0; i < count; ++i) {
      EGLDeviceEXT device = devices[static_cast<size_t>(i)];
      if (Has(eglQueryDeviceStringEXT(device, EGL_EXTENSIONS), "EGL_MESA_device_software")) continue;
      displays.push_back(eglGetPlatformDisplayEXT(EGL_PLATFORM_DEVICE_EXT, device, nullptr));
    }
  }
  if (Has(client, "EGL_MESA_platform_surfaceless")) {
    displays.push_back(eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr));
  }
  displays.push_back(eglGetDisplay(EGL_DEFAULT_DISPLAY));
  std::erase(displays, EGL_NO_DISPLAY);
  return displays;
}

EGLContext CreateContext(EGLDisplay display, bool any_version) {
  const std::array<EGLint, 7> core45 = {
      EGL_CONTEXT_MAJOR_VERSION,           4,       EGL_CONTEXT_MINOR_VERSION, 5, EGL_CONTEXT_OPENGL_PROFILE_MASK,
      EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT, EGL_NONE};
  const std::array<EGLint, 1> any = {EGL_NONE};
  const std::array<EGLint, 3> wanted = {EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_NONE};
  EGLConfig config = EGL_NO_CONFIG_KHR;
  EGLint count = 0;
  if (!Has(eglQueryString(display, EGL_EXTENSIONS), "EGL_KHR_no_config_context")) {
    if (eglChooseConfig(display, wanted.data(), &config, 1, &count) != EGL_TRUE || count == 0) return EGL_NO_CONTEXT;
  }
  return eglCreateContext(display, config, EGL_NO_CONTEXT, any_version ? any.data() : core45.data());
}

// Which version there is instead of 4.5; empty when not even that can be asked.
std::string VersionOf(EGLDisplay display) {
  EGLContext context = CreateContext(display, true);
  if (context == EGL_NO_CONTEXT) return {};
  std::string found;
  if (eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context) == EGL_TRUE) {
    const auto* version = glGetString(GL_VERSION);
    if (version != nullptr) found = reinterpret_cast<const char*>(version);
    eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
  }
  eglDestroyContext(display, context);
  return found;
}

}  // namespace

Status TooOldForUs(const std::string& where, const std::string& found) {
  return Status::Error(
      "{}: OpenGL 4.5 core is needed, found {}; update the graphics driver or set LIBGL_ALWAYS_SOFTWARE=1", where,
      found.empty() ? "none" : found);
}

Result<std::unique_ptr<Context>> MakeOffscreenContext() {
  std::string older;
  bool any_display = false;
  for (EGLDisplay display : CandidateDisplays()) {
    EGLint major = 0;
    EGLint minor = 0;
    if (eglInitialize(display, &major, &minor) != EGL_TRUE) continue;
    any_display = true;
    if (eglBindAPI(EGL_OPENGL_API) != EGL_TRUE) continue;
    if (!Has(eglQueryString(display, EGL_EXTENSIONS), "EGL_KHR_surfaceless_context")) continue;
    EGLContext context = CreateContext(display, false);
    if (context != EGL_NO_CONTEXT) return std::unique_ptr<Context>(std::make_unique<EglContext>(display, context));
    if (older.empty()) older = VersionOf(display);
  }
  if (any_display) return TooOldForUs("off-screen EGL", older);
  return Status::Error(
      "off-screen EGL: no EGL display can be opened; install a graphics driver (Debian: libegl-mesa0 and "
      "libgl1-mesa-dri)");
}

Result<ContextFacts> InspectContext() {
  ContextFacts facts;
  const auto text = [](GLenum name) {
    const auto* value = glGetString(name);
    return std::string(value == nullptr ? "" : reinterpret_cast<const char*>(value));
  };
  facts.renderer = text(GL_RENDERER);
  facts.version = text(GL_VERSION);
  if (epoxy_gl_version() < 45) return TooOldForUs(facts.renderer, facts.version);
  GLint vertex_blocks = 0;
  glGetIntegerv(GL_MAX_VERTEX_SHADER_STORAGE_BLOCKS, &vertex_blocks);
  if (vertex_blocks < 3) {
    return Status::Error("{}: the vertex shader can read {} storage blocks, 3 are needed; update the graphics driver",
                         facts.renderer, vertex_blocks);
  }
  constexpr std::array<std::string_view, 4> kSoftware = {"llvmpipe", "softpipe", "swrast", "SWR"};
  facts.software = std::any_of(kSoftware.begin(), kSoftware.end(),
                               [&](std::string_view name) { return facts.renderer.find(name) != std::string::npos; });
  if (!facts.software && (epoxy_has_gl_extension("GL_EXT_texture_filter_anisotropic") ||
                          epoxy_has_gl_extension("GL_ARB_texture_filter_anisotropic"))) {
    glGetFloatv(GL_MAX_TEXTURE_MAX_ANISOTROPY_EXT, &facts.max_anisotropy);
  }
  return facts;
}

}  // namespace belvedere
