#include "render/terrain_pass.h"

#include "render/ground_tint.h"
#include "render/shader_sources.h"
#include "render/view_block.h"
#include "runtime/base/status.h"
#include "runtime/earth/ellipsoid.h"
#include "runtime/earth/post_grid.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <string>
#include <utility>

namespace belvedere {
namespace {

// DrawRow of shaders/terrain.vert.glsl.
struct DrawRow {
  uint32_t south_west_x = 0, south_west_y = 0;
  uint32_t post_spacing_east = 0, post_spacing_north = 0;
  uint32_t frame = 0;
  float per_rise_s = 0;
  float per_grid_unit_east = 0, per_grid_unit_north = 0;
  std::array<float, kFadingLayers> fade_s{};
  std::array<float, kFadingLayers> from_page{};
  std::array<uint32_t, 4> tints{};
  std::array<glm::vec4, kFadingLayers> from{};
  std::array<glm::vec4, kMaxImageLayers> image{};
  std::array<float, kMaxImageLayers> image_page{};
  std::array<float, 2> unused{};
};
static_assert(sizeof(DrawRow) == 224);
static_assert(sizeof(FrameRow) == 128);
static_assert(sizeof(ListVertex) == 24);

glm::vec4 RectangleOf(const ImageUse& use) {
  return {use.offset_u, use.offset_v, use.scale_u, use.scale_v};
}

// From the quadnode's middle to a corner, radians, and a little more.
double ReachOf(Quadcode node) {
  return 0.75 * std::max(WidthOnGroundDegrees(node), node.HeightDegrees()) * kRadiansPerDegree;
}

constexpr uint8_t ModeOf(LayerRole role) {
  return static_cast<uint8_t>(static_cast<int>(role) + 1);
}

TerrainPrograms::LayerMode ModeOf(const LayerUse& use, bool single) {
  return {ModeOf(use.role), single, use.opacity != 1 || use.gamma != 1 || use.multiplier != 1};
}

constexpr double kLightsOff = 0.08;  // sine of the sun's elevation, as in shaders/terrain.vert.glsl

template <typename T>
void Replace(const GlBuffer& buffer, const std::vector<T>& rows) {
  glNamedBufferData(buffer.get(), static_cast<GLsizeiptr>(std::max<size_t>(rows.size(), 1) * sizeof(T)),
                    rows.empty() ? nullptr : rows.data(), GL_STREAM_DRAW);
}

// Makes the buffer large enough; what was in it may be lost.
void Reserve(const GlBuffer& buffer, size_t& capacity, size_t bytes) {
  if (bytes <= capacity) return;
  capacity = bytes + bytes / 4;
  glNamedBufferData(buffer.get(), static_cast<GLsizeiptr>(capacity), nullptr, GL_DYNAMIC_DRAW);
}

// Of the bytes [first, last) of two rows of bytes, one after the other, those of one row that begins at `begin`.
void SendPart(const GlBuffer& buffer, const void* row, size_t row_bytes, size_t begin, size_t first, size_t last) {
  first = std::clamp(first, begin, begin + row_bytes) - begin;
  last = std::clamp(last, begin, begin + row_bytes) - begin;
  if (first == last) return;
  glNamedBufferSubData(buffer.get(), static_cast<GLintptr>(first), static_cast<GLsizeiptr>(last - first),
                       static_cast<const uint8_t*>(row) + first);
}

}  // namespace

GLuint TerrainPrograms::For(const Layers& layers) {
  GlProgram& program = programs_[layers];
  if (!program) {
    std::string defines;
    const auto count_of = [&](LayerRole role) {
      return std::count_if(layers.images.begin(), layers.images.end(),
                           [&](const LayerMode& layer) { return layer.role == ModeOf(role); });
    };
    for (size_t i = 0; i < layers.images.size(); ++i) {
      defines += fmt::format("#define LAYER{0} {1}\n#define SINGLE{0} {2}\n#define ADJUST{0} {3}\n", i,
                             layers.images[i].role, layers.images[i].single ? 1 : 0, layers.images[i].adjusted ? 1 : 0);
    }
    const auto multipliers = count_of(LayerRole::kMultiply);
    defines += fmt::format(
        "#define MULTIPLIERS {}\n#define SLOPES {}\n#define NIGHT {}\n#define WATER {}\n#define TINT {}\n#define FADE "
        "{}\n",
        multipliers, multipliers == 0 ? 1 : 0, count_of(LayerRole::kNight) > 0 ? 1 : 0,
        count_of(LayerRole::kWater) > 0 ? 1 : 0, layers.tinted ? 1 : 0, layers.fading ? 1 : 0);
    const std::string common = std::string(shaders::kView) + std::string(shaders::kAtmosphere);
    program = MakeProgram("terrain", common + std::string(shaders::kTerrainVert),
                          common + std::string(shaders::kTerrainFrag), defines);
  }
  return program.get();
}

TerrainPass::TerrainPass(const GpuPages& pages, TerrainPrograms& programs)
    : pages_(pages),
      programs_(programs),
      vertex_array_(GlVertexArray::Make()),
      draw_numbers_(GlBuffer::Make()),
      frames_(GlBuffer::Make()),
      draws_(GlBuffer::Make()),
      commands_(GlBuffer::Make()) {
  const GLuint array = vertex_array_.get();
  glEnableVertexArrayAttrib(array, 0);
  glVertexArrayAttribFormat(array, 0, 3, GL_FLOAT, GL_FALSE, 0);
  glVertexArrayAttribBinding(array, 0, 0);
  glEnableVertexArrayAttrib(array, 1);
  glVertexArrayAttribFormat(array, 1, 2, GL_SHORT, GL_TRUE, offsetof(ListVertex, normal));
  glVertexArrayAttribBinding(array, 1, 0);
  glEnableVertexArrayAttrib(array, 2);
  glVertexArrayAttribIFormat(array, 2, 1, GL_UNSIGNED_INT, offsetof(ListVertex, place));
  glVertexArrayAttribBinding(array, 2, 0);
  glEnableVertexArrayAttrib(array, 3);
  glVertexArrayAttribFormat(array, 3, 1, GL_FLOAT, GL_FALSE, offsetof(ListVertex, rise_m));
  glVertexArrayAttribBinding(array, 3, 0);
  glEnableVertexArrayAttrib(array, 4);
  glVertexArrayAttribIFormat(array, 4, 1, GL_UNSIGNED_INT, 0);
  glVertexArrayAttribBinding(array, 4, 1);
  glVertexArrayBindingDivisor(array, 1, 1);
}

TerrainPass::Layers TerrainPass::LayersOf(uint32_t number, const TerrainDraw& draw, const ViewParameters& view,
                                          double since_list_s, const glm::dvec3& sun_ecef) const {
  Layers layers;
  layers.fading = std::any_of(draw.fade_s.begin(), draw.fade_s.end(),
                              [&](float fade_s) { return static_cast<double>(fade_s) > since_list_s; });
  layers.tinted = view.tint != GroundTint::kNone;
  const std::span<const LayerUse> uses = view.image_layers;
  const double sun_sine = glm::dot(middles_[number].up_ecef, sun_ecef);
  const double reach = middles_[number].reach;
  for (size_t i = 0; i < std::min(draw.images.size(), uses.size()); ++i) {
    const LayerUse& use = uses[i];
    if (draw.images[i].slot < 0 || !use.shown()) continue;
    // Neither costs anything where it cannot be seen.
    if (use.role == LayerRole::kNight && sun_sine - reach > kLightsOff) continue;
    if (use.role == LayerRole::kWater && sun_sine + reach < 0) continue;
    layers.images[i] = ModeOf(use, !pages_.IsColour(draw.images[i].slot));
  }
  return layers;
}

bool TerrainPass::Send(const DisplayList& list, size_t& bytes_left) {
  const size_t vertex_bytes = list.vertices->size() * sizeof(ListVertex);
  const size_t index_bytes = list.indices.size() * sizeof(uint32_t);
  if (sent_bytes_ == 0) {
    Reserve(coming_.vertices, coming_.vertex_capacity, vertex_bytes);
    Reserve(coming_.indices, coming_.index_capacity, index_bytes);
  }
  const size_t last = std::min(sent_bytes_ + bytes_left, vertex_bytes + index_bytes);
  SendPart(coming_.vertices, list.vertices->data(), vertex_bytes, 0, sent_bytes_, last);
  SendPart(coming_.indices, list.indices.data(), index_bytes, vertex_bytes, sent_bytes_, last);
  bytes_left -= last - sent_bytes_;
  sent_bytes_ = last;
  return last == vertex_bytes + index_bytes;
}

void TerrainPass::Show(const DisplayList& list) {
  std::swap(shown_, coming_);
  sent_bytes_ = 0;
  glVertexArrayVertexBuffer(vertex_array_.get(), 0, shown_.vertices.get(), 0, sizeof(ListVertex));
  glVertexArrayElementBuffer(vertex_array_.get(), shown_.indices.get());
  SetDraws(list);
}

float TerrainPass::PageOf(const ImageUse& use) const {
  return use.slot < 0 ? 0.0F : static_cast<float>(pages_.ArrayLayer(use.slot));
}

void TerrainPass::SetDraws(const DisplayList& list) {
  std::vector<DrawRow> rows;
  rows.reserve(list.terrain_draws.size());
  middles_.clear();
  for (const TerrainDraw& draw : list.terrain_draws) {
    const GridPoint corner = draw.node.SouthWest();
    BELVEDERE_CHECK(draw.frame < list.frames.size());
    DrawRow row;
    row.south_west_x = corner.x;
    row.south_west_y = corner.y;
    row.post_spacing_east = draw.node.PostSpacingEast();
    row.post_spacing_north = draw.node.PostSpacingNorth();
    row.frame = draw.frame;
    row.per_grid_unit_east = 1.0F / static_cast<float>(draw.node.GridWidth());
    row.per_grid_unit_north = 1.0F / static_cast<float>(draw.node.GridHeight());
    row.per_rise_s = draw.rise_s > 0 ? 1.0F / draw.rise_s : 0.0F;
    row.tints = TintsOf(draw, list);
    for (size_t i = 0; i < row.image.size(); ++i) {
      row.image[i] = RectangleOf(draw.images[i]);
      row.image_page[i] = PageOf(draw.images[i]);
    }
    for (size_t i = 0; i < kFadingLayers; ++i) {
      row.from[i] = RectangleOf(draw.from[i]);
      row.from_page[i] = PageOf(draw.from[i]);
      row.fade_s[i] = draw.fade_s[i];
    }
    rows.push_back(row);
    const GeoBox box = draw.node.Box();
    middles_.push_back(
        {UpAt(0.5 * (box.south_deg + box.north_deg), 0.5 * (box.west_deg + box.east_deg)), ReachOf(draw.node)});
  }
  Replace(draws_, rows);
  if (rows.size() > numbered_draws_) {
    std::vector<uint32_t> numbers(rows.size() * 2);
    std::iota(numbers.begin(), numbers.end(), 0U);
    Replace(draw_numbers_, numbers);
    numbered_draws_ = numbers.size();
    glVertexArrayVertexBuffer(vertex_array_.get(), 1, draw_numbers_.get(), 0, sizeof(uint32_t));
  }
}

void TerrainPass::SetMatrices(const DisplayList& list, const ViewMatrices& matrices) {
  std::vector<FrameRow> rows;
  rows.reserve(list.frames.size());
  for (const Frame& frame : list.frames) rows.push_back(MakeFrameRow(frame, matrices.clip_from_ecef));
  Replace(frames_, rows);
}

// Draws one triangle with each program that the view's layers may ask for, so that none is compiled, which takes a
// tenth of a second on some drivers, in the midst of a flight. What the triangle looks like does not matter: it is
// drawn over.
void TerrainPass::WarmPrograms(const DisplayList& list, std::span<const uint32_t> draws, const ViewParameters& view) {
  if (warm_for_ == view.image_layers) return;
  const TerrainDraw& draw = list.terrain_draws[draws.front()];
  if (draw.index_count == 0) return;
  warm_for_ = view.image_layers;
  const void* first = reinterpret_cast<const void*>(draw.first_index * sizeof(uint32_t));
  for (const bool fading : {true, false}) {
    // By day there are no lights, on the dark side no glint.
    for (const LayerRole without : {LayerRole::kNight, LayerRole::kWater, LayerRole::kColour}) {
      Layers layers;
      layers.fading = fading;
      layers.tinted = view.tint != GroundTint::kNone;
      for (size_t i = 0; i < std::min(layers.images.size(), view.image_layers.size()); ++i) {
        const LayerUse& use = view.image_layers[i];
        const bool left_out = use.role == without && without != LayerRole::kColour;
        if (use.shown() && !left_out) layers.images[i] = ModeOf(use, !pages_.HoldsColour(use.type));
      }
      glUseProgram(programs_.For(layers));
      glDrawElementsInstancedBaseInstance(GL_TRIANGLES, 3, GL_UNSIGNED_INT, first, 1, draws.front());
    }
  }
}

void TerrainPass::Draw(const DisplayList& list, std::span<const uint32_t> draws, const ViewMatrices& matrices,
                       const ViewParameters& view, double since_list_s, const glm::dvec3& sun_ecef) {
  if (draws.empty()) return;
  SetMatrices(list, matrices);
  glBindVertexArray(vertex_array_.get());
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, frames_.get());
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 1, draws_.get());
  pages_.BindImages();
  WarmPrograms(list, draws, view);
  layers_of_draw_.clear();
  for (const uint32_t number : draws) {
    layers_of_draw_.push_back(LayersOf(number, list.terrain_draws[number], view, since_list_s, sun_ecef));
  }
  by_layers_.resize(draws.size());
  std::iota(by_layers_.begin(), by_layers_.end(), 0U);
  std::stable_sort(by_layers_.begin(), by_layers_.end(),
                   [&](uint32_t a, uint32_t b) { return layers_of_draw_[a] < layers_of_draw_[b]; });
  commands_of_draw_.clear();
  for (const uint32_t i : by_layers_) {
    const TerrainDraw& draw = list.terrain_draws[draws[i]];
    commands_of_draw_.push_back(
        {.index_count = draw.index_count, .first_index = draw.first_index, .base_instance = draws[i]});
  }
  Replace(commands_, commands_of_draw_);
  glBindBuffer(GL_DRAW_INDIRECT_BUFFER, commands_.get());
  for (size_t first = 0; first < by_layers_.size();) {
    const Layers& layers = layers_of_draw_[by_layers_[first]];
    const auto next = std::find_if(by_layers_.begin() + static_cast<std::ptrdiff_t>(first), by_layers_.end(),
                                   [&](uint32_t i) { return layers_of_draw_[i] != layers; });
    const auto last = static_cast<size_t>(next - by_layers_.begin());
    glUseProgram(programs_.For(layers));
    glMultiDrawElementsIndirect(GL_TRIANGLES, GL_UNSIGNED_INT, reinterpret_cast<const void*>(first * sizeof(Command)),
                                static_cast<GLsizei>(last - first), 0);
    first = last;
  }
}

}  // namespace belvedere
