// Roundness: what the Earth's shape does to the triangles of a quadnode, for delta values (delta_values.h): a
// paraboloid on which heights can be compared fast, and how far that is from the ellipsoid.
//
// Units: metres; columns and rows of FinestSurface. Threads: values; RoundnessAround keeps what it made for each
// thread.
#pragma once

#include "runtime/earth/bisection.h"
#include "runtime/earth/post_grid.h"

#include <array>

namespace belvedere {

// The ellipsoid under a quadnode as a paraboloid over columns and rows, 0 in the middle. Where a child is as wide as
// the quadnode (quadcode.h) its posts are those of even columns: those of odd ones lie half-way between their
// neighbours, on the child's edges, here and in Roundness.
class Paraboloid {
 public:
  explicit Paraboloid(Quadcode node);
  double At(int column, int row) const;
  bool IsHalfWay(int column, int row) const {
    return column % 2 == 1 && row >= first_wide_row_ && row <= last_wide_row_;
  }

 private:
  double OnEllipsoid(int column, int row) const;

  double per_column_m_ = 0, per_row_m_ = 0;
  int first_wide_row_ = 0, last_wide_row_ = -1;
};

// Between the ellipsoid's points and a triangle's of the same columns and rows, what the paraboloid does not say: along
// the vertical and across it, at most, for the triangles that the posts of each row split. Meridians are all alike.
class Roundness {
 public:
  struct Rest {
    double up_m = 0, aside_m = 0;
  };

  // REQUIRES: node.level() < kMaxLevel
  Roundness(Quadcode node, const Paraboloid& paraboloid);
  const Rest& at(Post post, int level) const {
    return rests_[static_cast<size_t>(level)][static_cast<size_t>(post.row)];
  }

 private:
  // A point of the ellipsoid, and the paraboloid there.
  struct Place {
    glm::dvec3 ecef{};
    double paraboloid_m = 0;
  };
  Place At(Post point) const;
  void Widen(Post apex, const Split& split, Rest& rest) const;

  const PostGrid grid_;
  const Paraboloid paraboloid_;
  std::array<std::array<Rest, kPosts>, kBisectionLevels> rests_{};
};

// The Roundness of the first quadnode of the level and row in which the node lies, which serves all of them. Those of
// the rows asked for last are kept; valid until this thread asks again.
const Roundness& RoundnessAround(Quadcode node);

}  // namespace belvedere
