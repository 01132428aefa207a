// Bisection: which post of a quadnode splits which right triangle, and which posts depend on it.
//
// The square of 129 x 129 posts starts as two triangles that share the diagonal from the south-west to the north-east
// corner. A triangle is split at the midpoint of its hypotenuse into two of half its area, kBisectionLevels times in
// all; the last ones have their right angle at one post and its two neighbours. Each post but the four corners is the
// midpoint of exactly one hypotenuse, and so has one level:
//
//   level 0       the middle of the page (hypotenuse: the diagonal)
//   level 2k      posts whose column and row are both odd multiples of 64 >> k; the hypotenuse is diagonal
//   level 2k + 1  posts of which one is an odd and the other an even multiple; the hypotenuse lies along a row or
//   column
//
// Drawing a post needs the two posts at the right angles of the triangles that it splits (one at the border of the
// page): these are its parents, one level up, and it is one of their up to four children.
//
// Source: Evans, Kirkpatrick, Townsend, "Right-triangulated irregular networks" (Algorithmica 2001).
// Units: columns and rows of posts from the south-west corner. Threads: pure functions.
#pragma once

#include "runtime/earth/quadcode.h"

#include <array>
#include <bit>

namespace belvedere {

inline constexpr int kBisectionLevels = 2 * kCellsLog2;
inline constexpr int kNoLevel = -1;  // of the four corners, which are always drawn

struct Post {
  int column = 0;
  int row = 0;
  constexpr int index() const { return row * kPosts + column; }
  constexpr bool inside() const { return column >= 0 && column <= kCells && row >= 0 && row <= kCells; }
  constexpr bool operator==(const Post&) const = default;
};

// Distance, in posts, from a post of that level to the ends of its hypotenuse, along each axis in which they differ.
constexpr int HalfSpan(int level) {
  return (kCells / 2) >> (level / 2);
}

// The level of triangles that the post splits; kNoLevel at the corners.
constexpr int LevelOf(Post post) {
  const unsigned bits = static_cast<unsigned>(post.column) | static_cast<unsigned>(post.row);
  if (bits == 0) return kNoLevel;
  const int power = std::countr_zero(bits);
  if (power >= kCellsLog2) return kNoLevel;
  const bool both_odd = (((post.column & post.row) >> power) & 1) != 0;
  return 2 * (kCellsLog2 - 1 - power) + (both_odd ? 0 : 1);
}

// What a post splits: the ends of the hypotenuse, and the posts at the right angles on either side of it, which are its
// parents. At the border of the page one of those lies outside.
struct Split {
  Post end_a, end_b;
  Post apex_a, apex_b;
};

// REQUIRES: LevelOf(post) != kNoLevel
constexpr Split SplitAt(Post post) {
  const int level = LevelOf(post);
  const int span = HalfSpan(level);
  const auto at = [&](int columns, int rows) { return Post{post.column + columns * span, post.row + rows * span}; };
  if (level % 2 == 1) {
    const bool along_row = ((post.column / span) & 1) != 0;
    if (along_row) return {at(-1, 0), at(1, 0), at(0, -1), at(0, 1)};
    return {at(0, -1), at(0, 1), at(-1, 0), at(1, 0)};
  }
  // The hypotenuse joins the two corners that are older than the other two: diagonals alternate like a chessboard.
  const bool rising = ((((post.column / span) >> 1) + ((post.row / span) >> 1)) & 1) == 0;
  if (rising) return {at(-1, -1), at(1, 1), at(1, -1), at(-1, 1)};
  return {at(-1, 1), at(1, -1), at(-1, -1), at(1, 1)};
}

// The posts, one level down, that depend on the post; of those outside the page the caller keeps clear.
// REQUIRES: 0 <= LevelOf(post) < kBisectionLevels - 1
constexpr std::array<Post, 4> ChildrenOf(Post post) {
  const int level = LevelOf(post);
  const int span = HalfSpan(level);
  if (level % 2 == 0) {
    return {Post{post.column - span, post.row}, Post{post.column + span, post.row}, Post{post.column, post.row - span},
            Post{post.column, post.row + span}};
  }
  const int half = span / 2;
  return {Post{post.column - half, post.row - half}, Post{post.column + half, post.row - half},
          Post{post.column - half, post.row + half}, Post{post.column + half, post.row + half}};
}

inline constexpr std::array<Post, 4> kCorners{Post{0, 0}, Post{kCells, 0}, Post{0, kCells}, Post{kCells, kCells}};

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

}  // namespace belvedere
