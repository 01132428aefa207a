// Context: an OpenGL 4.5 core context, and what it is good at. Two kinds stand behind this seam: off-screen ones (EGL
// without a surface, on a machine with no display) and the hidden one that all windows share (window_system.h).
//
// Threads: MakeCurrent and Release by the render thread; a context is current in one thread at a time.
#pragma once

#include "runtime/base/status.h"

#include <memory>
#include <string>

namespace belvedere {

class Context {
 public:
  virtual ~Context() = default;
  virtual Status MakeCurrent() = 0;
  virtual void Release() = 0;
};

// An off-screen context: a hardware device if there is one, else Mesa's software renderer. No display is needed.
// One line says why when there is none: no EGL, or a GL older than 4.5 (and which).
Result<std::unique_ptr<Context>> MakeOffscreenContext();

// What the current context is and can do.
struct ContextFacts {
  std::string renderer;      // GL_RENDERER
  std::string version;       // GL_VERSION
  bool software = false;     // drawn by the CPU: fill is what costs
  float max_anisotropy = 1;  // 1: no anisotropic filtering
};
// Asks the current context; a Status when it lacks what Belvedere needs.
Result<ContextFacts> InspectContext();

// The one line for a GL that is too old.
Status TooOldForUs(const std::string& where, const std::string& found);

}  // namespace belvedere
