#include "servers/delta_values.h"

#include "runtime/base/status.h"
#include "runtime/earth/bisection.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstring>

namespace belvedere {
namespace {

// Four posts of a row at once; compilers have this as a type of their own.
typedef float Lane4 __attribute__((vector_size(16)));

Lane4 Load(const float* from) {
  Lane4 lanes;
  std::memcpy(&lanes, from, sizeof(lanes));
  return lanes;
}

Lane4 SquareRoots(const Lane4& squared) {
  const Lane4 roots{std::sqrt(squared[0]), std::sqrt(squared[1]), std::sqrt(squared[2]), std::sqrt(squared[3])};
  return roots;
}

float GreatestOf(const Lane4& lanes) {
  return std::max(std::max(lanes[0], lanes[1]), std::max(lanes[2], lanes[3]));
}

// The most of the blocks that the four cells around a post lie in.
float ErrorAround(Post post, const ErrorBlocks& errors_m) {
  float most = 0;
  for (int row = std::max(post.row - 1, 0); row <= std::min(post.row, kCells - 1); ++row) {
    for (int column = std::max(post.column - 1, 0); column <= std::min(post.column, kCells - 1); ++column) {
      most = std::max(most, errors_m[static_cast<size_t>(row / kBlockCells * kErrorBlocks + column / kBlockCells)]);
    }
  }
  return most;
}

// The vertices as three rasters, so that rows can be taken four posts at a time, and what finer pages may add around
// each as a fourth. Relative to the page's middle, where floats are finest. Three spare floats at the end keep the last
// load inside.
class Surface {
 public:
  Surface(std::span<const TerrainVertex> vertices, const ErrorBlocks& errors_m) {
    const TerrainVertex& middle = vertices[kVerticesPerPage / 2];
    for (std::vector<float>* raster : {&x_, &y_, &z_, &left_out_}) raster->resize(kVerticesPerPage + 3);
    for (size_t i = 0; i < kVerticesPerPage; ++i) {
      x_[i] = vertices[i].x - middle.x;
      y_[i] = vertices[i].y - middle.y;
      z_[i] = vertices[i].z - middle.z;
      left_out_[i] = ErrorAround(Post{static_cast<int>(i) % kPosts, static_cast<int>(i) / kPosts}, errors_m);
    }
  }

  glm::vec3 at(Post post) const {
    const auto index = static_cast<size_t>(post.index());
    return {x_[index], y_[index], z_[index]};
  }

  float SquaredDistance(Post post, const glm::vec3& to) const {
    const glm::vec3 between = at(post) - to;
    return glm::dot(between, between);
  }
  // How far the full-resolution surface around the post may be from the middle between a and b, if that is drawn.
  float ErrorBetween(Post post, Post a, Post b) const {
    return std::sqrt(SquaredDistance(post, 0.5F * (at(a) + at(b)))) + left_out_[static_cast<size_t>(post.index())];
  }

  // Raises `greatest` to the most, over posts (first .. last, row), of the distance from the plane point that begins at
  // `start` and moves by `step` a column, and of what finer pages add at the post.
  void AddRow(int row, int first, int last, const glm::vec3& start, const glm::vec3& step, Lane4& greatest) const {
    const int offset = row * kPosts;
    const Lane4 lane{0, 1, 2, 3};
    for (int column = first; column <= last; column += 4) {
      const auto index = static_cast<size_t>(offset + column);
      const Lane4 along = lane + static_cast<float>(column - first);
      const Lane4 x = Load(&x_[index]) - (start.x + along * step.x);
      const Lane4 y = Load(&y_[index]) - (start.y + along * step.y);
      const Lane4 z = Load(&z_[index]) - (start.z + along * step.z);
      Lane4 error = SquareRoots(x * x + y * y + z * z) + Load(&left_out_[index]);
      const Lane4 nothing{0, 0, 0, 0};
      error = along <= static_cast<float>(last - first) + nothing ? error : nothing;
      greatest = error > greatest ? error : greatest;
    }
  }

 private:
  std::vector<float> x_, y_, z_, left_out_;
};

// The plane through the three corners of a triangle, as a point that is linear in column and row.
struct Plane {
  glm::vec3 at_origin;  // of column `origin.column`, row `origin.row`
  glm::vec3 per_column;
  glm::vec3 per_row;
  Post origin;

  glm::vec3 At(int column, int row) const {
    return at_origin + static_cast<float>(column - origin.column) * per_column +
           static_cast<float>(row - origin.row) * per_row;
  }
};

// hypotenuse diagonal, right angle at the apex: the legs lie along its row and its column.
float DiagonalError(const Surface& surface, const Split& split, Post apex) {
  const Post in_row = split.end_a.row == apex.row ? split.end_a : split.end_b;
  const Post in_column = split.end_a.row == apex.row ? split.end_b : split.end_a;
  const glm::vec3 corner = surface.at(apex);
  const int columns = in_row.column - apex.column;
  const int rows = in_column.row - apex.row;
  const Plane plane{corner, (surface.at(in_row) - corner) / static_cast<float>(columns),
                    (surface.at(in_column) - corner) / static_cast<float>(rows), apex};
  const int side = std::abs(rows);
  Lane4 greatest{0, 0, 0, 0};
  for (int away = 0; away < side; ++away) {  // rows from the apex; the last is a single corner
    const int row = apex.row + (rows > 0 ? away : -away);
    const int width = side - away;
    const int first = columns > 0 ? apex.column : apex.column - width;
    surface.AddRow(row, first, first + width, plane.At(first, row), plane.per_column, greatest);
  }
  return GreatestOf(greatest);
}

// hypotenuse along a row or a column, `post` in its middle.
float StraightError(const Surface& surface, const Split& split, Post post, Post apex) {
  const glm::vec3 a = surface.at(split.end_a);
  const glm::vec3 b = surface.at(split.end_b);
  const glm::vec3 middle = 0.5F * (a + b);
  const bool along_row = split.end_a.row == split.end_b.row;
  const int span = along_row ? post.column - split.end_a.column : post.row - split.end_a.row;
  const int side = along_row ? apex.row - post.row : apex.column - post.column;  // + or - span
  const glm::vec3 along = (b - a) / static_cast<float>(2 * span);
  const glm::vec3 across = (surface.at(apex) - middle) / static_cast<float>(side);
  const Plane plane{middle, along_row ? along : across, along_row ? across : along, post};
  Lane4 greatest{0, 0, 0, 0};
  const int first_row = along_row ? 0 : 1 - span;
  for (int away = first_row; away < span; ++away) {
    const int row = along_row && side < 0 ? post.row - away : post.row + away;
    const int width = span - std::abs(away);
    const int first = along_row ? post.column - width : side > 0 ? post.column : post.column - width;
    const int last = along_row ? post.column + width : side > 0 ? post.column + width : post.column;
    surface.AddRow(row, first, last, plane.At(first, row), plane.per_column, greatest);
  }
  return GreatestOf(greatest);
}

// The two finest levels hold so few posts that they are tried one by one.
float SmallDiagonalError(const Surface& surface, const Split& split, Post apex) {
  const auto between = [&](Post a, Post b) {
    return surface.ErrorBetween({(a.column + b.column) / 2, (a.row + b.row) / 2}, a, b);
  };
  return std::max(between(apex, split.end_a), between(apex, split.end_b));
}

float OwnError(const Surface& surface, Post post, const Split& split, int level) {
  float greatest = surface.ErrorBetween(post, split.end_a, split.end_b);
  if (level == kBisectionLevels - 1) return greatest;
  for (const Post apex : {split.apex_a, split.apex_b}) {
    if (!apex.inside()) continue;
    const float error = level == kBisectionLevels - 2 ? SmallDiagonalError(surface, split, apex)
                        : level % 2 == 0              ? DiagonalError(surface, split, apex)
                                                      : StraightError(surface, split, post, apex);
    greatest = std::max(greatest, error);
  }
  return greatest;
}

// Calls visit(post) for every post of one level.
template <typename Visit>
void ForEachPost(int level, const Visit& visit) {
  const int span = HalfSpan(level);
  if (level % 2 == 0) {
    for (int row = span; row < kPosts; row += 2 * span) {
      for (int column = span; column < kPosts; column += 2 * span) visit(Post{column, row});
    }
    return;
  }
  for (int row = 0; row < kPosts; row += span) {
    const int first = (row / span) % 2 == 0 ? span : 0;
    for (int column = first; column < kPosts; column += 2 * span) visit(Post{column, row});
  }
}

}  // namespace

DeltaValues DeltaValuesOf(std::span<const TerrainVertex> vertices, const ErrorBlocks& errors_m) {
  BELVEDERE_CHECK(vertices.size() == kVerticesPerPage);
  static_assert(kBisections == kBisectionLevels);
  constexpr float kRoundedUp = 1.000001F;
  const Surface surface(vertices, errors_m);
  DeltaValues values;
  values.deltas_m.resize(kVerticesPerPage);
  for (int level = 0; level < kBisectionLevels; ++level) {
    float spread_squared = 0;
    ForEachPost(level, [&](Post post) {
      const Split split = SplitAt(post);
      values.deltas_m[static_cast<size_t>(post.index())] = OwnError(surface, post, split, level);
      const glm::vec3 position = surface.at(post);
      for (const Post corner : {split.end_a, split.end_b, split.apex_a, split.apex_b}) {
        if (corner.inside()) spread_squared = std::max(spread_squared, surface.SquaredDistance(corner, position));
      }
    });
    values.spread_m[static_cast<size_t>(level)] = std::sqrt(spread_squared) * kRoundedUp;
  }
  // The corners split nothing and are always drawn.
  const float greatest = *std::max_element(values.deltas_m.begin(), values.deltas_m.end());
  for (const Post corner : {Post{0, 0}, Post{kCells, 0}, Post{0, kCells}, Post{kCells, kCells}}) {
    values.deltas_m[static_cast<size_t>(corner.index())] = greatest;
  }
  return values;
}

}  // namespace belvedere
