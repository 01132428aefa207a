// SkyPass: the sky, where nothing else was drawn. Drawn after everything that is opaque.
//
// Threads: the render thread.
#pragma once

#include "render/gl_objects.h"

namespace belvedere {

class SkyPass {
 public:
  SkyPass();
  // REQUIRES: the view's block is bound; depth test GL_GEQUAL.
  void Draw() const;

 private:
  GlProgram program_;
  GlVertexArray no_vertices_;
};

}  // namespace belvedere
