// VolumePass: the bounding volumes of the quadnodes that are drawn, each as three circles.
//
// Frames: the list's volumes are spheres in ECEF, metres; what goes to the GPU is in clip space, made in double.
// Threads: the render thread.
#pragma once

#include "render/gl_objects.h"
#include "runtime/scene/display_list.h"
#include "runtime/scene/view_parameters.h"

#include <glm/vec4.hpp>

#include <vector>

namespace belvedere {

class VolumePass {
 public:
  VolumePass();
  void Draw(const DisplayList& list, const ViewMatrices& matrices);

 private:
  GlProgram program_;
  GlVertexArray vertex_array_;
  GlBuffer vertices_;
  std::vector<glm::vec4> corners_;  // of lines, in clip space
};

}  // namespace belvedere
