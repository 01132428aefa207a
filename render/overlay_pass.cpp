#include "render/overlay_pass.h"

#include "render/shader_sources.h"

#include <glm/geometric.hpp>

#include <cmath>
#include <cstddef>
#include <string>

namespace belvedere {
namespace {

uint16_t Unorm(float x) {
  return static_cast<uint16_t>(std::lround(x * 65535.0F));
}

}  // namespace

// corners: upper left, upper right, lower right, lower left of the shape.
void OverlayBatch::AddQuad(const std::array<glm::vec2, 4>& corners, float depth, const AtlasShape& shape,
                           Colour colour) {
  const std::array<glm::vec2, 4> uv = {glm::vec2{shape.u0, shape.v0}, glm::vec2{shape.u1, shape.v0},
                                       glm::vec2{shape.u1, shape.v1}, glm::vec2{shape.u0, shape.v1}};
  for (size_t i = 0; i < 4; ++i) {
    vertices_.push_back({corners[i].x, corners[i].y, depth, Unorm(uv[i].x), Unorm(uv[i].y), colour});
  }
}

void OverlayBatch::AddText(float x, float y, float depth, std::string_view latin1, Colour colour) {
  float pen = x;
  const float baseline = std::round(y);
  for (const char c : latin1) {
    const AtlasShape& glyph = atlas_->Glyph(static_cast<unsigned char>(c));
    if (c != ' ' && glyph.width > 0) {
      const float left = std::round(pen) + glyph.left;
      const float top = baseline + glyph.top;
      AddQuad({glm::vec2{left, top}, glm::vec2{left + glyph.width, top},
               glm::vec2{left + glyph.width, top + glyph.height}, glm::vec2{left, top + glyph.height}},
              depth, glyph, colour);
    }
    pen += glyph.advance;
  }
}

void OverlayBatch::AddSymbol(glm::vec2 center, float depth, SymbolShape shape, float angle_rad, float scale,
                             Colour colour) {
  const float half = 0.5F * Atlas::kSymbolSide_px * scale;
  const glm::vec2 right = half * glm::vec2{std::cos(angle_rad), std::sin(angle_rad)};
  const glm::vec2 down = {-right.y, right.x};
  AddQuad({center - right - down, center + right - down, center + right + down, center - right + down}, depth,
          atlas_->Symbol(shape), colour);
}

void OverlayBatch::AddRectangle(float x, float y, float width, float height, float depth, Colour colour) {
  AddQuad({glm::vec2{x, y}, glm::vec2{x + width, y}, glm::vec2{x + width, y + height}, glm::vec2{x, y + height}}, depth,
          atlas_->solid(), colour);
}

void OverlayBatch::AddLine(glm::vec2 from, glm::vec2 to, float width, float depth, Colour colour) {
  const glm::vec2 along = to - from;
  const float length = glm::length(along);
  if (length < 0.5F) return;
  const glm::vec2 across = (0.5F * width / length) * glm::vec2{-along.y, along.x};
  AddQuad({from + across, to + across, to - across, from - across}, depth, atlas_->solid(), colour);
}

void OverlayBatch::Append(const OverlayBatch& other) {
  vertices_.insert(vertices_.end(), other.vertices_.begin(), other.vertices_.end());
}

OverlayPass::OverlayPass(const Atlas& atlas)
    : program_(MakeProgram("overlay", std::string(shaders::kView) + std::string(shaders::kOverlayVert),
                           std::string(shaders::kOverlayFrag))),
      vertex_array_(GlVertexArray::Make()),
      vertices_(GlBuffer::Make()),
      indices_(GlBuffer::Make()),
      texture_(GlTexture::Make()) {
  glTextureStorage2D(texture_.get(), 1, GL_RG8, Atlas::kWidth, Atlas::kHeight);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glTextureSubImage2D(texture_.get(), 0, 0, 0, Atlas::kWidth, Atlas::kHeight, GL_RG, GL_UNSIGNED_BYTE,
                      atlas.texels().data());
  glTextureParameteri(texture_.get(), GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  glTextureParameteri(texture_.get(), GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  const GLuint array = vertex_array_.get();
  glVertexArrayVertexBuffer(array, 0, vertices_.get(), 0, sizeof(OverlayBatch::Vertex));
  glVertexArrayElementBuffer(array, indices_.get());
  glVertexArrayAttribFormat(array, 0, 3, GL_FLOAT, GL_FALSE, offsetof(OverlayBatch::Vertex, x));
  glVertexArrayAttribFormat(array, 1, 2, GL_UNSIGNED_SHORT, GL_TRUE, offsetof(OverlayBatch::Vertex, u));
  glVertexArrayAttribFormat(array, 2, 4, GL_UNSIGNED_BYTE, GL_TRUE, offsetof(OverlayBatch::Vertex, colour));
  for (GLuint attribute = 0; attribute < 3; ++attribute) {
    glEnableVertexArrayAttrib(array, attribute);
    glVertexArrayAttribBinding(array, attribute, 0);
  }
}

void OverlayPass::Place(const OverlayBatch& batch) {
  quads_ = batch.vertices().size() / 4;
  if (quads_ == 0) return;
  if (quads_ > indexed_quads_) {
    indexed_quads_ = 2 * quads_;
    std::vector<uint32_t> indices;
    indices.reserve(6 * indexed_quads_);
    for (uint32_t quad = 0; quad < indexed_quads_; ++quad) {
      for (const uint32_t corner : {0U, 1U, 2U, 0U, 2U, 3U}) indices.push_back(4 * quad + corner);
    }
    glNamedBufferData(indices_.get(), static_cast<GLsizeiptr>(indices.size() * sizeof(uint32_t)), indices.data(),
                      GL_STATIC_DRAW);
  }
  glNamedBufferData(vertices_.get(), static_cast<GLsizeiptr>(batch.vertices().size() * sizeof(OverlayBatch::Vertex)),
                    batch.vertices().data(), GL_STREAM_DRAW);
}

void OverlayPass::Draw() const {
  if (quads_ == 0) return;
  glUseProgram(program_.get());
  glBindVertexArray(vertex_array_.get());
  glBindTextureUnit(2, texture_.get());
  glDisable(GL_CULL_FACE);
  glEnable(GL_BLEND);
  glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  glDepthMask(GL_FALSE);
  glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(6 * quads_), GL_UNSIGNED_INT, nullptr);
  glDepthMask(GL_TRUE);
  glDisable(GL_BLEND);
  glEnable(GL_CULL_FACE);
}

}  // namespace belvedere
