// TerrainPass: draws the surface of one view. Quadnodes use one another's vertices, so that a vertex is the same
// wherever it is drawn (display_list.h).
//
// What a list brings (vertices, indices, draws) goes to the GPU once, in shares that no frame waits long for, while the
// list before it is still drawn; the matrices of its frames go every time. Threads: the render thread.
#pragma once

#include "render/gl_objects.h"
#include "render/gpu_pages.h"
#include "render/list_walk.h"
#include "runtime/scene/display_list.h"
#include "runtime/scene/view_parameters.h"

#include <array>
#include <compare>
#include <cstdint>
#include <map>
#include <span>
#include <vector>

namespace belvedere {

// The programs, one for each combination of layers that is met; shared by all views.
class TerrainPrograms {
 public:
  // What the program does with each image that a quadnode has.
  struct LayerMode {
    uint8_t role = 0;       // 0 nothing, or LayerRole + 1
    bool single = false;    // one channel
    bool adjusted = false;  // opacity, gamma and multiplier are not all 1
    auto operator<=>(const LayerMode&) const = default;
  };
  struct Layers {
    std::array<LayerMode, kMaxImageLayers> images{};
    bool tinted = false;
    bool fading = false;  // the lowest images are blended in
    auto operator<=>(const Layers&) const = default;
  };
  GLuint For(const Layers& layers);

 private:
  std::map<Layers, GlProgram> programs_;
};

class TerrainPass {
 public:
  TerrainPass(const GpuPages& pages, TerrainPrograms& programs);

  // Takes a share of a list to the GPU, at most so many bytes, which it takes off `bytes_left`; true when all of the
  // list is there. REQUIRES: after the first call, the same list until that is true, and as it was.
  bool Send(const DisplayList& list, size_t& bytes_left);
  // The list that was sent is drawn from now on. REQUIRES: it stays as it is until the next Show.
  void Show(const DisplayList& list);
  // draws: indices of the list's terrain_draws. Layers and tint are those that the view has now.
  void Draw(const DisplayList& list, std::span<const uint32_t> draws, const ViewMatrices& matrices,
            const ViewParameters& view, double since_list_s, const glm::dvec3& sun_ecef);

 private:
  using Layers = TerrainPrograms::Layers;
  Layers LayersOf(uint32_t number, const TerrainDraw& draw, const ViewParameters& view, double since_list_s,
                  const glm::dvec3& sun_ecef) const;
  float PageOf(const ImageUse& use) const;
  void SetDraws(const DisplayList& list);
  void WarmPrograms(const DisplayList& list, std::span<const uint32_t> draws, const ViewParameters& view);
  void SetMatrices(const DisplayList& list, const ViewMatrices& matrices);

  // Vertices and indices of a list on the GPU.
  struct Mesh {
    GlBuffer vertices = GlBuffer::Make(), indices = GlBuffer::Make();
    size_t vertex_capacity = 0, index_capacity = 0;  // bytes
  };

  const GpuPages& pages_;
  TerrainPrograms& programs_;
  GlVertexArray vertex_array_;
  GlBuffer draw_numbers_, frames_, draws_, commands_;
  Mesh shown_, coming_;
  size_t sent_bytes_ = 0;  // of the list that is coming
  size_t numbered_draws_ = 0;
  struct Middle {
    glm::dvec3 up_ecef;
    double reach;  // how far the vertical turns from there within the quadnode, radians
  };
  std::vector<Middle> middles_;     // of the list's draws
  std::vector<LayerUse> warm_for_;  // layers whose programs have been drawn with
  // As glMultiDrawElementsIndirect has it.
  struct Command {
    uint32_t index_count = 0, instance_count = 1, first_index = 0;
    int32_t base_vertex = 0;
    uint32_t base_instance = 0;  // the draw's number
  };
  // Of the draws of one Draw.
  std::vector<Layers> layers_of_draw_;
  std::vector<uint32_t> by_layers_;  // places in layers_of_draw_, those of the same layers together, front to back
  std::vector<Command> commands_of_draw_;
};

}  // namespace belvedere
