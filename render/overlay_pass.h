// OverlayPass: symbols, labels and the heads-up display of one view, in one draw: quads in pixels over the picture,
// those that belong to an object at the object's depth.
//
// Units:   pixels from the upper left corner, y downwards; depth as in the depth buffer.
// Threads: OverlayBatch is a value; OverlayPass belongs to the render thread.
#pragma once

#include "render/atlas.h"
#include "render/gl_objects.h"

#include <glm/vec2.hpp>

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

namespace belvedere {

inline constexpr float kFrontDepth = 1.0F;  // over everything

class OverlayBatch {
 public:
  using Colour = std::array<uint8_t, 4>;
  struct Vertex {
    float x, y, depth;
    uint16_t u, v;  // 0..65535 over the atlas
    Colour colour;
  };

  explicit OverlayBatch(const Atlas& atlas) : atlas_(&atlas) {}
  void Clear() { vertices_.clear(); }
  // x, y: where the baseline starts. Whole pixels, so that glyphs stay sharp.
  void AddText(float x, float y, float depth, std::string_view latin1, Colour colour);
  // Turned clockwise by angle_rad on the screen; 0 points up.
  void AddSymbol(glm::vec2 center, float depth, SymbolShape shape, float angle_rad, float scale, Colour colour);
  void AddRectangle(float x, float y, float width, float height, float depth, Colour colour);
  void AddLine(glm::vec2 from, glm::vec2 to, float width, float depth, Colour colour);
  void Append(const OverlayBatch& other);
  const std::vector<Vertex>& vertices() const { return vertices_; }  // 4 a quad
  const Atlas& atlas() const { return *atlas_; }

 private:
  void AddQuad(const std::array<glm::vec2, 4>& corners, float depth, const AtlasShape& shape, Colour colour);

  const Atlas* atlas_;
  std::vector<Vertex> vertices_;
};

class OverlayPass {
 public:
  explicit OverlayPass(const Atlas& atlas);
  // What is drawn from now on.
  void Place(const OverlayBatch& batch);
  // REQUIRES: the view's block is bound; depth test GL_GEQUAL.
  void Draw() const;

 private:
  GlProgram program_;
  GlVertexArray vertex_array_;
  GlBuffer vertices_, indices_;
  GlTexture texture_;
  size_t indexed_quads_ = 0;
  size_t quads_ = 0;
};

}  // namespace belvedere
