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
#include <vector>

namespace belvedere {

class ObjectPass {
 public:
  explicit ObjectPass(const GpuPages& pages);

  // Puts the objects where they are drawn from now on.
  void Place(const DisplayList& list, std::span<const MovedObject> objects, const ViewParameters& view,
             const ViewMatrices& matrices, const glm::dvec3& sun_ecef, double since_list_s);
  // Draws those placed last; returns their triangles. REQUIRES: the view's block is bound; their models are still
  // there.
  uint32_t Draw() const;

 private:
  // Instances of one model and level of detail.
  struct Batch {
    int slot = 0;
    size_t detail = 0;
    GLuint first = 0;
    GLsizei count = 0;
  };

  const GpuPages& pages_;
  std::vector<Batch> batches_;
  GlProgram program_;
  GlVertexArray vertex_array_;
  GlBuffer instances_;
};

}  // namespace belvedere
