// EffectPass: the soft shapes of a display list - smoke, fire, light, trails, marks on the ground - blended over what
// is drawn, farthest first, in one draw. They are hidden by what lies before them and hide nothing.
//
// Threads: the render thread's.
#pragma once

#include "render/gl_objects.h"
#include "runtime/scene/display_list.h"
#include "runtime/scene/view_parameters.h"

#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

#include <array>
#include <cstdint>
#include <vector>

namespace belvedere {

class EffectPass {
 public:
  EffectPass();
  // since_list_s: since the list was made. Depth test GL_GEQUAL.
  void Draw(const DisplayList& list, const ViewParameters& view, const ViewMatrices& matrices,
            const glm::dvec3& sun_ecef, double since_list_s);

 private:
  struct Vertex {
    glm::vec4 clip;
    glm::vec2 place;  // -1..1 across; along it 0, or -1..1 where it is round
    std::array<uint8_t, 4> colour;
    float shape;
  };
  struct Quad {
    double distance_m;
    std::array<Vertex, 4> vertices;
  };
  struct Lens;  // how a view projects
  void Add(const EffectInstance& effect, const Lens& lens, const ViewMatrices& matrices, const glm::dvec3& sun_ecef,
           double since_list_s);
  void AddDisc(const EffectInstance& effect, const Lens& lens, std::array<uint8_t, 4> colour);

  GlProgram program_;
  GlVertexArray vertex_array_;
  GlBuffer vertices_, indices_;
  std::vector<Quad> quads_;
  std::vector<Vertex> sorted_;
};

}  // namespace belvedere
