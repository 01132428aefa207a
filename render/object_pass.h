// ObjectPass: draws moving objects as models: one instanced draw for each model and level of detail.
//
// Matrices are multiplied in double, relative to the eye, and become floats at the very end.
// Threads: the render thread.
#pragma once

#include "render/gl_objects.h"
#include "render/gpu_pages.h"
#include "render/moved_objects.h"

#include <glm/mat4x4.hpp>
#include <glm/vec4.hpp>

#include <cstdint>
#include <span>

namespace belvedere {

class ObjectPass {
 public:
  explicit ObjectPass(const GpuPages& pages);

  // Returns the triangles drawn. REQUIRES: the view's block is bound.
  uint32_t Draw(const DisplayList& list, std::span<const MovedObject> objects, const ViewParameters& view,
                const ViewMatrices& matrices, const glm::dvec3& sun_ecef, double since_list_s);

 private:
  const GpuPages& pages_;
  GlProgram program_;
  GlVertexArray vertex_array_;
  GlBuffer instances_;
};

}  // namespace belvedere
