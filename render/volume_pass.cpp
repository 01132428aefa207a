#include "render/volume_pass.h"

#include "render/shader_sources.h"

#include <array>
#include <cmath>
#include <string>

namespace belvedere {
namespace {

constexpr int kSides = 24;  // of a circle

// Points of the unit circle, the first once more at the end.
const std::array<glm::dvec2, kSides + 1>& Circle() {
  static const auto kCircle = [] {
    std::array<glm::dvec2, kSides + 1> points;
    for (int i = 0; i <= kSides; ++i) {
      const double angle = 2.0 * M_PI * i / kSides;
      points[static_cast<size_t>(i)] = {std::cos(angle), std::sin(angle)};
    }
    return points;
  }();
  return kCircle;
}

void AddSphere(const BoundingSphere& sphere, const glm::dmat4& clip_from_ecef, std::vector<glm::vec4>& corners) {
  const auto clip = [&](const glm::dvec3& offset) {
    return glm::vec4(clip_from_ecef * glm::dvec4(sphere.center_ecef + sphere.radius_m * offset, 1.0));
  };
  for (int axis = 0; axis < 3; ++axis) {
    glm::vec4 previous{};
    for (size_t i = 0; i <= kSides; ++i) {
      glm::dvec3 offset(0.0);
      offset[axis] = Circle()[i].x;
      offset[(axis + 1) % 3] = Circle()[i].y;
      const glm::vec4 next = clip(offset);
      if (i > 0) corners.insert(corners.end(), {previous, next});
      previous = next;
    }
  }
}

}  // namespace

VolumePass::VolumePass()
    : program_(MakeProgram("volume", std::string(shaders::kVolumeVert), std::string(shaders::kVolumeFrag))),
      vertex_array_(GlVertexArray::Make()),
      vertices_(GlBuffer::Make()) {
  glVertexArrayVertexBuffer(vertex_array_.get(), 0, vertices_.get(), 0, sizeof(glm::vec4));
  glEnableVertexArrayAttrib(vertex_array_.get(), 0);
  glVertexArrayAttribFormat(vertex_array_.get(), 0, 4, GL_FLOAT, GL_FALSE, 0);
  glVertexArrayAttribBinding(vertex_array_.get(), 0, 0);
}

void VolumePass::Draw(const DisplayList& list, const ViewMatrices& matrices) {
  corners_.clear();
  const BoundingSphere* innermost = nullptr;
  for (const ListRecord& record : list.records) {
    if (record.kind == ListRecord::Kind::kCullBegin) innermost = &list.volumes[record.index];
    if (record.kind != ListRecord::Kind::kDrawTerrain || innermost == nullptr) continue;
    if (matrices.frustum.Hides(*innermost) || matrices.horizon.Hides(*innermost)) continue;
    AddSphere(*innermost, matrices.clip_from_ecef, corners_);
  }
  if (corners_.empty()) return;
  glNamedBufferData(vertices_.get(), static_cast<GLsizeiptr>(corners_.size() * sizeof(glm::vec4)), corners_.data(),
                    GL_STREAM_DRAW);
  glUseProgram(program_.get());
  glBindVertexArray(vertex_array_.get());
  glDrawArrays(GL_LINES, 0, static_cast<GLsizei>(corners_.size()));
}

}  // namespace belvedere
