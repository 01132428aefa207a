#include "render/effect_pass.h"

#include "render/shader_sources.h"
#include "render/view_block.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>

namespace belvedere {
namespace {

constexpr double kMost_px = 400;        // radius: smoke around the eye fills no more, which would cost a picture
constexpr double kDiscForward = 0.995;  // marks are drawn this much nearer than the ground that they lie on

std::array<uint8_t, 4> Lit(std::array<uint8_t, 4> colour, const Daylight& light) {
  for (size_t channel = 0; channel < 3; ++channel) {
    const float lit =
        static_cast<float>(colour[channel]) / 255.0F * light.day * light.left + light.air[static_cast<int>(channel)];
    colour[channel] = static_cast<uint8_t>(std::lround(255.0F * std::clamp(lit, 0.0F, 1.0F)));
  }
  return colour;
}

}  // namespace

struct EffectPass::Lens {
  const ViewMatrices& matrices;
  bool perspective;
  double width_px, height_px;

  struct Point {
    glm::dvec4 clip;
    glm::dvec2 screen_px;
    double distance_m, metre_px;
  };
  // False before the near plane.
  bool Project(const glm::dvec3& ecef, Point& point) const {
    const glm::dvec4 camera = matrices.camera_from_ecef * glm::dvec4(ecef, 1.0);
    point.distance_m = -camera.z;
    if (point.distance_m < matrices.near_m) return false;
    point.clip = matrices.clip_from_camera * camera;
    point.screen_px = {0.5 * width_px * point.clip.x / point.clip.w, 0.5 * height_px * point.clip.y / point.clip.w};
    point.metre_px = perspective ? matrices.pixels_per_radian / point.distance_m : matrices.pixels_per_metre;
    return true;
  }
  glm::vec4 Moved(const Point& point, const glm::dvec2& by_px) const {
    glm::dvec4 clip = point.clip;
    clip.x += 2.0 * by_px.x / width_px * clip.w;
    clip.y += 2.0 * by_px.y / height_px * clip.w;
    return {clip};
  }
};

EffectPass::EffectPass()
    : program_(MakeProgram("effect", std::string(shaders::kEffectVert), std::string(shaders::kEffectFrag))),
      vertex_array_(GlVertexArray::Make()),
      vertices_(GlBuffer::Make()),
      indices_(GlBuffer::Make()) {
  std::vector<uint32_t> indices;
  indices.reserve(6 * kMostEffects);
  for (uint32_t quad = 0; quad < kMostEffects; ++quad) {
    for (const uint32_t corner : {0U, 1U, 2U, 0U, 2U, 3U}) indices.push_back(4 * quad + corner);
  }
  glNamedBufferData(indices_.get(), static_cast<GLsizeiptr>(indices.size() * sizeof(uint32_t)), indices.data(),
                    GL_STATIC_DRAW);
  const GLuint array = vertex_array_.get();
  glVertexArrayVertexBuffer(array, 0, vertices_.get(), 0, sizeof(Vertex));
  glVertexArrayElementBuffer(array, indices_.get());
  glVertexArrayAttribFormat(array, 0, 4, GL_FLOAT, GL_FALSE, offsetof(Vertex, clip));
  glVertexArrayAttribFormat(array, 1, 2, GL_FLOAT, GL_FALSE, offsetof(Vertex, place));
  glVertexArrayAttribFormat(array, 2, 4, GL_UNSIGNED_BYTE, GL_TRUE, offsetof(Vertex, colour));
  glVertexArrayAttribFormat(array, 3, 1, GL_FLOAT, GL_FALSE, offsetof(Vertex, shape));
  for (GLuint attribute = 0; attribute < 4; ++attribute) {
    glEnableVertexArrayAttrib(array, attribute);
    glVertexArrayAttribBinding(array, attribute, 0);
  }
}

void EffectPass::AddDisc(const EffectInstance& effect, const Lens& lens, std::array<uint8_t, 4> colour) {
  const glm::dvec3 normal = effect.to_ecef - effect.from_ecef;
  const glm::dvec3 some = std::abs(normal.z) < 0.9 ? glm::dvec3(0, 0, 1) : glm::dvec3(1, 0, 0);
  const glm::dvec3 east = glm::normalize(glm::cross(some, normal)), north = glm::normalize(glm::cross(normal, east));
  const glm::dvec3 eye = lens.matrices.eye_ecef;
  Quad quad{};
  constexpr std::array<glm::vec2, 4> kCorners = {glm::vec2(-1, -1), glm::vec2(1, -1), glm::vec2(1, 1),
                                                 glm::vec2(-1, 1)};
  for (size_t i = 0; i < 4; ++i) {
    const glm::dvec3 corner =
        effect.from_ecef + static_cast<double>(effect.from_m) *
                               (static_cast<double>(kCorners[i].x) * east + static_cast<double>(kCorners[i].y) * north);
    Lens::Point point{};
    if (!lens.Project(eye + kDiscForward * (corner - eye), point)) return;
    quad.distance_m = std::max(quad.distance_m, point.distance_m);
    quad.vertices[i] = {glm::vec4(point.clip), kCorners[i], colour, static_cast<float>(effect.shape)};
  }
  quads_.push_back(quad);
}

void EffectPass::Add(const EffectInstance& effect, const Lens& lens, const ViewMatrices& matrices,
                     const glm::dvec3& sun_ecef, double since_list_s) {
  const bool lit = effect.shape == EffectInstance::Shape::kPuff || effect.shape == EffectInstance::Shape::kDisc;
  const Daylight light = lit ? DaylightAt(effect.from_ecef, matrices, sun_ecef) : Daylight{};
  const auto from_colour = lit ? Lit(effect.from_colour, light) : effect.from_colour;
  const auto to_colour = lit ? Lit(effect.to_colour, light) : effect.to_colour;
  if (effect.shape == EffectInstance::Shape::kDisc) return AddDisc(effect, lens, from_colour);
  const glm::dvec3 moved = since_list_s * effect.velocity_mps;
  Lens::Point from{}, to{};
  if (!lens.Project(effect.from_ecef + moved, from) || !lens.Project(effect.to_ecef + moved, to)) return;
  const auto radius_px = [&](const Lens::Point& point, float radius_m) {
    return std::min(std::max(static_cast<double>(effect.least_px), static_cast<double>(radius_m) * point.metre_px),
                    kMost_px);
  };
  const double from_px = radius_px(from, effect.from_m), to_px = radius_px(to, effect.to_m);
  const glm::dvec2 way = to.screen_px - from.screen_px;
  const double length_px = glm::length(way);
  const bool round = length_px < 0.5 && effect.from_ecef == effect.to_ecef;
  const glm::dvec2 along = length_px < 1e-6 ? glm::dvec2(1, 0) : way / length_px;
  const glm::dvec2 across(-along.y, along.x);
  const glm::dvec2 back = round ? from_px * along : glm::dvec2(0.0), on = round ? to_px * along : glm::dvec2(0.0);
  const auto shape = static_cast<float>(effect.shape);
  const float end = round ? 1.0F : 0.0F;
  quads_.push_back({std::max(from.distance_m, to.distance_m),
                    {{{lens.Moved(from, -back - from_px * across), {-end, -1}, from_colour, shape},
                      {lens.Moved(to, on - to_px * across), {end, -1}, to_colour, shape},
                      {lens.Moved(to, on + to_px * across), {end, 1}, to_colour, shape},
                      {lens.Moved(from, -back + from_px * across), {-end, 1}, from_colour, shape}}}});
}

void EffectPass::Draw(const DisplayList& list, const ViewParameters& view, const ViewMatrices& matrices,
                      const glm::dvec3& sun_ecef, double since_list_s) {
  quads_.clear();
  const Lens lens{matrices, view.projection == Projection::kPerspective, 1.0 * view.width_px, 1.0 * view.height_px};
  for (size_t i = 0; i < std::min(list.effects.size(), kMostEffects); ++i) {
    const EffectInstance& effect = list.effects[i];
    const double reach_m =
        static_cast<double>(std::max(effect.from_m, effect.to_m)) + glm::distance(effect.from_ecef, effect.to_ecef);
    const BoundingSphere sphere{effect.from_ecef, reach_m};
    if (matrices.horizon.Hides(sphere) || (effect.least_px <= 0 && matrices.frustum.Hides(sphere))) continue;
    Add(effect, lens, matrices, sun_ecef, since_list_s);
  }
  if (quads_.empty()) return;
  std::stable_sort(quads_.begin(), quads_.end(),
                   [](const Quad& a, const Quad& b) { return a.distance_m > b.distance_m; });
  sorted_.clear();
  for (const Quad& quad : quads_) sorted_.insert(sorted_.end(), quad.vertices.begin(), quad.vertices.end());
  glNamedBufferData(vertices_.get(), static_cast<GLsizeiptr>(sorted_.size() * sizeof(Vertex)), sorted_.data(),
                    GL_STREAM_DRAW);
  glUseProgram(program_.get());
  glBindVertexArray(vertex_array_.get());
  glDisable(GL_CULL_FACE);
  glEnable(GL_BLEND);
  glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
  glDepthMask(GL_FALSE);
  glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(6 * quads_.size()), GL_UNSIGNED_INT, nullptr);
  glDepthMask(GL_TRUE);
  glDisable(GL_BLEND);
  glEnable(GL_CULL_FACE);
}

}  // namespace belvedere
