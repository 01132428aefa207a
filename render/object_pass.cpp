#include "render/object_pass.h"

#include "render/shader_sources.h"
#include "render/view_block.h"

#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <tuple>
#include <vector>

namespace belvedere {
namespace {

struct InstanceRow {
  glm::mat4 clip_from_body;
  glm::vec4 sun_body;
  glm::vec4 veil;
  glm::vec4 joints;
};
constexpr GLuint kMatrixAttribute = 3, kSunAttribute = 7, kVeilAttribute = 8, kJointsAttribute = 9;
constexpr GLint kPivotsUniform = 0;

struct Drawn {
  int slot;
  size_t detail;
  const MovedObject* object;
};

// Models that are there, the same ones together.
std::vector<Drawn> Group(const DisplayList& list, std::span<const MovedObject> objects, const ViewParameters& view,
                         const GpuPages& pages) {
  std::vector<Drawn> drawn;
  for (const MovedObject& object : objects) {
    const ObjectInstance& instance = list.instances[object.instance];
    if (!DrawnAsModel(instance, view)) continue;
    const GpuModel& model = pages.model(instance.look.model_slot);
    if (model.details.empty()) continue;
    const size_t detail = std::min<size_t>(instance.look.detail, model.details.size() - 1);
    drawn.push_back({instance.look.model_slot, detail, &object});
  }
  std::stable_sort(drawn.begin(), drawn.end(), [](const Drawn& a, const Drawn& b) {
    return std::tie(a.slot, a.detail) < std::tie(b.slot, b.detail);
  });
  return drawn;
}

InstanceRow RowOf(const ObjectInstance& instance, const MovedObject& object, const ViewMatrices& matrices,
                  const glm::dvec3& sun_ecef, double since_list_s) {
  glm::dmat4 ecef_from_body(object.ecef_from_body * static_cast<double>(instance.look.scale));
  ecef_from_body[3] = glm::dvec4(object.position_ecef, 1.0);
  const Daylight light = DaylightAt(object.position_ecef, matrices, sun_ecef);
  InstanceRow row{};
  row.clip_from_body = glm::mat4(matrices.clip_from_ecef * ecef_from_body);
  row.sun_body =
      glm::vec4(glm::vec3(glm::transpose(object.ecef_from_body) * sun_ecef), light.day * instance.look.shade);
  row.veil = glm::vec4(light.air, light.left);
  const double spin =
      static_cast<double>(instance.joints.spin_rad) + since_list_s * static_cast<double>(instance.spin_radps);
  row.joints = {instance.joints.turret_rad, instance.joints.gun_rad, static_cast<float>(std::remainder(spin, 2 * M_PI)),
                instance.joints.open};
  return row;
}

}  // namespace

ObjectPass::ObjectPass(const GpuPages& pages)
    : pages_(pages),
      program_(MakeProgram("model", std::string(shaders::kModelVert), std::string(shaders::kModelFrag))),
      vertex_array_(GlVertexArray::Make()),
      instances_(GlBuffer::Make()) {
  const GLuint array = vertex_array_.get();
  const auto attribute = [&](GLuint index, GLint size, GLenum type, GLboolean normalised, size_t offset,
                             GLuint binding) {
    glEnableVertexArrayAttrib(array, index);
    glVertexArrayAttribFormat(array, index, size, type, normalised, static_cast<GLuint>(offset));
    glVertexArrayAttribBinding(array, index, binding);
  };
  attribute(0, 3, GL_FLOAT, GL_FALSE, offsetof(ModelVertex, x), 0);
  attribute(1, 3, GL_FLOAT, GL_FALSE, offsetof(ModelVertex, normal_x), 0);
  attribute(2, 4, GL_UNSIGNED_BYTE, GL_TRUE, offsetof(ModelVertex, colour), 0);  // and the joint
  for (GLuint column = 0; column < 4; ++column) {
    attribute(kMatrixAttribute + column, 4, GL_FLOAT, GL_FALSE, column * sizeof(glm::vec4), 1);
  }
  attribute(kSunAttribute, 4, GL_FLOAT, GL_FALSE, offsetof(InstanceRow, sun_body), 1);
  attribute(kVeilAttribute, 4, GL_FLOAT, GL_FALSE, offsetof(InstanceRow, veil), 1);
  attribute(kJointsAttribute, 4, GL_FLOAT, GL_FALSE, offsetof(InstanceRow, joints), 1);
  glVertexArrayBindingDivisor(array, 1, 1);
}

void ObjectPass::Place(const DisplayList& list, std::span<const MovedObject> objects, const ViewParameters& view,
                       const ViewMatrices& matrices, const glm::dvec3& sun_ecef, double since_list_s) {
  batches_.clear();
  const std::vector<Drawn> drawn = Group(list, objects, view, pages_);
  if (drawn.empty()) return;
  std::vector<InstanceRow> rows;
  rows.reserve(drawn.size());
  for (const Drawn& one : drawn) {
    if (batches_.empty() || batches_.back().slot != one.slot || batches_.back().detail != one.detail)
      batches_.push_back({one.slot, one.detail, static_cast<GLuint>(rows.size()), 0});
    ++batches_.back().count;
    rows.push_back(RowOf(list.instances[one.object->instance], *one.object, matrices, sun_ecef, since_list_s));
  }
  glNamedBufferData(instances_.get(), static_cast<GLsizeiptr>(rows.size() * sizeof(InstanceRow)), rows.data(),
                    GL_STREAM_DRAW);
}

uint32_t ObjectPass::Draw() const {
  if (batches_.empty()) return 0;
  glUseProgram(program_.get());
  glBindVertexArray(vertex_array_.get());
  glVertexArrayVertexBuffer(vertex_array_.get(), 1, instances_.get(), 0, sizeof(InstanceRow));
  uint32_t triangles = 0;
  for (const Batch& batch : batches_) {
    const GpuModel& model = pages_.model(batch.slot);
    const ModelPage::Detail& detail = model.details[batch.detail];
    glUniform3fv(kPivotsUniform, static_cast<GLsizei>(kModelJoints), &model.pivots[0].x);
    glVertexArrayVertexBuffer(vertex_array_.get(), 0, model.vertices.get(), 0, sizeof(ModelVertex));
    glVertexArrayElementBuffer(vertex_array_.get(), model.indices.get());
    glDrawElementsInstancedBaseInstance(GL_TRIANGLES, static_cast<GLsizei>(detail.index_count), GL_UNSIGNED_INT,
                                        reinterpret_cast<const void*>(detail.first_index * sizeof(uint32_t)),
                                        batch.count, batch.first);
    triangles += detail.index_count / 3 * static_cast<uint32_t>(batch.count);
  }
  return triangles;
}

}  // namespace belvedere
