// Picture errors: how far the points of a triangle are, on the picture, from the full-resolution posts that they stand
// for.
//
// A point of a triangle stands for the post at its column and row. A post counts when it, or the point, is in the
// picture, and it is before the horizon; what hills hide counts. A triangle that reaches behind the eye where a post in
// the picture should be is wrong without bound.
//
// Frames: metres from the eye along the camera's axes: right, up, depth; pixels from the picture's middle.
// Threads: pure.
#pragma once

#include "runtime/earth/bisection.h"
#include "runtime/paging/page.h"
#include "runtime/scene/view_parameters.h"

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include <vector>

namespace belvedere::figures {

struct CornerPosts {
  Post apex, b, c;  // right angle at the apex, counter-clockwise seen from above
  Post middle() const { return {(b.column + c.column) / 2, (b.row + c.row) / 2}; }
};

// The posts of a quadnode as they are seen.
struct SeenPosts {
  enum Counts : uint8_t { kNever, kWithItsPoint, kAlways };
  Quadcode node;
  std::vector<float> right_m, up_m, depth_m;
  std::vector<float> right_px, up_px;
  std::vector<Counts> counts;

  glm::dvec3 at(Post post) const {
    const auto index = static_cast<size_t>(post.index());
    return {right_m[index], up_m[index], depth_m[index]};
  }
};

class PictureErrors {
 public:
  // The view is a perspective one.
  PictureErrors(const ViewParameters& view, const ViewMatrices& matrices);

  SeenPosts Look(const TerrainPage& page) const;

  // Of a triangle between the posts of one quadnode, over the posts of a full-resolution one under it, or of itself;
  // pixels. 0 where the triangle does not reach it.
  double LargestOver(const SeenPosts& full, const SeenPosts& posts, const CornerPosts& triangle) const;

 private:
  float RowSquared_px(const SeenPosts& full, size_t first, size_t last, glm::vec3 point, const glm::vec3& step) const;

  const ViewMatrices matrices_;
  const glm::dmat3 ecef_from_camera_;
  const float half_width_px_, half_height_px_;
};

}  // namespace belvedere::figures
