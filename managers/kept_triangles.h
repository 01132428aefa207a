// Kept triangles: what post selection chose for a quadnode, kept from list to list for as long as it holds.
//
// Triangles are chosen a little finer than asked, by kKeepMargin. While the eye comes nearer by less than that, seen
// from the quadnode, and does not turn too far, they keep the bound: for a point at depth z when they were chosen, the
// depth now is at least
//     z - |eye moved| - |line of view turned| * (farthest distance of the quadnode),
// and z is at least the quadnode's nearest depth then.
//
// Units: metres, pixels, ECEF. Threads: one an object.
#pragma once

#include "managers/post_selection.h"

#include <span>
#include <unordered_map>
#include <vector>

namespace belvedere {

inline constexpr double kKeepMargin = 0.02;

class KeptTriangles {
 public:
  struct Choice {
    std::span<const PostTriangle> triangles;  // valid until the next Forget
    double worst = 0;                         // largest error left, in units of the bound
  };
  // Chosen anew, or as they were chosen for an earlier list. frame: of the quadnode.
  // REQUIRES: the pages of the list before this one are still in memory.
  Choice For(const CutNode& node, const Sight& sight, const Frame& frame, double error_px);

  // Ends a list: what it did not ask for is forgotten.
  void ForgetUnused();

  uint64_t chosen() const { return chosen_; }  // quadnodes chosen anew, ever

 private:
  struct Kept {
    const TerrainPage* page = nullptr;
    Sight sight;
    double error_scale = 0;
    double nearest_depth_m = 0;
    double error_px = 0;
    bool finest = true;
    std::vector<PostTriangle> triangles;
    double worst = 0;  // in units of error_px, with the error_scale and from where it was chosen
    uint64_t list = 0;
  };
  static double GrowthOfError(const Kept& kept, const CutNode& node, const Sight& sight);

  PostSelection posts_;
  std::unordered_map<Quadcode, Kept> kept_;
  uint64_t list_ = 0;
  uint64_t chosen_ = 0;
};

}  // namespace belvedere
