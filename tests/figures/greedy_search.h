// Greedy search: how few triangles keep the bound when errors are looked up in the picture instead of bounded.
//
// The hierarchy is that of the terrain manager: quadnodes of posts, in each the bisection of right triangles
// (bisection.h), each post with its two parents. The search starts with the coarsest, and whatever is over the bound is
// split, with all that the split forces, until nothing is: a triangle, at the post in the middle of its hypotenuse; a
// quadnode whose very finest triangles are over the bound, into its children. For a given bound the order makes no
// difference: a triangle over it must be split sooner or later, and what a split forces is forced whenever it comes.
//
// The error of a triangle is the largest over all full-resolution posts that it covers (picture_errors.h). Full
// resolution are the posts of the finest quadnodes that have heights of their own; of quadnodes finer than those, their
// own.
//
// Threads: one an object.
#pragma once

#include "tests/figures/picture_errors.h"

#include <array>
#include <unordered_map>
#include <vector>

namespace belvedere::figures {

// Terrain as the search needs it.
class Terrain {
 public:
  virtual ~Terrain() = default;
  // Stays as long as the search.
  virtual const TerrainPage& PageOf(Quadcode node) = 0;
  // Finer heights lie under it.
  virtual bool HasFiner(Quadcode node) const = 0;
};

// For each post of a quadnode, by index.
using DrawnPosts = std::vector<bool>;

class GreedySearch {
 public:
  GreedySearch(Terrain& terrain, const ViewParameters& view, const ViewMatrices& matrices, double bound_px)
      : terrain_(terrain), matrices_(matrices), errors_(view, matrices), bound_px_(bound_px) {}

  struct Chosen {
    Quadcode node;
    DrawnPosts drawn;
  };
  // Of the whole Earth. Where nothing is seen, quadnodes stay as coarse as the tree lets them.
  std::vector<Chosen> Run();
  // Within one quadnode, which is drawn whatever its finest triangles leave.
  DrawnPosts Choose(Quadcode node);
  // Largest error of the quadnode's triangles between those posts.
  double Largest_px(Quadcode node, const DrawnPosts& drawn);
  // Some of it may be in the picture.
  bool IsSeen(Quadcode node);

 private:
  class Bisection;

  const SeenPosts& PostsOf(Quadcode node);
  // The full-resolution quadnodes under it, itself perhaps, of which something may be seen.
  const std::vector<const SeenPosts*>& FullUnder(Quadcode node);
  double LargestUnder(const SeenPosts& posts, const DrawnPosts& drawn, const std::array<CornerPosts, 2>& pair,
                      int level);
  double ErrorOf(const SeenPosts& posts, const CornerPosts& triangle);
  bool KeepsBound(Quadcode node);
  void Walk(Quadcode node, std::vector<Chosen>& chosen);

  Terrain& terrain_;
  const ViewMatrices matrices_;
  const PictureErrors errors_;
  const double bound_px_;
  std::unordered_map<Quadcode, SeenPosts> posts_;
  std::unordered_map<Quadcode, std::vector<const SeenPosts*>> full_;
};

}  // namespace belvedere::figures
