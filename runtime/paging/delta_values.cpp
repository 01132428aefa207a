#include "runtime/paging/delta_values.h"

#include "runtime/base/status.h"
#include "runtime/earth/bisection.h"
#include "runtime/earth/ellipsoid.h"
#include "runtime/earth/units.h"
#include "runtime/paging/roundness.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <type_traits>

namespace belvedere {
namespace {

constexpr size_t kSpare = 3;  // at the end of rasters, so that four can be loaded at once from any

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

float SquaredDistance(const glm::vec3& a, const glm::vec3& b) {
  const glm::vec3 between = a - b;
  return glm::dot(between, between);
}

// Points in rows, from the south-west; relative to something near, where floats are finest.
class PointRaster {
 public:
  explicit PointRaster(size_t points) : x_(points + kSpare), y_(points + kSpare), z_(points + kSpare) {}
  void Set(size_t index, const glm::vec3& point) {
    x_[index] = point.x;
    y_[index] = point.y;
    z_[index] = point.z;
  }
  glm::vec3 at(size_t index) const { return {x_[index], y_[index], z_[index]}; }

  // Of points index .. index + 3 from four of a line.
  Lane4 SquaredDistances(size_t index, const Lane4& along, const glm::vec3& start, const glm::vec3& step) const {
    const Lane4 dx = Load(&x_[index]) - (start.x + along * step.x);
    const Lane4 dy = Load(&y_[index]) - (start.y + along * step.y);
    const Lane4 dz = Load(&z_[index]) - (start.z + along * step.z);
    return dx * dx + dy * dy + dz * dz;
  }

 private:
  std::vector<float> x_, y_, z_;
};

// Calls add(index, along) for four points of a row at a time, `along` being how far each is from the first. Returns the
// most of what it returned for the row's points, and of `greatest`.
template <typename Add>
inline Lane4 MostOfRow(size_t first, int points, Lane4 greatest, const Add& add) {
  const auto most = [](const Lane4& a, const Lane4& b) { return a > b ? a : b; };
  Lane4 along{0, 1, 2, 3};
  int from = 0;
  for (; from + 4 <= points; from += 4, along += 4.0F)
    greatest = most(add(first + static_cast<size_t>(from), along), greatest);
  if (from == points) return greatest;
  const Lane4 nothing{0, 0, 0, 0};
  const Lane4 last = static_cast<float>(points - 1) + nothing;
  const Lane4 rest = add(first + static_cast<size_t>(from), along);
  return most(along <= last ? rest : nothing, greatest);
}

// The surfaces that follow have values at posts, which a triangle takes linearly from its corners; points, kPerCell to
// a cell; and AddRow, which raises `greatest` to the most, over points (first .. last, row), of how far the surface is
// from values that begin at `start` and move by `step` a point; ErrorOf makes metres of it. kTips: also at the tips of
// triangles the surface lies elsewhere.

// The posts themselves, and what finer pages may add around each.
class OwnSurface {
 public:
  using Value = glm::vec3;
  static constexpr int kPerCell = 1;
  static constexpr bool kTips = false;

  OwnSurface(std::span<const TerrainVertex> vertices, const ErrorBlocks& errors_m) {
    const glm::vec3 middle = PlaceOf(vertices[kVerticesPerPage / 2]);
    for (size_t i = 0; i < kVerticesPerPage; ++i) {
      posts_.Set(i, PlaceOf(vertices[i]) - middle);
      left_out_[i] = ErrorAround(Post{static_cast<int>(i) % kPosts, static_cast<int>(i) / kPosts}, errors_m);
    }
  }

  glm::vec3 at(Post post) const { return posts_.at(static_cast<size_t>(post.index())); }

  // How far the finest surface around the post may be from the middle between a and b, if that is drawn.
  float ErrorBetween(Post post, Post a, Post b) const {
    return std::sqrt(SquaredDistance(at(post), 0.5F * (at(a) + at(b)))) + left_out_[static_cast<size_t>(post.index())];
  }

  void AddRow(int row, int first, int last, const glm::vec3& start, const glm::vec3& step, Lane4& greatest) const {
    greatest = MostOfRow(
        static_cast<size_t>(row * kPosts + first), last - first + 1, greatest, [&](size_t index, const Lane4& along) {
          return SquareRoots(posts_.SquaredDistances(index, along, start, step)) + Load(&left_out_[index]);
        });
  }
  static float ErrorOf(const Lane4& greatest) { return GreatestOf(greatest); }

 private:
  PointRaster posts_{kVerticesPerPage};
  std::vector<float> left_out_ = std::vector<float>(kVerticesPerPage + kSpare);
};

// Heights of the finest surface over those of the triangles, and the reverse, both on the paraboloid.
class Relief {
 public:
  using Value = float;
  static constexpr int kPerCell = FinestSurface::kPerCell;
  static constexpr bool kTips = true;

  Relief(std::span<const float> heights_m, const FinestSurface& finest, const Paraboloid& paraboloid)
      : posts_m_(heights_m.begin(), heights_m.end()), low_m_(finest.low_m), high_m_(finest.high_m) {
    low_m_.resize(low_m_.size() + kSpare);
    high_m_.resize(high_m_.size() + kSpare);
    for (int row = 0; row < kSide; ++row) {
      for (int column = 0; column < kSide; ++column) {
        const auto round_m = static_cast<float>(paraboloid.At(column, row));
        const auto index = static_cast<size_t>(row * kSide + column);
        low_m_[index] += round_m;
        high_m_[index] += round_m;
        if (row % kPerCell == 0 && column % kPerCell == 0)
          posts_m_[static_cast<size_t>(Post{column / kPerCell, row / kPerCell}.index())] += round_m;
      }
    }
  }

  float at(Post post) const { return posts_m_[static_cast<size_t>(post.index())]; }

  // How far the finest surface is, at points index .. index + 3, from what is drawn there.
  Lane4 Off(size_t index, const Lane4& drawn) const {
    const Lane4 over = Load(&high_m_[index]) - drawn;
    const Lane4 under = drawn - Load(&low_m_[index]);
    return over > under ? over : under;
  }

  void AddRow(int row, int first, int last, float start, float step, Lane4& greatest) const {
    greatest = MostOfRow(static_cast<size_t>(row * kSide + first), last - first + 1, greatest,
                         [&](size_t index, const Lane4& along) { return Off(index, start + along * step); });
  }
  static float ErrorOf(const Lane4& greatest) { return GreatestOf(greatest); }

 private:
  static constexpr int kSide = FinestSurface::kSide;
  std::vector<float> posts_m_, low_m_, high_m_;
};

// The value within a triangle, linear in column and row.
template <typename Value>
struct Plane {
  Value at_origin;  // of column `origin_column`, row `origin_row`
  Value per_column;
  Value per_row;
  int origin_column = 0, origin_row = 0;

  Value At(int column, int row) const {
    return at_origin + static_cast<float>(column - origin_column) * per_column +
           static_cast<float>(row - origin_row) * per_row;
  }
};

// Columns and rows of the surface's points, where a post's are.
template <typename Surface>
Post PointAt(Post post) {
  return {post.column * Surface::kPerCell, post.row * Surface::kPerCell};
}

// hypotenuse diagonal, right angle at the apex: the legs lie along its row and its column.
template <typename Surface>
float DiagonalError(const Surface& surface, const Split& split, Post apex) {
  const Post in_row = split.end_a.row == apex.row ? split.end_a : split.end_b;
  const Post in_column = split.end_a.row == apex.row ? split.end_b : split.end_a;
  const Post origin = PointAt<Surface>(apex);
  const int columns = PointAt<Surface>(in_row).column - origin.column;
  const int rows = PointAt<Surface>(in_column).row - origin.row;
  const typename Surface::Value corner = surface.at(apex);
  const Plane<typename Surface::Value> plane{corner, (surface.at(in_row) - corner) / static_cast<float>(columns),
                                             (surface.at(in_column) - corner) / static_cast<float>(rows), origin.column,
                                             origin.row};
  const int side = std::abs(rows);
  Lane4 greatest{0, 0, 0, 0};
  for (int away = 0; away < side + (Surface::kTips ? 1 : 0); ++away) {  // rows from the apex
    const int row = origin.row + (rows > 0 ? away : -away);
    const int width = side - away;
    const int first = columns > 0 ? origin.column : origin.column - width;
    surface.AddRow(row, first, first + width, plane.At(first, row), plane.per_column, greatest);
  }
  return Surface::ErrorOf(greatest);
}

// hypotenuse along a row or a column, `post` in its middle.
template <typename Surface>
float StraightError(const Surface& surface, const Split& split, Post post, Post apex) {
  using Value = typename Surface::Value;
  const Value a = surface.at(split.end_a);
  const Value b = surface.at(split.end_b);
  const Value middle = 0.5F * (a + b);
  const bool along_row = split.end_a.row == split.end_b.row;
  const Post origin = PointAt<Surface>(post);
  const Post end = PointAt<Surface>(split.end_a);
  const Post tip = PointAt<Surface>(apex);
  const int span = along_row ? origin.column - end.column : origin.row - end.row;
  const int side = along_row ? tip.row - origin.row : tip.column - origin.column;  // + or - span
  const Value along = (b - a) / static_cast<float>(2 * span);
  const Value across = (surface.at(apex) - middle) / static_cast<float>(side);
  const Plane<Value> plane{middle, along_row ? along : across, along_row ? across : along, origin.column, origin.row};
  Lane4 greatest{0, 0, 0, 0};
  const int rows = span - (Surface::kTips ? 0 : 1);
  for (int away = along_row ? 0 : -rows; away <= rows; ++away) {
    const int row = along_row && side < 0 ? origin.row - away : origin.row + away;
    const int width = span - std::abs(away);
    const int first = along_row || side < 0 ? origin.column - width : origin.column;
    const int last = along_row || side > 0 ? origin.column + width : origin.column;
    surface.AddRow(row, first, last, plane.At(first, row), plane.per_column, greatest);
  }
  return Surface::ErrorOf(greatest);
}

// The two finest levels of a surface of its posts hold so few of them that they are tried one by one.
float SmallDiagonalError(const OwnSurface& surface, const Split& split, Post apex) {
  const auto between = [&](Post a, Post b) {
    return surface.ErrorBetween({(a.column + b.column) / 2, (a.row + b.row) / 2}, a, b);
  };
  return std::max(between(apex, split.end_a), between(apex, split.end_b));
}

// The same of a relief, whose finest triangles hold so few points that rows are taken whole. Offsets are in points
// from the post.
static_assert(Relief::kPerCell == 2);
constexpr Lane4 kFromTwoWest{-2, -1, 0, 1}, kFromOneWest{-1, 0, 1, 2};

Lane4 Greater(const Lane4& a, const Lane4& b) {
  return a > b ? a : b;
}

// Level kBisectionLevels - 2: a square of 5 x 5 points, split by a diagonal.
float SquareError(const Relief& relief, Post post, const Split& split) {
  const auto corner = [&](int columns, int rows) { return relief.at({post.column + columns, post.row + rows}); };
  const float south_west = corner(-1, -1), south_east = corner(1, -1), north_west = corner(-1, 1),
              north_east = corner(1, 1);
  const bool rises = (split.end_a.column < split.end_b.column) == (split.end_a.row < split.end_b.row);
  // West of the diagonal, and east of it, from the south-west corner.
  const float north_side = (north_east - north_west) / 4, south_side = (south_east - south_west) / 4;
  const float west_up = (north_west - south_west) / 4, east_up = (north_east - south_east) / 4;
  const float west_along = rises ? north_side : south_side, east_along = rises ? south_side : north_side;
  const float east_start = rises ? south_west : north_west + south_east - north_east;
  const Post point = PointAt<Relief>(post);
  Lane4 greatest{0, 0, 0, 0};
  for (int row = 0; row < 5; ++row) {
    const auto up = static_cast<float>(row);
    const float diagonal = rises ? up : 4 - up;
    const float west = south_west + up * west_up, east = east_start + up * east_up;
    const auto index = static_cast<size_t>((point.row - 2 + row) * FinestSurface::kSide + point.column - 2);
    const auto add = [&](size_t at, const Lane4& along) {
      const Lane4 drawn = along <= diagonal ? west + along * west_along : east + along * east_along;
      greatest = Greater(relief.Off(at, drawn), greatest);
    };
    add(index, kFromTwoWest + 2.0F);
    add(index + 1, kFromOneWest + 2.0F);
  }
  return Relief::ErrorOf(greatest);
}

// Level kBisectionLevels - 1, within the page: two triangles that meet in a row or a column, 13 points in all.
float DiamondError(const Relief& relief, Post post, const Split& split) {
  const float a = relief.at(split.end_a), b = relief.at(split.end_b);
  const float middle = 0.5F * (a + b), along = (b - a) / 4;
  const float to_a = (relief.at(split.apex_a) - middle) / 2, to_b = (relief.at(split.apex_b) - middle) / 2;
  const bool along_row = split.end_a.row == split.end_b.row;
  // What a step west, east, south and north changes: ends and apexes a lie west or south of the post, b east or north.
  const float west = along_row ? -along : to_a, east = along_row ? along : to_b;
  const float south = along_row ? to_a : -along, north = along_row ? to_b : along;
  const auto across = [&](const Lane4& columns) { return columns < 0.0F ? -columns * west : columns * east; };
  const Post point = PointAt<Relief>(post);
  const auto at = [&](int column, int row) {
    return static_cast<size_t>((point.row + row) * FinestSurface::kSide + point.column + column);
  };
  const Lane4 one_west = across(kFromOneWest);
  const Lane4 ahead =
      Greater(relief.Off(at(-2, 0), middle + across(kFromTwoWest)), relief.Off(at(-1, 0), middle + one_west));
  const Lane4 beside =
      Greater(relief.Off(at(-1, -1), middle + south + one_west), relief.Off(at(-1, 1), middle + north + one_west));
  const Lane4 tips = Greater(relief.Off(at(0, -2), middle + 2 * south + Lane4{0, 0, 0, 0}),
                             relief.Off(at(0, 2), middle + 2 * north + Lane4{0, 0, 0, 0}));
  return std::max({Relief::ErrorOf(ahead), beside[0], beside[1], beside[2], tips[0]});
}

template <typename Surface>
float ErrorOfSplit(const Surface& surface, Post post, const Split& split, int level) {
  constexpr bool kOfPosts = std::is_same_v<Surface, OwnSurface>;
  float greatest = 0;
  if constexpr (kOfPosts) {
    greatest = surface.ErrorBetween(post, split.end_a, split.end_b);
    if (level == kBisectionLevels - 1) return greatest;
  } else {
    if (level == kBisectionLevels - 2) return SquareError(surface, post, split);
    if (level == kBisectionLevels - 1 && split.apex_a.inside() && split.apex_b.inside())
      return DiamondError(surface, post, split);
  }
  for (const Post apex : {split.apex_a, split.apex_b}) {
    if (!apex.inside()) continue;
    if constexpr (kOfPosts) {
      if (level == kBisectionLevels - 2) {
        greatest = std::max(greatest, SmallDiagonalError(surface, split, apex));
        continue;
      }
    }
    greatest = std::max(
        greatest, level % 2 == 0 ? DiagonalError(surface, split, apex) : StraightError(surface, split, post, apex));
  }
  return greatest;
}

// Between the highest and the lowest of the corners of the triangles that a post splits.
double RangeOf(std::span<const float> heights_m, const Split& split) {
  float low = heights_m[static_cast<size_t>(split.end_a.index())], high = low;
  for (const Post corner : {split.end_b, split.apex_a, split.apex_b}) {
    if (!corner.inside()) continue;
    low = std::min(low, heights_m[static_cast<size_t>(corner.index())]);
    high = std::max(high, heights_m[static_cast<size_t>(corner.index())]);
  }
  return static_cast<double>(high - low);
}

// From corner to corner of a cell, as seen from the Earth's middle, at most.
double LargestCellRadians(Quadcode node) {
  return std::hypot(node.HeightDegrees(), WidthOnGroundDegrees(node)) / kCells * kRadiansPerDegree;
}

// Of the posts that split something; the corners get the greatest.
template <typename Of>
std::vector<float> DeltasBy(const Of& of) {
  std::vector<float> deltas_m(kVerticesPerPage);
  for (int level = 0; level < kBisectionLevels; ++level)
    ForEachPost(level, [&](Post post) { deltas_m[static_cast<size_t>(post.index())] = of(post, level); });
  const float greatest = *std::max_element(deltas_m.begin(), deltas_m.end());
  for (const Post corner : kCorners) deltas_m[static_cast<size_t>(corner.index())] = greatest;
  return deltas_m;
}

}  // namespace

std::vector<float> DeltaValuesOf(Quadcode node, std::span<const float> heights_m, const FinestSurface& finest) {
  constexpr size_t kPoints = static_cast<size_t>(FinestSurface::kSide) * FinestSurface::kSide;
  BELVEDERE_CHECK(heights_m.size() == kVerticesPerPage);
  BELVEDERE_CHECK(finest.low_m.size() == kPoints && finest.high_m.size() == kPoints);
  constexpr double kSampled = 1.02;    // what is looked at in places may be a little more between them
  constexpr double kAtHeight = 0.002;  // by which the Earth's shape counts for more, or less, 12 km over or under it
  const Paraboloid paraboloid(node);
  const Roundness& roundness = RoundnessAround(node);
  const Relief relief(heights_m, finest, paraboloid);
  const double cell_radians = LargestCellRadians(node);
  return DeltasBy([&](Post post, int level) {
    const Split split = SplitAt(post);
    const Roundness::Rest& rest = roundness.at(post, level);
    // No two verticals of a triangle are further apart than those at the ends of a diagonal hypotenuse of the level.
    const double turn = 2 * HalfSpan(level) * cell_radians;
    const double bulge_m = turn * turn * kEquatorialRadius_m / 8.0;
    const double up_m =
        static_cast<double>(ErrorOfSplit(relief, post, split, level)) + kSampled * rest.up_m + kAtHeight * bulge_m;
    const double aside_m = (1.0 + kAtHeight) * kSampled * rest.aside_m + turn * RangeOf(heights_m, split);
    return static_cast<float>(std::sqrt(up_m * up_m + aside_m * aside_m));
  });
}

std::vector<float> DeltaValuesOf(std::span<const TerrainVertex> vertices, const ErrorBlocks& errors_m) {
  BELVEDERE_CHECK(vertices.size() == kVerticesPerPage);
  static_assert(kBisections == kBisectionLevels);
  const OwnSurface surface(vertices, errors_m);
  return DeltasBy([&](Post post, int level) { return ErrorOfSplit(surface, post, SplitAt(post), level); });
}

std::array<float, kBisections> SpreadsOf(std::span<const TerrainVertex> vertices) {
  constexpr float kRoundedUp = 1.000001F;
  const auto place = [&](int column, int row) { return PlaceOf(vertices[static_cast<size_t>(row * kPosts + column)]); };
  std::array<float, kBisections> spread_m{};
  for (int level = 0; level < kBisectionLevels; ++level) {
    const int span = HalfSpan(level);
    float squared = 0;
    const auto widen = [&](const glm::vec3& a, const glm::vec3& b) {
      squared = std::max(squared, SquaredDistance(a, b));
    };
    if (level % 2 == 0) {  // the corners are those of a square around the post
      for (int row = span; row < kPosts; row += 2 * span) {
        for (int column = span; column < kPosts; column += 2 * span) {
          const glm::vec3 middle = place(column, row);
          for (const int north : {-span, span}) {
            widen(middle, place(column - span, row + north));
            widen(middle, place(column + span, row + north));
          }
        }
      }
    } else {  // the corners are next to it; of any two posts that are, one is of the level
      for (int row = 0; row < kPosts; row += span) {
        for (int column = 0; column < kPosts; column += span) {
          const glm::vec3 here = place(column, row);
          if (column + span < kPosts) widen(here, place(column + span, row));
          if (row + span < kPosts) widen(here, place(column, row + span));
        }
      }
    }
    spread_m[static_cast<size_t>(level)] = std::sqrt(squared) * kRoundedUp;
  }
  return spread_m;
}

}  // namespace belvedere
