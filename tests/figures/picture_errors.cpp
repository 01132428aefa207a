#include "tests/figures/picture_errors.h"

#include "runtime/earth/frame.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace belvedere::figures {
namespace {

// A triangle in columns and rows of a full-resolution quadnode that lies under its own, or beside it there.
class Footprint {
 public:
  Footprint(const SeenPosts& full, const SeenPosts& posts, const CornerPosts& triangle)
      : corners_{triangle.apex, triangle.b, triangle.c} {
    const int64_t full_east = full.node.PostSpacingEast(), full_north = full.node.PostSpacingNorth();
    const GridPoint from = posts.node.SouthWest(), to = full.node.SouthWest();
    for (Place& corner : corners_) {
      corner.column = corner.column * (posts.node.PostSpacingEast() / full_east) - (to.x - from.x) / full_east;
      corner.row = corner.row * (posts.node.PostSpacingNorth() / full_north) - (to.y - from.y) / full_north;
    }
    const auto [south, north] = std::minmax({corners_[0].row, corners_[1].row, corners_[2].row});
    const auto [west, east] = std::minmax({corners_[0].column, corners_[1].column, corners_[2].column});
    reaches_ = south <= kCells && north >= 0 && west <= kCells && east >= 0;
    first_row_ = std::max<int64_t>(south, 0);
    last_row_ = std::min<int64_t>(north, kCells);
  }

  bool reaches() const { return reaches_; }
  int64_t first_row() const { return first_row_; }
  int64_t last_row() const { return last_row_; }

  struct Columns {
    int64_t first, last;
  };
  // The quadnode's columns that it covers in that row; none: first > last.
  Columns At(int64_t row) const {
    Columns columns{0, kCells};
    for (size_t i = 0; i < 3; ++i) {
      // On the left of each edge, or on it:  a * column + b >= 0.
      const Place &from = corners_[i], &to = corners_[(i + 1) % 3];
      const int64_t a = from.row - to.row;
      const int64_t b = (to.column - from.column) * (row - from.row) - a * from.column;
      if (a > 0) columns.first = std::max(columns.first, b >= 0 ? -(b / a) : (-b + a - 1) / a);
      if (a < 0) columns.last = std::min(columns.last, b >= 0 ? b / -a : -1);
      if (a == 0 && b < 0) columns.last = -1;
    }
    return columns;
  }

  // The triangle's plane, whose points are linear in column and row: its corners are those.
  struct Plane {
    glm::dvec3 at_apex, per_column, per_row;
    double apex_column, apex_row;
    glm::dvec3 At(int64_t column, int64_t row) const {
      return at_apex + (static_cast<double>(column) - apex_column) * per_column +
             (static_cast<double>(row) - apex_row) * per_row;
    }
  };
  Plane PlaneThrough(const glm::dvec3& apex, const glm::dvec3& b, const glm::dvec3& c) const {
    const Leg to_b(corners_[0], corners_[1]), to_c(corners_[0], corners_[2]);
    const double area = to_b.columns * to_c.rows - to_b.rows * to_c.columns;
    return {apex, ((b - apex) * to_c.rows - (c - apex) * to_b.rows) / area,
            ((c - apex) * to_b.columns - (b - apex) * to_c.columns) / area, static_cast<double>(corners_[0].column),
            static_cast<double>(corners_[0].row)};
  }

 private:
  struct Place {
    int64_t column, row;
    Place(Post post) : column(post.column), row(post.row) {}
  };
  struct Leg {
    double columns, rows;
    Leg(const Place& from, const Place& to)
        : columns(static_cast<double>(to.column - from.column)), rows(static_cast<double>(to.row - from.row)) {}
  };
  std::array<Place, 3> corners_;
  int64_t first_row_ = 0, last_row_ = 0;
  bool reaches_ = false;
};

}  // namespace

PictureErrors::PictureErrors(const ViewParameters& view, const ViewMatrices& matrices)
    : matrices_(matrices),
      ecef_from_camera_(view.ecef_from_camera),
      half_width_px_(0.5F * static_cast<float>(view.width_px)),
      half_height_px_(0.5F * static_cast<float>(view.height_px)) {}

SeenPosts PictureErrors::Look(const TerrainPage& page) const {
  SeenPosts posts;
  posts.node = page.node;
  const Frame frame = FrameOf(page.node);
  for (const TerrainVertex& vertex : page.vertices) {
    const glm::dvec3 ecef = frame.ToEcef(glm::dvec3(vertex.x, vertex.y, vertex.z));
    const glm::dvec3 in_camera = (ecef - matrices_.eye_ecef) * ecef_from_camera_;  // right, up, backward
    const double scale = -matrices_.pixels_per_radian / in_camera.z;
    posts.right_m.push_back(static_cast<float>(in_camera.x));
    posts.up_m.push_back(static_cast<float>(in_camera.y));
    posts.depth_m.push_back(static_cast<float>(-in_camera.z));
    posts.right_px.push_back(static_cast<float>(in_camera.x * scale));
    posts.up_px.push_back(static_cast<float>(in_camera.y * scale));
    const bool in_picture =
        std::abs(posts.right_px.back()) <= half_width_px_ && std::abs(posts.up_px.back()) <= half_height_px_;
    const bool never = -in_camera.z < matrices_.near_m || matrices_.horizon.Hides({ecef, 0});
    posts.counts.push_back(never ? SeenPosts::kNever : in_picture ? SeenPosts::kAlways : SeenPosts::kWithItsPoint);
  }
  return posts;
}

double PictureErrors::LargestOver(const SeenPosts& full, const SeenPosts& posts, const CornerPosts& triangle) const {
  const Footprint footprint(full, posts, triangle);
  if (!footprint.reaches()) return 0;
  const Footprint::Plane plane =
      footprint.PlaneThrough(posts.at(triangle.apex), posts.at(triangle.b), posts.at(triangle.c));
  float largest_squared = 0;
  for (int64_t row = footprint.first_row(); row <= footprint.last_row(); ++row) {
    const Footprint::Columns columns = footprint.At(row);
    if (columns.first > columns.last) continue;
    const auto first = static_cast<size_t>(row * kPosts + columns.first);
    const auto last = static_cast<size_t>(row * kPosts + columns.last);
    largest_squared = std::max(
        largest_squared, RowSquared_px(full, first, last, plane.At(columns.first, row), glm::vec3(plane.per_column)));
  }
  return std::sqrt(static_cast<double>(largest_squared));
}

// Over posts first .. last; the point that stands for the first, and the step from each to the next.
float PictureErrors::RowSquared_px(const SeenPosts& full, size_t first, size_t last, glm::vec3 point,
                                   const glm::vec3& step) const {
  const auto px = static_cast<float>(matrices_.pixels_per_radian);
  const auto near_m = static_cast<float>(matrices_.near_m);
  const glm::vec3 start = point;
  float largest_squared = 0;
  for (size_t post = first; post <= last; ++post) {
    if (full.counts[post] == SeenPosts::kNever) continue;
    const bool always = full.counts[post] == SeenPosts::kAlways;
    point = start + static_cast<float>(post - first) * step;
    if (point.z < near_m) {
      if (always) return std::numeric_limits<float>::infinity();
      continue;
    }
    const float right_px = point.x * px / point.z, up_px = point.y * px / point.z;
    if (!always && (std::abs(right_px) > half_width_px_ || std::abs(up_px) > half_height_px_)) continue;
    const float right = right_px - full.right_px[post], up = up_px - full.up_px[post];
    largest_squared = std::max(largest_squared, right * right + up * up);
  }
  return largest_squared;
}

}  // namespace belvedere::figures
