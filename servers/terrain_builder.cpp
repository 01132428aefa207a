#include "servers/terrain_builder.h"

#include "runtime/base/status.h"
#include "runtime/earth/ellipsoid.h"
#include "runtime/earth/frame.h"
#include "runtime/earth/post_grid.h"
#include "runtime/paging/delta_values.h"
#include "runtime/paging/stored_deltas.h"
#include "servers/height_field.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace belvedere {
namespace {

// Octahedral map of a unit vector to two snorm16 (Cigolle et al., "A survey of efficient representations for
// independent unit vectors", 2014).
uint32_t PackNormal(const glm::vec3& n) {
  const float sum = std::abs(n.x) + std::abs(n.y) + std::abs(n.z);
  float x = n.x / sum;
  float y = n.y / sum;
  if (n.z < 0) {
    const float folded = (1.0F - std::abs(y)) * (x < 0 ? -1.0F : 1.0F);
    y = (1.0F - std::abs(x)) * (y < 0 ? -1.0F : 1.0F);
    x = folded;
  }
  const auto snorm = [](float v) { return static_cast<uint32_t>(static_cast<uint16_t>(std::lrint(v * 32767.0F))); };
  return snorm(x) | (snorm(y) << 16);
}

// Surface normal in the frame, from slopes along the meridian and the parallel.
glm::vec3 NormalAt(const RowGeometry& row, const ColumnGeometry& column, const glm::mat3& ecef_from_frame,
                   float slope_east, float slope_north) {
  const auto sin_latitude = static_cast<float>(row.sin_latitude);
  const auto cos_latitude = static_cast<float>(row.cos_latitude);
  const auto sin_longitude = static_cast<float>(column.sin_longitude);
  const auto cos_longitude = static_cast<float>(column.cos_longitude);
  // up - slope_east * east - slope_north * north
  const float meridional = cos_latitude + slope_north * sin_latitude;
  const glm::vec3 ecef{meridional * cos_longitude + slope_east * sin_longitude,
                       meridional * sin_longitude - slope_east * cos_longitude,
                       sin_latitude - slope_north * cos_latitude};
  return glm::normalize(ecef * ecef_from_frame);
}

std::vector<TerrainVertex> VerticesOf(Quadcode node, const PostGrid& grid, const HeightField& field) {
  const Frame frame = FrameOf(node);
  const glm::mat3 ecef_from_frame(frame.ecef_from_frame);
  std::vector<TerrainVertex> vertices(kVerticesPerPage);
  size_t index = 0;
  for (const RowGeometry& row : grid.rows) {
    for (const ColumnGeometry& column : grid.columns) {
      const glm::dvec3 local = frame.ToFrame(EcefAt(row, column, field.height_m[index]));
      const glm::vec3 normal =
          NormalAt(row, column, ecef_from_frame, field.slope_east[index], field.slope_north[index]);
      vertices[index] = {static_cast<float>(local.x), static_cast<float>(local.y), static_cast<float>(local.z),
                         PackNormal(normal)};
      ++index;
    }
  }
  return vertices;
}

int PostOf(Side side, int along) {
  switch (side) {
    case Side::kWest: return along * kPosts;
    case Side::kEast: return along * kPosts + kCells;
    case Side::kSouth: return along;
    case Side::kNorth: return kCells * kPosts + along;
  }
  return 0;
}

// Moves the border's vertices to where they are laid; widens the range of heights to theirs.
void Lay(const std::vector<glm::dvec3>& posts_ecef, Side side, const Frame& frame, TerrainPage& page) {
  for (int along = 0; along < kPosts; ++along) {
    const glm::dvec3& ecef = posts_ecef[static_cast<size_t>(along)];
    const glm::dvec3 local = frame.ToFrame(ecef);
    TerrainVertex& vertex = page.vertices[static_cast<size_t>(PostOf(side, along))];
    vertex.x = static_cast<float>(local.x);
    vertex.y = static_cast<float>(local.y);
    vertex.z = static_cast<float>(local.z);
    const auto height_m = static_cast<float>(ToGeodetic(ecef).height_m);
    page.min_height_m = std::min(page.min_height_m, height_m);
    page.max_height_m = std::max(page.max_height_m, height_m);
  }
}

// A sphere around all that can be drawn of a quadnode whose heights lie between the two.
BoundingSphere BoundsOf(Quadcode node, const PostGrid& grid, double min_height_m, double max_height_m) {
  // The border at both heights says all: seen from the middle, nothing within a shell this small is further than its
  // rim.
  std::vector<glm::dvec3> points;
  points.reserve(8 * kPosts + 2);
  for (const double height_m : {min_height_m, max_height_m}) {
    for (size_t i = 0; i < kPosts; ++i) {
      points.push_back(grid.At(i, 0, height_m));
      points.push_back(grid.At(i, kCells, height_m));
      points.push_back(grid.At(0, i, height_m));
      points.push_back(grid.At(kCells, i, height_m));
    }
    points.push_back(grid.At(kCells / 2, kCells / 2, height_m));
  }
  const glm::dmat3 axes = FrameOf(node).ecef_from_frame;  // a box along the ground is the tightest to start from
  glm::dvec3 least(std::numeric_limits<double>::max());
  glm::dvec3 greatest(std::numeric_limits<double>::lowest());
  for (const glm::dvec3& point : points) {
    const glm::dvec3 local = point * axes;
    least = glm::min(least, local);
    greatest = glm::max(greatest, local);
  }
  BoundingSphere sphere;
  sphere.center_ecef = axes * (0.5 * (least + greatest));
  double squared = 0;
  for (const glm::dvec3& point : points) {
    const glm::dvec3 away = point - sphere.center_ecef;
    squared = std::max(squared, glm::dot(away, away));
  }
  const double rounding_m = node.level() >= kFrameLevel ? 1e-3 : 1.0;  // of vertices to float
  sphere.radius_m = std::sqrt(squared) + CellSagitta(node) + rounding_m;
  return sphere;
}

// The builder's delta values are those of the page's own posts, in their places.
bool CanUseStored(const TerrainInput& input) {
  return input.heights != nullptr && input.heights_node == input.node && !input.heights->deltas.steps.empty() &&
         input.exaggeration == 1 &&
         std::all_of(input.laid_ecef.begin(), input.laid_ecef.end(), [](const auto& laid) { return laid.empty(); });
}

}  // namespace

std::vector<glm::dvec3> BorderPosts(const TerrainInput& input, Side side) {
  const HeightField field = SampleHeights(input.node, input.heights, input.heights_node, input.exaggeration);
  const PostGrid grid(input.node);
  std::vector<glm::dvec3> posts;
  posts.reserve(kPosts);
  for (int along = 0; along < kPosts; ++along) {
    const auto post = static_cast<size_t>(PostOf(side, along));
    posts.push_back(grid.At(post % kPosts, post / kPosts, field.height_m[post]));
  }
  return posts;
}

std::vector<glm::dvec3> LaidOn(Quadcode node, Side side, Quadcode coarser, const std::vector<glm::dvec3>& posts) {
  const bool meridian = side == Side::kWest || side == Side::kEast;
  const auto along_of = [&](Quadcode of) { return meridian ? of.SouthWest().y : of.SouthWest().x; };
  const auto spacing_of = [&](Quadcode of) { return meridian ? of.PostSpacingNorth() : of.PostSpacingEast(); };
  BELVEDERE_CHECK(spacing_of(coarser) >= spacing_of(node) && posts.size() == kPosts);
  const uint32_t start = along_of(node) - along_of(coarser);  // wraps at 180 E
  std::vector<glm::dvec3> laid;
  laid.reserve(kPosts);
  for (uint32_t along = 0; along < kPosts; ++along) {
    const double position = static_cast<double>(start + along * spacing_of(node)) / spacing_of(coarser);
    const size_t first = std::min(static_cast<size_t>(position), size_t{kCells} - 1);
    const double share = position - static_cast<double>(first);
    laid.push_back((1.0 - share) * posts[first] + share * posts[first + 1]);
  }
  return laid;
}

std::unique_ptr<TerrainPage> BuildTerrain(const TerrainInput& input) {
  BELVEDERE_CHECK(input.exaggeration > 0);
  const HeightField field = SampleHeights(input.node, input.heights, input.heights_node, input.exaggeration);
  const bool interpolated = input.heights != nullptr && input.heights_node != input.node && !input.finer_exists;

  ErrorBlocks errors_m{};
  if (input.finer_exists) {
    errors_m.fill(static_cast<float>(CellSagitta(input.node)));
    for (size_t block = 0; input.heights != nullptr && block < errors_m.size(); ++block) {
      // Blocks of an ancestor's heights are not this quadnode's: then the worst of them holds.
      const bool own = input.heights_node == input.node;
      errors_m[block] += (own ? input.heights->block_errors_m[block] : input.heights->error_m) *
                         static_cast<float>(input.exaggeration);
    }
  }
  auto [low, high] = std::minmax_element(field.height_m.begin(), field.height_m.end());
  double min_height_m = *low;
  double max_height_m = *high;
  if (input.heights != nullptr && !interpolated) {
    min_height_m = std::min(min_height_m, static_cast<double>(input.heights->min_m) * input.exaggeration);
    max_height_m = std::max(max_height_m, static_cast<double>(input.heights->max_m) * input.exaggeration);
  }

  const PostGrid grid(input.node);
  auto page = std::make_unique<TerrainPage>();
  page->node = input.node;
  page->vertices = VerticesOf(input.node, grid, field);
  page->error_m = *std::max_element(errors_m.begin(), errors_m.end());
  page->min_height_m = static_cast<float>(min_height_m);
  page->max_height_m = static_cast<float>(max_height_m);
  for (size_t side = 0; side < input.laid_ecef.size(); ++side) {
    if (!input.laid_ecef[side].empty()) {
      Lay(input.laid_ecef[side], static_cast<Side>(side), FrameOf(input.node), *page);
    }
  }
  page->deltas = CanUseStored(input) ? RestoreDeltas(input.heights->deltas) : DeltaValuesOf(page->vertices, errors_m);
  page->spread_m = SpreadsOf(page->vertices);
  const BoundingSphere bounds = BoundsOf(input.node, grid, page->min_height_m, page->max_height_m);
  page->center_ecef = bounds.center_ecef;
  page->radius_m = bounds.radius_m;
  return page;
}

}  // namespace belvedere
