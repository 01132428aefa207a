#include "render/sky_pass.h"

#include "render/shader_sources.h"

#include <string>

namespace belvedere {

SkyPass::SkyPass()
    : program_(MakeProgram(
          "sky", std::string(shaders::kView) + std::string(shaders::kSkyVert),
          std::string(shaders::kView) + std::string(shaders::kAtmosphere) + std::string(shaders::kSkyFrag))),
      no_vertices_(GlVertexArray::Make()) {}

void SkyPass::Draw() const {
  glUseProgram(program_.get());
  glBindVertexArray(no_vertices_.get());
  glDepthMask(GL_FALSE);
  glDrawArrays(GL_TRIANGLES, 0, 3);
  glDepthMask(GL_TRUE);
}

}  // namespace belvedere
