// Post selection: within one quadnode, chooses the posts to draw, so that the triangles between them keep the bound,
// and hands out the triangles.
//
// It is a greedy full search: two root triangles are bisected, and a triangle is split at the middle of its hypotenuse
// when the delta value of that post, seen at the least depth of the triangles that it splits, is over the bound. A
// post needs its two parents (bisection.h), which are then drawn too, whatever their own error; so the triangles meet
// edge to edge. A post is looked at once, and only when a triangle that it would split exists: the work is proportional
// to what is drawn.
//
// Slant and depth. A quadnode's error_scale has the greatest g (cut.h) over all of it and its least depth; each post
// takes those of the triangles that it splits, found at their corners. With u the vertical at the post, f the line of
// view and w the place of a point in the picture, that is a / z with its place a from the eye and its depth z, g there
// is |u - (u.f) w|: convex in w, and so no more within a triangle than at its corners, as long as all are before the
// eye. An eye that has moved by d sees the point at w', where w' - w = (w' (d.f) - d) / z; so with W the most that |w'|
// is in the picture, and z the least depth,
//     g <= greatest |u - (u.f) w| of the corners + |u.f| W |d| / z + W |change of u|.
// What is displaced by e along u moves by e g over its depth where it then is: the least depth is less by e |u.f|.
// Verticals are taken to be those of a sphere through the frame's origin, which change by the triangles' spread over
// its radius; how far those of the ellipsoid are from them is added. All this is for any eye within kKeepMargin of the
// nearest depth, so that triangles can be kept (kept_triangles.h). It is a bound for what is seen; what is not has no g
// that matters.
//
// Triangles that lie beside the picture with all their corners, and by more than kBesideGuard away from it, need keep
// their error under a looser bound only: kShareBesidePicture of it counts. They lie there as well for any later eye,
// whose picture's sides have turned, and which has come nearer by a share of the least distance, by no more than
// kBesideGuard together.
//
// Source of the bisection: Evans, Kirkpatrick, Townsend, "Right-triangulated irregular networks" (Algorithmica 2001).
// Units: pixels, metres. Threads: one an object.
#pragma once

#include "managers/cut.h"
#include "runtime/earth/bisection.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace belvedere {

struct PostTriangle {
  uint16_t a, b, c;  // posts; right angle at a, counter-clockwise seen from above
};

// By what share of its nearest depth the eye may move while a choice is kept, and errors may grow.
inline constexpr double kKeepMargin = 0.02;

class PostSelection {
 public:
  // Appends the quadnode's triangles to `out`. Returns the largest error that they may leave, in units of the bound.
  // frame: of the quadnode. Of posts that were drawn_before, those are left out whose error is under leave_out_at, in
  // units of the bound, 0 .. 1.
  float Run(const CutNode& node, const Sight& sight, const Frame& frame, double error_px,
            std::span<const uint16_t> drawn_before, float leave_out_at, std::vector<PostTriangle>& out);
  // The last run left something out because it lay beside the picture.
  bool left_out_beside() const { return left_out_beside_; }

 private:
  struct LocalView;
  enum State : uint8_t { kUnseen, kDrawnBefore, kLeftOut, kDrawn };

  void Draw(Post post, const LocalView& view);
  void Test(Post post, int level, const LocalView& view);
  void Emit(int a, int b, int c, int level, std::vector<PostTriangle>& out) const;

  std::array<State, kVerticesPerPage> states_{};
  std::vector<uint16_t> drawn_;  // posts but for the corners
  float worst_ = 0;
  bool left_out_beside_ = false;
  float stay_ = 1;  // by how much the errors of posts that were drawn before count for more
};

}  // namespace belvedere
